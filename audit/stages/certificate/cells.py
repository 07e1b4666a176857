"""What the searches of the solver leave for certificates: covers, which show that an overlap is
deep, and cells, which show that it is no thicker, or that surfaces which may be off explain it.

The checker proves in rationals what they show (`depth` and `thickness` in `satcheck.verify`). Most
searches for an excuse leave nothing behind. This one is run again, and writes down its cells.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from msgspec import UNSET

from satcheck import core
from satcheck.audit.stages.explained import (
    ball_in,
    deeper,
    limit_of,
    may_be_explained,
    passes,
    reaching,
    surfaces,
)
from satcheck.report.certificate import (
    Cells,
    Cover,
    Excuse,
    Face,
    InnerBall,
    OverlapSet,
    Plane,
    Polytope,
    Region,
)
from satcheck.verify import Rejected
from satcheck.verify.depth import MOST_PARTS, MOST_SETS
from satcheck.verify.partition import MOST_CELLS

if TYPE_CHECKING:
    from satcheck.audit.pair import Pair

BODIES: tuple[Literal["a"], Literal["b"]] = ("a", "b")


def cover(a: core.Surface, b: core.Surface, depth: float, work: int) -> Cover | None:
    """None: the search finds none by regions inside two solids. work: steps that it may take."""
    if depth <= 0:
        return None
    search = core.search_depth(a, b, upper=depth, lower=0.0, width=0.0, work=work, prove=True)
    proof = search.proof
    if proof is None or len(proof.parts) > MOST_PARTS or len(proof.sets) > MOST_SETS:
        return None
    return Cover(proof.origin, proof.half, tuple(map(_set, proof.sets)), tuple(proof.parts))


def cells(proof: core.ThicknessProof) -> Cells | None:
    """None: there are too many."""
    if len(proof.cells) > MOST_CELLS:
        return None
    return Cells(
        proof.origin,
        proof.low,
        proof.high,
        tuple(map(_patch, proof.bounds)),
        tuple(proof.cells),
        tuple(proof.at),
        tuple(proof.cuts),
        tuple(map(tuple, proof.sums)),
    )


def excuse(pair: Pair) -> Excuse:
    """Return what shows that surfaces which may be off explain the overlap: a ball in each body,
    and cells. Raises Rejected: nothing was found that shows it."""
    if not may_be_explained(pair):
        raise Rejected("no evidence was found that the overlap is within the touch band")
    if pair.closer:
        raise Rejected("a touch of curves by their thickness is not certified")
    if passes(pair) is not False:
        raise Rejected("slivers between the faces look as if one body passed through the other")
    if pair.excuses and reaching(pair) is not None:
        raise Rejected("a touch by the tolerance is not certified beside a surface tolerance")
    least = pair.off if pair.excuses else (0.0, 0.0)
    inner = [ball_in(pair, body, off) for off, (_, body) in zip(least, surfaces(pair), strict=True)]
    balls = [InnerBall(one.centre, one.radius) for one in inner if one.centre is not None]
    interval = deeper(pair, prove=True)
    if len(balls) < len(inner) or interval.proof is None or interval.upper > limit_of(pair):
        raise Rejected("the budget ends the search for what shows that surfaces may explain it")
    shown = cells(interval.proof)
    if shown is None:
        raise Rejected(f"the search for a deeper point has more than {MOST_CELLS:,} cells")
    return Excuse(balls[0], balls[1], shown)


def _patch(bound: core.DepthBound) -> Face | Plane:
    body = BODIES[bound.body]
    if bound.triangles:
        return Face(body, tuple(bound.triangles))
    reach = bound.reach if math.isfinite(bound.reach) else UNSET
    return Plane(body, bound.normal, bound.height, reach)


def _set(overlap: core.OverlapSet) -> OverlapSet:
    facets = tuple((p, q, r) for p, q, r in overlap.facets)
    difference = Polytope(tuple(overlap.corners), facets)
    return OverlapSet(_region(overlap.a), _region(overlap.b), difference)


def _region(region: core.InnerRegion) -> Region:
    return Region(tuple(region.vertices), tuple(region.normals))
