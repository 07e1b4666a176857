"""Whether the surface of a body has a point deeper than a length in a solid.

Its triangles are halved into pieces until each shows that it has none. Let a piece lie within r of
a point c, and the surface of the solid be s from c. No point of the piece is deeper than

    max |v - T|    v its corners, T a triangle of the solid: the distance to T is convex
    s + r          the distance to the surface changes by no more than the way
    r - s          where c is outside: the way to a point inside leads through the surface

nor than the length, where all corners are no farther than that from one side of the solid's box, or
beyond it. Lengths are bounded in float64 with their rounding; whether c is outside is decided in
rationals.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from satcheck.verify.cells import chosen
from satcheck.verify.exact import Floats, Point, Rejected, point
from satcheck.verify.patches import SUM_ERROR, TINY, lengths, next_points, slack
from satcheck.verify.surfaces import Mask
from satcheck.verify.world import Exact, Indices

MOST_PIECES = 50_000
MOST_HALVINGS = 64
# How far all halvings together round a corner, of the largest coordinate.
MIDDLE_ERROR = 2.0**-45


def reaches_no_deeper(
    body: Exact, solid: Exact, contacts: list[tuple[int, int]], length: Fraction
) -> None:
    """Rejects a body unless it is proven that no point of its surface lies deeper than the length,
    world units, in the solid. contacts: all pairs of triangles that meet."""
    reach = _Reach(body, solid, float(length) * (1 - SUM_ERROR))
    inside = chosen(body, solid, contacts, lambda inside: inside)
    triangles = body.world.vertices[body.world.triangles[inside]]
    for triangle in triangles[~reach.is_shallow(triangles)]:
        reach.is_kept(triangle)


class _Reach:
    """Pieces are (3, 3) float64, no farther than `off` from the exact ones."""

    def __init__(self, body: Exact, solid: Exact, length: float) -> None:
        self.solid, self.length, self.pieces = solid, length, 0
        self.triangles: Floats = solid.world.vertices[solid.world.triangles]
        self.low, self.high = solid.world.bounds
        largest = max(np.abs(end).max() for e in (body, solid) for end in e.world.bounds)
        self.off = float(MIDDLE_ERROR * largest + TINY)

    def is_shallow(self, pieces: Floats) -> Mask:
        """Whether the box of the solid shows it, of pieces (n, 3, 3)."""
        beyond = pieces.min(axis=1) - (self.high - self.length)
        before = (self.low + self.length) - pieces.max(axis=1)
        return np.asarray((np.maximum(beyond, before) >= 2 * self.off).any(axis=1))

    def is_kept(self, triangle: Floats) -> None:
        """Rejects a triangle with a deeper point, and one that is not decided."""
        pending = [(triangle, self._near(triangle), 0)]
        while pending:
            piece, near, halvings = pending.pop()
            self.pieces += 1
            if self.pieces > MOST_PIECES or halvings > MOST_HALVINGS:
                raise Rejected(f"how deep a surface reaches is open after {self.pieces:,} pieces")
            closest = self._closest(piece, near)
            if closest is not None:
                halves = np.array(list(_halves(piece)))
                left = halves[~self.is_shallow(halves)]
                pending += [(half, closest, halvings + 1) for half in left]

    def _near(self, piece: Floats) -> Indices:
        """The triangles whose boxes may be next to a point of the piece."""
        centre, radius = self._ball(piece)
        world = self.solid.world
        gaps = lengths(np.maximum(np.maximum(world.low - centre, centre - world.high), 0.0))
        surface = lengths(self.triangles[:, 0] - centre).min()
        return np.flatnonzero(gaps <= (surface + 2 * radius) * (1 + SUM_ERROR))

    def _ball(self, piece: Floats) -> tuple[Floats, float]:
        """A centre, and a radius that holds the exact piece."""
        centre = piece.mean(axis=0)
        return centre, float(lengths(piece - centre).max()) * (1 + SUM_ERROR) + 2 * self.off

    def _closest(self, piece: Floats, near: Indices) -> Indices | None:
        """The triangles that may be next to a point of the piece, of those near it; None: no point
        of the piece is deeper than the length."""
        centre, radius = self._ball(piece)
        least, most = _distances(centre, self.triangles[near])
        nearest = int(most.argmin())
        surface, at_least = float(most[nearest]), float(least.min())
        if surface + radius <= self.length:
            return None
        spokes = self.triangles[near[nearest]] - piece[:, None]
        if (lengths(next_points(spokes)) + slack(spokes)).max() + self.off <= self.length:
            return None
        if at_least > self.length or radius - at_least <= self.length:
            outside = self.solid.winding(self._on_lattice(centre)) == 0
            if not outside and at_least > self.length:
                raise Rejected("a thin part of a body reaches deep into the other one")
            if outside and radius - at_least <= self.length:
                return None
        kept: Indices = near[least <= (surface + 2 * radius) * (1 + SUM_ERROR)]
        return kept

    def _on_lattice(self, p: Floats) -> Point:
        return point(Fraction(c) * (1 << self.solid.k) for c in p.tolist())


def _distances(point: Floats, triangles: Floats) -> tuple[Floats, Floats]:
    """Bounds of the distances of a point (3,) from triangles (n, 3, 3), (n,)."""
    spokes = triangles - point
    nearest, error = next_points(spokes), slack(spokes)
    most = lengths(nearest)
    with np.errstate(all="ignore"):
        heights = np.einsum("nkj,nj->nk", spokes, nearest / most[:, None]).min(axis=1)
    least = np.nan_to_num(heights - error, nan=0.0)
    return np.maximum(least, 0.0), most + error


def _halves(piece: Floats) -> Iterator[Floats]:
    """Of a piece cut across its longest edge."""
    k = int(lengths(np.roll(piece, -1, axis=0) - piece).argmax())
    p, q, apex = piece[k], piece[(k + 1) % 3], piece[(k + 2) % 3]
    middle = 0.5 * p + 0.5 * q
    yield np.array([p, middle, apex])
    yield np.array([middle, q, apex])
