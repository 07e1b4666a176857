"""A way out for A that is shorter than the hulls', searched on the meshes themselves.

Any translation of A after which the meshes are exactly free bounds the depth from above. Which ones
are tried is a guess, whether they free A is not: the depth to beat is first looked for off the
triangles that cross, then on growing spheres, then around the best way found so far.
"""

from __future__ import annotations

import itertools
import math

from satcheck.audit.ladder import Contact
from satcheck.audit.pair import Pair
from satcheck.audit.part_escape import PartPairs, short_ways_out
from satcheck.audit.parts import covering
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector
from satcheck.audit.snap import planes_left, snapped
from satcheck.audit.trials import Trials
from satcheck.audit.vectors import added, crossed, scaled, unit

# Of the candidates from the parts this many are tried: the others are longer and rarely better.
CANDIDATES = 6
# A candidate that the meshes refuse is lengthened by these factors: parts under-cover a mesh.
LENGTHENINGS = (1.001, 1.01, 1.05)
# The spheres: the smallest one's share of the known way out, and how much each next one is larger.
FIRST_SPHERE = 1 / 64
SPHERE_RATIO = 1.5
# Directions on a sphere: as many as the budget allows about 8 spheres of, and no more than these.
TRIALS_PER_WAY = 8
MOST_WAYS = 128
# Around the best way: tilts in radians, widest first, each tried to 6 sides.
TILTS = (0.4, 0.2, 0.1, 0.05, 0.025)
TILT_SIDES = 6


def escape_on_meshes(
    pair: Pair, contact: Contact, upper: float, normal: Vector, lower: float, plan: Plan
) -> Vector | None:
    """A translation of A shorter than `upper` that frees its mesh; None when none was found.

    normal: of the known way out, which is `upper` long. lower: a proven lower bound.
    """
    trials = Trials(pair)
    search = _Search(trials, lower, pair.settings.depth_width, upper)
    known = [scaled(normal, -1.0)]
    if contact.crossing is not None:
        known = [*(way for way, _ in planes_left(pair, contact.crossing)), *known]
    search.beat_along(known)
    search.snap(pair)
    if search.is_open:
        ways = [*known, *_directions(min(trials.left // TRIALS_PER_WAY, MOST_WAYS))]
        search.grow_spheres(ways)
        search.beat_along(ways)
        search.tilt()
        search.snap(pair)
    search.record(plan)
    return search.best


def escape_on_parts(pair: Pair, upper: float, lower: float, plan: Plan) -> Vector | None:
    """The same, starting from ways out that the convex parts of both bodies suggest."""
    covers = [covering(body, plan) for body in (pair.a, pair.b)]
    if covers[0] is None or covers[1] is None:
        return None
    pairs = PartPairs(covers[0].parts, covers[1].parts, upper)
    candidates = short_ways_out(pairs, _directions(0), upper)[:CANDIDATES]
    search = _Search(Trials(pair), lower, pair.settings.depth_width, upper)
    search.try_candidates(candidates)
    if search.best is not None:
        search.tilt()
        search.snap(pair)
    search.record(plan)
    return search.best


class _Search:
    """best: the shortest verified translation so far; length: its length, or that of the known way
    out while there is none."""

    def __init__(self, trials: Trials, lower: float, width: float, upper: float) -> None:
        self._trials, self._lower, self._width = trials, lower, width
        self.best: Vector | None = None
        self.length = upper

    @property
    def is_open(self) -> bool:
        """Whether a shorter way would matter."""
        return self.length - self._lower > self._width * self.length and self._trials.left > 0

    def beat_along(self, ways: list[Vector]) -> None:
        """Each way in turn has to beat the best by more than the width that matters."""
        for way in ways:
            shorter = self.length * (1 - self._width)
            if shorter > self._lower and self._trials.frees(scaled(way, shorter)):
                self._take(scaled(way, shorter))
                self._bisect()

    def grow_spheres(self, ways: list[Vector]) -> None:
        """The smallest sphere on which some way is free."""
        radius = max(self._lower * (1 + self._width), self.length * FIRST_SPHERE)
        while radius < self.length and self._trials.left:
            for way in ways:
                if self._trials.frees(scaled(way, radius)):
                    self._take(scaled(way, radius))
                    self._bisect()
                    return
            radius *= SPHERE_RATIO

    def tilt(self) -> None:
        """Walk downhill: tilt the best way to each side for as long as that shortens it."""
        for tilt in TILTS:
            improved = True
            while improved and self.best is not None and self.is_open:
                before = self.length
                self.beat_along(_tilted(unit(self.best), tilt))
                improved = self.length < before

    def try_candidates(self, candidates: list[Vector]) -> None:
        for factor in (1.0, *LENGTHENINGS):
            for candidate in candidates:
                longer = scaled(candidate, factor)
                if math.hypot(*longer) < self.length and self._trials.frees(longer):
                    self._take(longer)
                    self._bisect()
                    return

    def snap(self, pair: Pair) -> None:
        if self.best is not None:
            self._take(snapped(pair, self.best, self._lower, self._trials))

    def record(self, plan: Plan) -> None:
        result = "nothing shorter" if self.best is None else "shorter"
        plan.record("mtv-search", result, f"{self.length:.6g} after {self._trials.made} trials")

    def _take(self, free: Vector) -> None:
        self.best, self.length = free, math.hypot(*free)

    def _bisect(self) -> None:
        """Shorten the best along itself; its free part need not be connected."""
        if self.best is None:
            return
        way, blocked = unit(self.best), self._lower
        while self.length - blocked > self._width * self.length and self._trials.left:
            middle = 0.5 * (self.length + blocked)
            if self._trials.frees(scaled(way, middle)):
                self._take(scaled(way, middle))
            else:
                blocked = middle


def _directions(more: int) -> list[Vector]:
    """The 26 of a cube's faces, edges and corners, faces first; then `more` spread over the sphere.

    The spread: Alvaro Gonzalez, "Measurement of Areas on a Sphere Using Fibonacci and
    Latitude-Longitude Lattices" (2010).
    """
    steps = sorted(
        (step for step in itertools.product((-1, 0, 1), repeat=3) if any(step)),
        key=lambda step: (sum(map(abs, step)), step),
    )
    found = [unit((float(x), float(y), float(z))) for x, y, z in steps]
    golden_angle = math.pi * (3 - math.sqrt(5))
    for k in range(more):
        z = 1 - (2 * k + 1) / more
        ring = math.sqrt(1 - z * z)
        found.append((ring * math.cos(k * golden_angle), ring * math.sin(k * golden_angle), z))
    return found


def _tilted(way: Vector, tilt: float) -> list[Vector]:
    """Directions at the angle `tilt` from the way, all around it."""
    least = min(range(3), key=lambda axis: abs(way[axis]))
    side = unit(crossed(way, tuple(float(axis == least) for axis in range(3))))  # type: ignore[arg-type]
    other = crossed(way, side)
    turns = [2 * math.pi * k / TILT_SIDES for k in range(TILT_SIDES)]
    return [
        added(
            scaled(way, math.cos(tilt)),
            scaled(
                added(scaled(side, math.cos(turn)), scaled(other, math.sin(turn))), math.sin(tilt)
            ),
        )
        for turn in turns
    ]
