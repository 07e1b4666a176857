"""Contact of bodies that are not both convex. The proof is a translation of A, shorter than the
touch band, after which the bodies stay apart for a while. During that time the translation ends
every overlap, so no overlap is deeper than its length.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import combinations

from satcheck import core
from satcheck.audit.body import PlacedBody
from satcheck.audit.motion.moving_pair import MovingPair, overlaps
from satcheck.audit.pair import Pair
from satcheck.audit.stages.depth import FREE, relation_after, way_out_of_hulls
from satcheck.audit.vectors import crossed, scaled, unit
from satcheck.core.conventions import Vector

# A part in a corner has to leave three walls.
WALLS = 3
# Directions that are tried, alone and two or three at once.
MOST_WAYS = 8
# If at most this many pairs of triangles touch, all their directions are tried; else those of one
# pair.
MOST_MEETING = 100_000
# Motion, in touch bands, after which triangles that are about to meet have met.
AHEAD = 16
# Decimals to which normals are told apart.
DIGITS = 6
# Shares of the touch band: an offset that leaves room for rounding, and a shorter one, which an
# obstacle on the other side is less likely to stop.
SHARES = (0.9, 0.3)


class ContactOffsets:
    """Finds offsets. The last successful one is tried first, because a contact usually lasts."""

    def __init__(self, pair: MovingPair) -> None:
        self._pair = pair
        self._last: Vector | None = None
        self._proven_until = -1.0

    def safe_time(self, t: float, end: float) -> float:
        """The time after t for which the bodies have no common point if A is moved by an offset.

        0.0: no offset helps."""
        if self._last is not None:
            on = self._pair.apart(t, end, self._last).time
            seamless = self._proven_until >= t and not self._pair.framed
            if self._pair.is_step(on, t, end) and (
                seamless or self._frees(self._pair.placed(t), self._last)
            ):
                return self._keep(self._last, t, on)
        placed = self._pair.placed(t)
        ahead = self._ahead(t, end)
        ways = self._ways_off(t, end, placed, self._pair.placed(ahead))
        for walls in range(1, WALLS + 1):
            for offset in self._offsets(ways, walls):
                on = self._pair.apart(t, end, offset).time
                if self._pair.is_step(on, t, end) and self._frees(placed, offset):
                    return self._keep(offset, t, on)
            # A contact as short as this does not move the start of the impact (SLID).
            if walls == 1 and overlaps(self._pair.found_at(ahead)):
                break
        self._last = None
        return 0.0

    def _keep(self, offset: Vector, t: float, on: float) -> float:
        self._last, self._proven_until = offset, t + on
        return on

    def _frees(self, placed: Pair, offset: Vector) -> bool:
        with self._pair.counting(placed):
            return relation_after(placed, offset) in FREE

    def _offsets(self, ways: list[Vector], walls: int) -> Iterator[Vector]:
        """Offsets away from so many walls at once."""
        for share in SHARES:
            length = share * self._pair.tolerance
            for chosen in combinations(ways, walls):
                x, y, z = (sum(way[axis] for way in chosen) for axis in range(3))
                yield scaled((x, y, z), length / walls)

    def _ahead(self, t: float, end: float) -> float:
        """When triangles that are about to meet have met."""
        speed = self._pair.fastest(t)
        return min(t + AHEAD * self._pair.tolerance / speed, end) if speed > 0.0 else t

    def _ways_off(self, t: float, end: float, placed: Pair, later: Pair) -> list[Vector]:
        """Unit directions in which A may leave B: the most frequent normals of triangles that
        touch, now or a few bands of motion later, when near triangles cross."""
        nearest = self._pair.apart(t, end).triangles
        normals = _normals(placed, [] if nearest is None else [nearest])
        for there in (placed, later):
            with self._pair.counting(there):
                surfaces = there.a.surface(), there.b.surface()
                meeting = core.surface_intersection(*surfaces, MOST_MEETING)
                normals += _normals(there, meeting.triangle_pairs)
        hulls = way_out_of_hulls(placed)
        first = [scaled(hulls.normal, -1.0)] if hulls.upper < self._pair.tolerance else []
        return first + [unit(normal) for normal, _ in normals.most_common(MOST_WAYS)]


def _normals(placed: Pair, pairs: Iterable[tuple[int, int]]) -> Counter[Vector]:
    """Unit normals of these triangles and how often they occur. Those of A are reversed. The
    normals of a body without an inside occur both ways."""
    normals: Counter[Vector] = Counter()
    for triangles in pairs:
        for body, triangle, way in zip((placed.a, placed.b), triangles, (-1, 1), strict=True):
            normal = _triangle_normal(body, triangle)
            if normal is None:
                continue
            for sign in (way,) if body.solid else (way, -way):
                x, y, z = (round(sign * c, DIGITS) + 0.0 for c in normal)
                normals[x, y, z] += 1
    return normals


def _triangle_normal(body: PlacedBody, index: int) -> Vector | None:
    """Unit, outward where the body is solid; None for a triangle without an area."""
    p, q, r = body.mesh.corners(index)
    u = (q[0] - p[0], q[1] - p[1], q[2] - p[2])
    v = (r[0] - p[0], r[1] - p[1], r[2] - p[2])
    normal = crossed(u, v)
    return unit(normal) if any(normal) else None
