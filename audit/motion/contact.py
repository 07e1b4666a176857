"""Contact of bodies that are not both convex: two proofs that, for a while, no overlap is deeper
than the touch band.

A translation of A, shorter than the band, after which the bodies stay apart. During that time the
translation ends every overlap, so no overlap is deeper than its length.

Bodies that slide along a line, as a slider in its slot: no direction of the contact may free them.
While A moves along a line relative to B, it stays within the convex hull of its first and its last
place. The overlap stays within the band

- if the hull, made a little smaller, has no common interior with the solid B. Then no ball thicker
  than the band lies in both bodies at any time, as for bodies at rest (docs/answers.md).
- if the hull overlaps that of B by no more than the band. The translation that ends this overlap
  ends every one on the way. This is asked of convex bodies and of sheets, for example of a spike
  that passes the tip of another one: their faces show no way off.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from itertools import combinations

import numpy as np

from satcheck import core
from satcheck.audit.body import PlacedBody
from satcheck.audit.motion.moving_pair import MovingPair
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
# The hull is tried over the rest of a piece of the motion, and over so many parts of it, each half
# as long as the one before.
SLIDES = 8
# What a body has to keep of its size without the margin. A smaller one may lie in the other body.
LEAST_REST = 0.5


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
            on = self._pair.apart(t, end, self._last)
            seamless = self._proven_until >= t and not self._pair.framed
            if self._pair.is_step(on, t, end) and (
                seamless or self._frees(self._pair.placed(t), self._last)
            ):
                return self._keep(self._last, t, on)
        placed = self._pair.placed(t)
        for offset in self._offsets(self._ways_off(t, end, placed)):
            on = self._pair.apart(t, end, offset)
            if self._pair.is_step(on, t, end) and self._frees(placed, offset):
                return self._keep(offset, t, on)
        self._last = None
        return 0.0

    def _keep(self, offset: Vector, t: float, on: float) -> float:
        self._last, self._proven_until = offset, t + on
        return on

    def _frees(self, placed: Pair, offset: Vector) -> bool:
        with self._pair.counting(placed):
            return relation_after(placed, offset) in FREE

    def _offsets(self, ways: list[Vector]) -> Iterator[Vector]:
        """Offsets away from one wall, then from several at once."""
        for walls in range(1, WALLS + 1):
            for share in SHARES:
                length = share * self._pair.tolerance
                for chosen in combinations(ways, walls):
                    x, y, z = (sum(way[axis] for way in chosen) for axis in range(3))
                    yield scaled((x, y, z), length / walls)

    def _ways_off(self, t: float, end: float, placed: Pair) -> list[Vector]:
        """Unit directions in which A may leave B: the most frequent normals of triangles that
        touch, now or a few bands of motion later, when near triangles cross."""
        self._pair.apart(t, end)
        normals = _normals(placed, [self._pair.obstacle] if min(self._pair.obstacle) >= 0 else [])
        for there in (placed, self._pair.placed(self._pair.soon(t, end, AHEAD))):
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


def safe_slide(pair: MovingPair, t: float, end: float) -> float:
    """The time after t for which the bodies overlap by no more than the touch band. end: in the
    same piece of steady motion. 0.0: not proven."""
    velocity = pair.velocity(t)
    if velocity is None:
        return 0.0
    placed = pair.placed(t)
    a, b = placed.a, placed.b
    if pair.convex or not placed.both_solid:
        band = pair.tolerance - pair.pad
        return _longest(end - t, lambda s: _hulls_stay(a, b, scaled(velocity, s), band))
    margin = 0.5 * pair.tolerance - pair.pad
    span = _longest(end - t, lambda s: _sweeps_free(a, b, scaled(velocity, s), margin))
    return span or _longest(end - t, lambda s: _sweeps_free(b, a, scaled(velocity, -s), margin))


def _longest(time: float, is_safe: Callable[[float], bool]) -> float:
    """The longest safe span of those that halve the time; 0.0: none. The shortest is asked first,
    because that rejects bodies which overlap where they stand."""
    spans = [time * 0.5**k for k in range(SLIDES)]
    return next(filter(is_safe, spans), 0.0) if is_safe(spans[-1]) else 0.0


def _hulls_stay(a: PlacedBody, b: PlacedBody, step: Vector, band: float) -> bool:
    """Whether the hull of A here and after the step overlaps the hull of B by no more than the
    band."""
    corners = a.hull().vertices
    swept = core.Hull(np.vstack((corners, corners + np.array(step))))
    lower = core.check_pair(swept, b.hull_shape(), query="depth").lower
    return lower is not None and lower >= -band


def _sweeps_free(body: PlacedBody, other: PlacedBody, step: Vector, margin: float) -> bool:
    """Whether the hull of the body here and after the step, without its outermost `margin`, has no
    common interior with the other body.

    The hull is scaled about its centre, so that the corner farthest from the centre moves by the
    margin. No plane of a face is farther from the centre, so none moves by more, and every point
    that lies deeper than the margin stays inside.
    """
    corners, triangles = body.hull().vertices, body.hull().triangles
    ends = np.vstack((corners, corners + np.array(step)))
    faces = np.vstack((triangles, triangles + np.uint32(len(corners))))
    hull = core.Mesh(ends, faces).convex_hull().to_mesh()
    centre = hull.vertices.mean(axis=0)
    from_centre = hull.vertices - centre
    factor = 1.0 - margin / float(np.linalg.norm(from_centre, axis=1).max())
    if factor < LEAST_REST:
        return False
    smaller = core.Surface(core.Mesh(centre + factor * from_centre, hull.triangles), True)
    relation = core.mesh_relation(smaller, other.surface())
    return relation.proven and relation.relation in FREE
