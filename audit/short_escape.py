"""A shorter way out than the hulls', found on parts or along a few directions, checked on meshes.

Any translation of A after which the meshes are exactly free bounds the depth from above. Which ones
are tried is a guess; whether they free A is not. The number of trials depends on the size of the
meshes alone, so that the same input gives the same answer.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from satcheck import core
from satcheck.audit.ladder import Contact
from satcheck.audit.pair import Pair
from satcheck.audit.part_escape import PartPairs, short_ways_out
from satcheck.audit.parts import covering
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector
from satcheck.audit.triangles import Crossing, triangle_corners, triangle_normal
from satcheck.audit.verify import FREE

# Exact trials for a pair of small meshes, and how many triangles the trials may visit in all.
MOST_TRIALS = 96
LEAST_TRIALS = 12
TRIANGLES_IN_ALL = 4_000_000
# Of the candidates from the parts this many are tried: the others are longer and rarely better.
CANDIDATES = 6
# A candidate that the meshes refuse is lengthened by these factors: parts under-cover a mesh.
LENGTHENINGS = (1.001, 1.01, 1.05)

# Where to look for the face that blocks the way: a little before its end. Only a face that the way
# leaves nearly along its normal can offer a shorter one.
BLOCKED_FRACTION = 0.98
SNAP_COSINE = 0.9


class Trials:
    """Exact answers to "is A free once translated?", up to a number that is fixed beforehand."""

    def __init__(self, pair: Pair) -> None:
        # The smaller mesh is moved, B the other way where it is B: its tree is built per trial.
        self._moves_a = pair.a.mesh.triangle_count <= pair.b.mesh.triangle_count
        self._pair = pair
        size = pair.a.mesh.triangle_count + pair.b.mesh.triangle_count
        self.left = min(max(TRIANGLES_IN_ALL // size, LEAST_TRIALS), MOST_TRIALS)

    def relation_at(self, t: Vector) -> core.MeshRelation | None:
        """The relation once A has moved by t; None when no trial is left."""
        if self.left == 0:
            return None
        self.left -= 1
        a, b = self._pair.a, self._pair.b
        if self._moves_a:
            moved = core.Surface(a.mesh.translated(t), a.solid)
            return core.mesh_relation(moved, b.surface())
        moved = core.Surface(b.mesh.translated((-t[0], -t[1], -t[2])), b.solid)
        return core.mesh_relation(a.surface(), moved)

    def frees(self, t: Vector) -> bool:
        """Whether it is proven that A is free after moving by t; False when no trial is left."""
        found = self.relation_at(t)
        return found is not None and found.proven and found.relation in FREE


def escape_on_meshes(
    pair: Pair, contact: Contact, upper: float, normal: Vector, lower: float, plan: Plan
) -> Vector | None:
    """A translation of A shorter than `upper` that frees its mesh; None when none was found.

    Tried: off the crossing triangles, against `normal` (the known way out, `upper` long), and the
    directions of a grid. lower: a proven lower bound, where the search may stop.
    """
    trials = Trials(pair)
    budget = trials.left
    ways = [_scaled(normal, -1.0), *_grid()]
    if contact.crossing is not None:
        ways = [way for way, _ in _planes_left(pair, contact.crossing)] + ways
    best = _best_along(ways, upper, lower, pair.settings.depth_width, trials)
    if best is not None:
        best = snapped(pair, best, lower, trials)
    _record(best, upper, budget - trials.left, plan)
    return best


def escape_on_parts(pair: Pair, upper: float, lower: float, plan: Plan) -> Vector | None:
    """The same, starting from ways out that the convex parts of both bodies suggest."""
    covers = [covering(body, plan) for body in (pair.a, pair.b)]
    if covers[0] is None or covers[1] is None:
        return None
    trials = Trials(pair)
    budget = trials.left
    pairs = PartPairs(covers[0].parts, covers[1].parts, upper)
    candidates = short_ways_out(pairs, _grid(), upper)[:CANDIDATES]
    best = _first_free(candidates, upper, trials)
    if best is not None:
        best = _bisected(best, lower, pair.settings.depth_width, trials)
        best = snapped(pair, best, lower, trials)
    _record(best, upper, budget - trials.left, plan)
    return best


def _record(best: Vector | None, upper: float, trials: int, plan: Plan) -> None:
    result = "nothing shorter" if best is None else "shorter"
    length = upper if best is None else math.hypot(*best)
    plan.record("mtv-search", result, f"{length:.6g} after {trials} exact trials")


def _first_free(candidates: list[Vector], upper: float, trials: Trials) -> Vector | None:
    for factor in (1.0, *LENGTHENINGS):
        for candidate in candidates:
            longer = _scaled(candidate, factor)
            if math.hypot(*longer) < upper and trials.frees(longer):
                return longer
    return None


def _best_along(
    ways: list[Vector], upper: float, lower: float, width: float, trials: Trials
) -> Vector | None:
    """Each way in turn has to beat the shortest so far by more than the width that matters."""
    best, length = None, upper
    for way in ways:
        shorter = _scaled(way, length * (1 - width))
        if math.hypot(*shorter) > lower and trials.frees(shorter):
            best = _bisected(shorter, lower, width, trials)
            length = math.hypot(*best)
    return best


def _bisected(free: Vector, lower: float, width: float, trials: Trials) -> Vector:
    """The shortest found along a free translation; the free set need not be connected."""
    way = _scaled(free, 1 / math.hypot(*free))
    best, known, blocked = free, math.hypot(*free), lower
    while known - blocked > width * known and trials.left:
        middle = 0.5 * (known + blocked)
        if trials.frees(_scaled(way, middle)):
            best, known = _scaled(way, middle), middle
        else:
            blocked = middle
    return best


def _scaled(v: Vector, factor: float) -> Vector:
    return factor * v[0], factor * v[1], factor * v[2]


def _grid() -> list[Vector]:
    """The 26 directions of a cube's faces, edges and corners, faces first."""
    steps = sorted(
        (step for step in itertools.product((-1, 0, 1), repeat=3) if any(step)),
        key=lambda step: (sum(map(abs, step)), step),
    )
    return [_scaled((x, y, z), 1 / math.hypot(x, y, z)) for x, y, z in steps]


