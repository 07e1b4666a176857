"""Cells for certificates: they show that an overlap is no thicker, or that surfaces which may be
off explain it.

The checker proves in rationals what they show (`satcheck.verify.thickness`). Most searches for an
excuse leave nothing behind. This one is run again, and writes down its cells.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from msgspec import UNSET

from satcheck import core
from satcheck.audit.stages.certificate.maker import NoCertificate
from satcheck.audit.stages.explained import (
    ball_in,
    deeper,
    limit_of,
    may_be_explained,
    passes,
    reaching,
    surfaces,
)
from satcheck.report.certificate import Cells, Excuse, Face, InnerBall, Plane
from satcheck.verify.partition import MOST_CELLS

if TYPE_CHECKING:
    from satcheck.audit.pair import Pair

BODIES: tuple[Literal["a"], Literal["b"]] = ("a", "b")


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


def excuse(pair: Pair) -> Excuse | NoCertificate:
    """Return what shows that surfaces which may be off explain the overlap: a ball in each body,
    and cells."""
    if not may_be_explained(pair):
        return NoCertificate("no evidence was found that the overlap is within the touch band")
    if pair.closer:
        return NoCertificate("a touch of curves by their thickness is not certified")
    if passes(pair) is not False:
        return NoCertificate(
            "slivers between the faces look as if one body passed through the other"
        )
    if pair.excuses and reaching(pair) is not None:
        return NoCertificate("a touch by the tolerance is not certified beside a surface tolerance")
    least = pair.off if pair.excuses else (0.0, 0.0)
    inner = [ball_in(pair, body, off) for off, (_, body) in zip(least, surfaces(pair), strict=True)]
    balls = [InnerBall(one.centre, one.radius) for one in inner if one.centre is not None]
    interval = deeper(pair, prove=True)
    if len(balls) < len(inner) or interval.proof is None or interval.upper > limit_of(pair):
        return NoCertificate(
            "the budget ends the search for what shows that surfaces may explain it"
        )
    shown = cells(interval.proof)
    if shown is None:
        return NoCertificate(f"the search for a deeper point has more than {MOST_CELLS:,} cells")
    return Excuse(balls[0], balls[1], shown)


def _patch(bound: core.DepthBound) -> Face | Plane:
    body = BODIES[bound.body]
    if bound.triangles:
        return Face(body, tuple(bound.triangles))
    reach = bound.reach if math.isfinite(bound.reach) else UNSET
    return Plane(body, bound.normal, bound.height, reach)
