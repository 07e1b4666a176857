"""Lower bounds of a depth.

Of convex bodies: an inner polytope of the Minkowski difference, which also proves their overlap.

Of other solids: a cube around all shorter translations, halved into parts. Each part lies in an
overlap set, or no translation in it is shorter. P is a polytope inside A and Q one inside B: no
triangle of the surface enters it, and the surface runs around a point of it. Moved by t, the inside
of P meets that of Q for every t inside Q - P. The facets of a closed surface of differences q - p,
seen from a point behind all of them, bound a part of Q - P: a ray from there leaves the part at a
facet. Facets farther out than the bound do not matter.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction

import numpy as np

from satcheck.report.certificate import Cover, OverlapSet, Polytope, PolytopeProof, Region
from satcheck.verify.exact import Floats, Point, Rejected, dot, grouped, normal_of, point, sub
from satcheck.verify.pairs import index
from satcheck.verify.surfaces import TINY, Mask, lengths
from satcheck.verify.world import Exact, Indices, is_flat

MOST_FACES = 100_000
ROUNDOFF = 2.0**-53
HUGE = 1e300  # sums of smaller terms do not overflow
AT_ONCE = 1 << 16  # planes, times points, whose sides are found


def inner_radius_exceeds(
    polytope: Polytope | PolytopeProof, a: Exact, b: Exact, radius: Fraction
) -> None:
    """Rejects a polytope that does not contain the ball of this radius (world) around the origin.

    Its vertices are a_i - b_j. Where each directed edge meets its reverse once, and the origin
    lies behind every face, the surface runs around the origin. So every ray from there meets it,
    nowhere nearer than the nearest face plane.
    """
    points = [
        sub(a.points[index(i, len(a.points))], b.points[index(j, len(b.points))])
        for i, j in polytope.vertices
    ]
    check_closed(polytope)
    least = radius * a.scale
    for face in polytope.faces:
        corners = [points[v] for v in face]
        normal = normal_of(corners)
        height = dot(normal, corners[0])
        if height <= 0:
            raise Rejected("the origin is not strictly inside the polytope")
        if height * height < least * least * dot(normal, normal):
            raise Rejected("a face of the polytope is nearer than the lower bound of the depth")


def check_closed(polytope: Polytope | PolytopeProof) -> None:
    """Rejects a surface that does not run each edge once in either direction."""
    faces = polytope.faces
    if not 4 <= len(faces) <= MOST_FACES or len(polytope.vertices) > MOST_FACES:
        raise Rejected("a polytope has at least 4 faces, and not too many")
    edges = {(face[k - 1], face[k]) for face in faces for k in range(3)}
    index(max(map(max, faces)), len(polytope.vertices))
    if len(edges) < 3 * len(faces):
        raise Rejected("the polytope runs an edge twice")
    if any((q, p) not in edges for p, q in edges):
        raise Rejected("the polytope is not closed")


MOST_PARTS = 200_000
MOST_SETS = 5_000
HALVED, FAR = -1, -2
# The root has so few digits, and is halved so rarely along each axis, that all middles are exact.
ROOT_DIGITS, MOST_HALVINGS = 20, 30
MOST_BITS = 400  # no part is so small then that a float rounds its middle
Box = tuple[float, float, float, float, float, float]  # its middle, and half its edges


def depth_is_at_least(cover: Cover, a: Exact, b: Exact, depth: float) -> None:
    """Rejects a cover that does not prove that every translation of A shorter than this (world
    units) leaves a common interior."""
    if not (a.world.solid and b.world.solid):
        raise Rejected("a cover proves something about solids only")
    if len(cover.parts) > MOST_PARTS or len(cover.sets) > MOST_SETS:
        raise Rejected(f"a cover has at most {MOST_PARTS:,} parts and {MOST_SETS:,} sets")
    if not cover.half >= depth > 0:
        raise Rejected("the cover leaves out a part of the ball")
    held = grouped(_leaves(cover))
    far = np.array(held.pop(FAR, [])).reshape(-1, 6)
    steps = np.maximum(np.abs(far[:, :3]) - far[:, 3:], 0.0)  # exact
    close = lengths(steps) < depth * (1 + 8 * ROUNDOFF)
    if any(sum(Fraction(c) ** 2 for c in p) < Fraction(depth) ** 2 for p in steps[close].tolist()):
        raise Rejected("the cover leaves out a part of the ball")
    with np.errstate(all="ignore"):  # what overflows is rejected
        for number, parts in held.items():
            overlap = cover.sets[index(number, len(cover.sets))]
            _is_in_solid(overlap.a, a, cover.origin)
            _is_in_solid(overlap.b, b, cover.origin)
            _holds(overlap, np.array(parts), cover.half, depth)


def _leaves(cover: Cover) -> Iterator[tuple[int, Box]]:
    """The parts that are not halved, in preorder."""
    half = cover.half
    mantissa, exponent = math.frexp(half)
    if not (mantissa * 2**ROOT_DIGITS).is_integer() or abs(exponent) > MOST_BITS:
        raise Rejected("half the edge of a cover has too many digits")
    pending: list[Box] = [(0.0, 0.0, 0.0, half, half, half)]
    for kind in cover.parts:
        if not pending:
            raise Rejected("a cover has more parts than halving makes")
        part = pending.pop()
        if kind == HALVED:
            lower, upper = _halves(part)
            pending += [upper, lower]
            if min(lower[3:]) * 2**MOST_HALVINGS < half:
                raise Rejected("a part of a cover is halved too often")
        else:
            yield kind, part
    if pending:
        raise Rejected("the cover leaves out a part of the ball")


def _halves(part: Box) -> tuple[Box, Box]:
    """Across the longest edge, exactly."""
    axis = max(range(3), key=lambda k: part[3 + k])
    lower, upper = list(part), list(part)
    lower[3 + axis] = upper[3 + axis] = half = part[3 + axis] / 2
    lower[axis] -= half
    upper[axis] += half
    return tuple(lower), tuple(upper)  # type: ignore[return-value]


def _is_in_solid(region: Region, body: Exact, origin: Sequence[float]) -> None:
    """Rejects a polytope whose inside is not part of the inside of the solid.

    Each triangle is at least as far along some normal as all corners: along one of them heights are
    off by 4 roundoffs of the sum of their terms, and by one of the points less the origin.
    """
    corners, normals = np.array(region.vertices), np.array(region.normals)
    if len(corners) < 4 or not len(normals) or is_flat(corners):
        raise Rejected("a region of a cover has no inside")
    points = body.world.vertices - np.array(origin)
    size = max(float(np.abs(points).max()), float(np.abs(corners).max()))
    scale = size * np.abs(normals).sum(axis=1)
    if not (scale < HUGE).all():
        raise Rejected("a normal of a region of a cover is too long")
    error = 16 * ROUNDOFF * scale + TINY
    is_beyond = points @ normals.T >= (corners @ normals.T).max(axis=0) + error
    if not is_beyond[body.world.triangles].all(axis=1).any(axis=1).all():
        raise Rejected("the surface of a body enters a region of a cover")
    middle = point(sum(map(Fraction, row)) / len(corners) for row in corners.T.tolist())
    at = body.at(m + Fraction(o) for m, o in zip(middle, origin, strict=True))
    if not body.winding(at):
        raise Rejected("a region of a cover lies outside of its body")


def _holds(overlap: OverlapSet, parts: Floats, half: float, depth: float) -> None:
    """Rejects a set that does not hold all translations in the parts that are shorter than the
    depth. In float64; exactly where that leaves it open."""
    facets = _Facets(overlap, half)
    for number in facets.not_seen():
        normal, height = facets.exact(number)
        if dot(normal, point(facets.middle.tolist())) >= height:
            raise Rejected("the facets of a set of a cover are not seen from within")
    near = facets.nearer(depth)
    off = Fraction(facets.off)
    step = 1 + AT_ONCE // (1 + len(near))
    for start in range(0, len(parts), step):
        some = parts[start : start + step]
        is_open = ~facets.hold(near, some)
        for row in np.flatnonzero(is_open.any(axis=1)).tolist():
            normal, height = facets.exact(int(near[row]))
            across = [abs(c) for c in normal]
            left = height - off * sum(across)
            if left > 0 and left**2 >= Fraction(depth) ** 2 * dot(normal, normal):
                continue
            for part in some[is_open[row]].tolist():
                if dot(normal, point(part[:3])) + dot(across, point(part[3:])) >= left:
                    raise Rejected("a part of a cover is not shown to overlap")


class _Facets:
    """The planes normal . x = height of the facets of a set. middle: a translation about in their
    middle.

    Their corners are rounded, by `off` along each axis at most. What is that far behind the facets
    lies in the set itself: where X + C is part of Y + C, of convex sets, X is part of Y.

    error: how far rounding takes normal . x - height, for translations x in the cover, and corners.
    A normal is off by 5 roundoffs of the products that it is the difference of, times lines of
    twice that size; points, sums of products, their difference and half edges of boxes take 32.
    """

    def __init__(self, overlap: OverlapSet, half: float) -> None:
        check_closed(overlap.difference)
        of_a, of_b = (np.array(region.vertices) for region in (overlap.a, overlap.b))
        i, j = np.array(overlap.difference.vertices).T
        index(int(i.max()), len(of_a))
        index(int(j.max()), len(of_b))
        corners = of_b[j] - of_a[i]
        largest = float(np.abs(corners).max())
        self.triangles: Floats = corners[np.array(overlap.difference.faces)]
        self.middle, self.off = corners.mean(axis=0), 2 * ROUNDOFF * largest
        e, f = (self.triangles[:, k] - self.triangles[:, 0] for k in (1, 2))
        self.normals = np.cross(e, f)
        self.heights = np.einsum("nk,nk->n", self.normals, self.triangles[:, 0])
        e, f, size = np.abs(e), np.abs(f), largest + half
        products = e[:, [1, 2, 0]] * f[:, [2, 0, 1]] + e[:, [2, 0, 1]] * f[:, [1, 2, 0]]
        scale = size * products.sum(axis=1)
        error = 64 * ROUNDOFF * scale + (1 + size) * TINY
        self.error: Floats = np.where(scale < HUGE, error, np.inf)

    def not_seen(self) -> list[int]:
        """The facets of which the middle may be in front."""
        above = self.heights - self.normals @ self.middle
        return np.flatnonzero(~(above > self.error)).tolist()

    def nearer(self, depth: float) -> Indices:
        """The facets that may be nearer to the origin than the depth."""
        margins = self.off * np.abs(self.normals).sum(axis=1) + self.error
        is_far = self.heights - depth * lengths(self.normals) * (1 + 8 * ROUNDOFF) > margins
        return np.flatnonzero(~is_far)

    def hold(self, near: Indices, parts: Floats) -> Mask:
        """Whether each part lies behind each of these facets, as far as float64 tells."""
        normals = self.normals[near]
        highest = normals @ parts[:, :3].T + np.abs(normals) @ (parts[:, 3:] + self.off).T
        held: Mask = self.heights[near, None] - highest > self.error[near, None]
        return held

    def exact(self, number: int) -> tuple[Point, Fraction]:
        """The normal and the height of a facet."""
        p, q, r = map(point, self.triangles[number].tolist())
        normal = normal_of((p, q, r))
        return normal, dot(normal, p)
