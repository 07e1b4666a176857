"""A shorter way out than the hulls', found on parts or along a few directions, checked on meshes.

Any translation of A after which the meshes are exactly free bounds the depth from above. Which ones
are tried is a guess; whether they free A is not. The number of trials depends on the size of the
meshes alone, so that the same input gives the same answer.
"""

from __future__ import annotations

import itertools
import math

from satcheck import core
from satcheck.audit.pair import Pair
from satcheck.audit.part_escape import PartPairs, short_ways_out
from satcheck.audit.parts import covering
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector
from satcheck.audit.verify import FREE

# Exact trials for a pair of small meshes, and how many triangles the trials may visit in all.
MOST_TRIALS = 96
LEAST_TRIALS = 12
TRIANGLES_IN_ALL = 4_000_000
# Of the candidates from the parts this many are tried: the others are longer and rarely better.
CANDIDATES = 6
# A candidate that the meshes refuse is lengthened by these factors: parts under-cover a mesh.
LENGTHENINGS = (1.001, 1.01, 1.05)


class Trials:
    """Exact answers to "is A free once translated?", up to a number that is fixed beforehand."""

    def __init__(self, pair: Pair) -> None:
        # The smaller mesh is moved, B the other way where it is B: its tree is built per trial.
        self._moves_a = pair.a.mesh.triangle_count <= pair.b.mesh.triangle_count
        self._pair = pair
        size = pair.a.mesh.triangle_count + pair.b.mesh.triangle_count
        self.left = min(max(TRIANGLES_IN_ALL // size, LEAST_TRIALS), MOST_TRIALS)

    def frees(self, t: Vector) -> bool:
        """Whether it is proven that A is free after moving by t; False when no trial is left."""
        if self.left == 0:
            return False
        self.left -= 1
        a, b = self._pair.a, self._pair.b
        if self._moves_a:
            moved = core.Surface(a.mesh.translated(t), a.solid)
            found = core.mesh_relation(moved, b.surface())
        else:
            moved = core.Surface(b.mesh.translated((-t[0], -t[1], -t[2])), b.solid)
            found = core.mesh_relation(a.surface(), moved)
        return found.proven and found.relation in FREE


def shorter_escape(
    pair: Pair, upper: float, normal: Vector, lower: float, plan: Plan
) -> Vector | None:
    """A translation of A shorter than `upper` that frees its mesh; None when none was found.

    upper, normal: the length and normal of a known way out. lower: a proven lower bound.
    """
    trials = Trials(pair)
    budget = trials.left
    ways = [_scaled(normal, -1.0), *_grid()]
    candidates: list[Vector] = []
    covers = [covering(body, plan) for body in (pair.a, pair.b)] if pair.both_solid else []
    if covers and covers[0] is not None and covers[1] is not None:
        pairs = PartPairs(covers[0].parts, covers[1].parts, upper)
        candidates = short_ways_out(pairs, ways, upper)[:CANDIDATES]
    width = pair.settings.depth_width
    best = _first_free(candidates, upper, trials)
    if best is not None:
        best = _bisected(best, lower, width, trials)
    else:
        best = _best_along(ways, upper, lower, width, trials)
    length = upper if best is None else math.hypot(*best)
    plan.record(
        "mtv-search",
        "as before" if best is None else "shorter",
        f"{length:.6g} after {budget - trials.left} exact trials, "
        f"{len(candidates)} candidates from parts",
    )
    return best


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