def snapped(pair: Pair, best: Vector, lower: float, trials: Trials) -> Vector:
    """The way out along the normal of a face that blocks a slightly shorter one, if that is
    shorter: A is then free exactly where a vertex leaves the plane of that face, so these lengths
    are searched, not the lengths in between."""
    length = math.hypot(*best)
    way = _scaled(best, 1 / length)
    found = trials.relation_at(_scaled(best, BLOCKED_FRACTION))
    if found is None or found.triangle_a < 0 or found.triangle_b < 0:
        return best
    for out, lengths in _planes_left(pair, (found.triangle_a, found.triangle_b)):
        if sum(p * q for p, q in zip(out, way, strict=True)) < SNAP_COSINE:
            continue
        shorter = [s for s in lengths if lower <= s < length]
        free = _least_free(out, shorter, trials)
        if free is not None:
            best, length = free, math.hypot(*free)
    return best


def _planes_left(pair: Pair, crossing: Crossing) -> Iterator[tuple[Vector, list[float]]]:
    """Per triangle: the direction in which A leaves its plane, and the lengths, ascending, at which
    one vertex of the other body after another has left it."""
    import numpy as np

    for body, other, index, side in (
        (pair.b, pair.a, crossing[1], 1.0),
        (pair.a, pair.b, crossing[0], -1.0),
    ):
        normal = triangle_normal(body, index)
        if normal is None:
            continue
        heights = (other.mesh.vertices - triangle_corners(body, index)[0]) @ np.array(normal)
        yield _scaled(normal, side), np.unique(-heights[heights < 0]).tolist()


def _least_free(way: Vector, lengths: list[float], trials: Trials) -> Vector | None:
    """Binary search, as if every longer translation along the way were free as well."""
    best = None
    start, end = 0, len(lengths)
    while start < end and trials.left:
        middle = (start + end) // 2
        t = _scaled(way, lengths[middle])
        if trials.frees(t):
            best, end = t, middle
        else:
            start = middle + 1
    return best
