"""Points that prove an overlap of two bodies, and points that both share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import islice, product
from math import isqrt
from typing import Any

import numpy as np

from satcheck.audit.certify.values import exact_number, exact_point, or_unset
from satcheck.report.certificate import CrossingProof, Ends, ExactVector, OnBody, OverlapProof
from satcheck.verify.boundary import Boundary
from satcheck.verify.cells import sides_of
from satcheck.verify.exact import IntVector, Point, Rejected, cross, dot, nearest_to_origin, sub
from satcheck.verify.relations import A_ALONE, B_ALONE, BOTH, Pair, prove
from satcheck.verify.surfaces import close_pairs, common
from satcheck.verify.world import Exact

# A step from the surface is halved so often before it is given up.
HALVINGS = 100
MOST_CANDIDATES = 200
SETTLED = 12  # after so many halvings two equal answers are believed, where none is known

MOST_OF_A_PART = 4
# How a point lies, (in A, in B), by the name that certificates have for it.
WAYS = {BOTH: "both", A_ALONE: "a_alone", B_ALONE: "b_alone"}

Points = dict[str, Point]


def on_surface(body: Exact, triangle: int, weights: list[Fraction]) -> OnBody:
    corners = body.world.triangles[triangle].tolist()
    used = [(v, w) for v, w in zip(corners, weights, strict=True) if w]
    return OnBody(tuple(v for v, _ in used), tuple(exact_number(w) for _, w in used))


def nearest_points(pair: Pair, s: int, t: int) -> Ends:
    """The points of two triangles next to each other."""
    corners = pair.a.corners(s), pair.b.corners(t)
    ends = [(i, j) for i in range(3) for j in range(3)]
    _, weights = nearest_to_origin([sub(corners[0][i], corners[1][j]) for i, j in ends])
    shares = [[Fraction(0)] * 3, [Fraction(0)] * 3]
    for k, weight in weights.items():
        shares[0][ends[k][0]] += weight
        shares[1][ends[k][1]] += weight
    return Ends(on_surface(pair.a, s, shares[0]), on_surface(pair.b, t, shares[1]))


def contacts(pair: Pair, hint: tuple[int, int] | None) -> Iterator[tuple[int, int]]:
    """Pairs of triangles that meet, the hint first."""
    if hint is not None and common(pair.a.corners(hint[0]), pair.b.corners(hint[1])):
        yield hint
    for s, t, _ in close_pairs(pair.a, pair.b, Fraction(0)):
        if (s, t) != hint:
            yield s, t


def boundary_contact(
    pair: Pair, hint: tuple[int, int] | None, across: int | None = None
) -> Ends | None:
    """A common point of the boundaries. across: of prisms along this axis, one between their ends,
    in the middle of what two of their walls share."""
    boundary_a, boundary_b = Boundary(pair.a), Boundary(pair.b)
    ends = set() if across is None else {abs(p[across]) for p in pair.a.points}
    for s, t in contacts(pair, hint):
        for p, q in product(boundary_a.pieces(s), boundary_b.pieces(t)):
            shared = common(p, q)
            for point in shared[:1] if across is None else _middle(shared):
                if across is None or abs(point[across]) not in ends:
                    return Ends(point_of(pair.a, s, point), point_of(pair.b, t, point))
    return None


def _middle(points: list[Point]) -> list[Point]:
    if not points:
        return []
    x, y, z = (sum((p[k] for p in points), Fraction()) / len(points) for k in range(3))
    return [(x, y, z)]


def point_of(body: Exact, triangle: int, p: Point) -> OnBody:
    """A point of the triangle by its weights."""
    _, weights = nearest_to_origin([_minus(corner, p) for corner in body.corners(triangle)])
    return on_surface(body, triangle, [weights.get(k, Fraction(0)) for k in range(3)])


def _minus(p: Any, q: Point) -> Any:
    return tuple(c - d for c, d in zip(p, q, strict=True))


def overlap(
    pair: Pair, hint: tuple[int, int] | None, across: int | None = None
) -> OverlapProof | None:
    """For solids: a point inside both, and one inside each alone; or one inside one of them alone,
    and one where both end.

    Beside triangles that cross lie all four combinations of the sides of two surfaces. Where no
    pair shows them (walls without thickness, faces that lie in each other) the cells of the contact
    are searched.
    """
    points: Points = {}
    for s, t in islice(contacts(pair, hint), MOST_CANDIDATES):
        corners = pair.a.corners(s), pair.b.corners(t)
        size = min(_height(c) for c in corners)
        for start, way in _quadrants(*corners):
            _look(pair, start, way, size, points)
        if _shows_overlap(points):
            break
    else:
        _search_regions(pair, points, _is_complete)
    if not _shows_overlap(points):
        _search_cells(pair, points, _shows_overlap)
    meet = None if _is_complete(points) else boundary_contact(pair, hint, across)
    if meet is None and not _is_complete(points):
        _search_regions(pair, points, _is_complete)
    if meet is None and not _is_complete(points):
        _search_cells(pair, points, _is_complete)
    if not (_is_complete(points) or (meet and _shows_overlap(points))):
        return None
    world = {key: _world(point, pair.a.k) for key, point in points.items()}
    alone = or_unset(world.get("a_alone")), or_unset(world.get("b_alone"))
    return OverlapProof(world["both"], *alone, or_unset(meet))


def _is_complete(points: Points) -> bool:
    return len(points) == len(WAYS)


def _shows_overlap(points: Points) -> bool:
    return "both" in points and len(points) > 1


def inside_both(pair: Pair) -> OnBody | ExactVector | None:
    """A point inside two solids, or one of a sheet inside a solid."""
    points: Points = {}
    if not (pair.a.world.solid and pair.b.world.solid):
        return _sheet_point(pair, True)
    for search in (_search_regions, _search_cells):
        search(pair, points, lambda points: "both" in points)
        if "both" in points:
            return _world(points["both"], pair.a.k)
    return None


def _world(p: Point, k: int) -> ExactVector:
    return exact_point(c / (1 << k) for c in p)


def _quadrants(a: Any, b: Any) -> Iterator[tuple[Point, IntVector]]:
    """The middle of the segment in which two triangles cross, and ways from there to each of the
    four combinations of their sides."""
    shared = common(a, b)
    n, m = _normal(a), _normal(b)
    if len(shared) != 2 or not any(cross(n, m)):
        return
    # Not the very middle: symmetric meshes have edges there.
    middle: Point = tuple((3 * p + 4 * q) / 7 for p, q in zip(*shared, strict=True))
    # The part of each normal that is perpendicular to the other one: a step along it changes one
    # height alone.
    up_a = tuple(dot(m, m) * x - dot(n, m) * y for x, y in zip(n, m, strict=True))
    up_b = tuple(dot(n, n) * y - dot(n, m) * x for x, y in zip(n, m, strict=True))
    size_a, size_b = (max(abs(c) for c in v).bit_length() for v in (up_a, up_b))
    for side_a in (-1, 1):  # behind both first: usually inside
        for side_b in (-1, 1):
            way = tuple(
                side_a * (x << max(0, size_b - size_a)) + side_b * (y << max(0, size_a - size_b))
                for x, y in zip(up_a, up_b, strict=True)
            )
            yield middle, way


def _normal(t: Any) -> IntVector:
    return cross(sub(t[1], t[0]), sub(t[2], t[0]))


def _height(t: Any) -> int:
    """The least height of a triangle, about, and at least 1: on the lattice."""
    n = _normal(t)
    longest = max(dot(e, e) for e in (sub(t[k], t[k - 1]) for k in range(3)))
    return isqrt(dot(n, n) // longest) or 1 if longest else 1


def _look(
    pair: Pair, start: Point, way: Any, size: int, points: Points, key: str | None = None
) -> None:
    """Shorter and shorter steps from the surface, until what is inside stays the same.

    size: of the longest, times 8. key: what lies beside the surface, where that is known.
    """
    scale = Fraction(size, max(abs(c) for c in way))
    before = None
    for k in range(3, HALVINGS, 4):
        step = scale / (1 << k)
        p: Point = tuple(c + step * d for c, d in zip(start, way, strict=True))
        windings = [body.winding(p) for body in (pair.a, pair.b)]
        if None in windings:
            continue
        inside = windings[0] != 0, windings[1] != 0
        if inside in WAYS:
            points.setdefault(WAYS[inside], p)
        settled = key in points if key else inside == before and k > SETTLED
        if settled or _is_complete(points):
            break
        before = inside


def _search_regions(pair: Pair, points: Points, enough: Callable[[Points], bool]) -> None:
    """Beside a few triangles of each part of either surface."""
    for body in (pair.a, pair.b):
        label = body.world.labels(body.world.triangles)[body.world.triangles[:, 0]]
        for part in np.unique(label):
            for t in np.flatnonzero(label == part)[:MOST_OF_A_PART].tolist():
                corners = body.corners(t)
                normal = _normal(corners)
                if not any(normal):
                    continue
                # Not the very middle: symmetric meshes have edges there.
                p, q, r = corners
                start: Any = tuple(Fraction(2 * p[k] + 3 * q[k] + 4 * r[k], 9) for k in range(3))
                for way in (normal, tuple(-c for c in normal)):
                    _look(pair, start, way, _height(corners), points)
                if enough(points):
                    return


def _search_cells(pair: Pair, points: Points, enough: Callable[[Points], bool]) -> None:
    """Beside every piece of either surface that lies where the other one meets it, or inside."""
    meeting = list(contacts(pair, None))
    swapped = [(t, s) for s, t in meeting]
    for x, y, pairs in ((pair.a, pair.b, meeting), (pair.b, pair.a, swapped)):
        for sides in sides_of(x, y, pairs, lambda inside: inside):
            for inside, way in ((sides.front, 1), (sides.back, -1)):
                key = WAYS.get(inside if x is pair.a else (inside[1], inside[0]))
                if key is not None and key not in points:
                    normal = tuple(way * c for c in sides.normal)
                    size = _height(x.corners(sides.triangle))
                    _look(pair, sides.point, normal, size, points, key)
            if enough(points):
                return


def sheet_overlap(pair: Pair, hint: tuple[int, int] | None) -> OverlapProof | None:
    """For a solid and an open surface: a point of that inside the solid, and one outside or where
    the solid ends."""
    both = _sheet_point(pair, True)
    if both is None:
        return None
    meet = boundary_contact(pair, hint)
    if meet is not None:
        return OverlapProof(both, meet=meet)
    alone = _sheet_point(pair, False)
    if alone is None:
        return None
    return OverlapProof(both, b_alone=alone) if pair.a.world.solid else OverlapProof(both, alone)


def _sheet_point(pair: Pair, inside: bool) -> OnBody | None:
    """A point of the open surface inside the solid, or outside of it."""
    a_is_sheet = pair.b.world.solid
    sheet, solid = (pair.a, pair.b) if a_is_sheet else (pair.b, pair.a)
    meeting = [(s, t) if a_is_sheet else (t, s) for s, t in contacts(pair, None)]
    near = [s for s, _ in meeting[:MOST_CANDIDATES]]
    for triangle in [*near, *range(len(sheet.world.triangles))][: 2 * MOST_CANDIDATES]:
        for corner, p in enumerate(sheet.corners(triangle)):
            winding = solid.winding((Fraction(p[0]), Fraction(p[1]), Fraction(p[2])))
            if winding is not None and (winding != 0) is inside:
                return on_surface(sheet, triangle, [Fraction(k == corner) for k in range(3)])
    for sides in sides_of(sheet, solid, meeting, inside.__eq__):
        if sides.front[1] is sides.back[1] is inside:
            return point_of(sheet, sides.triangle, sides.point)
    return None


def crossing(pair: Pair, hint: tuple[int, int] | None) -> CrossingProof | None:
    """For sheets: two triangles that pass through each other."""
    for s, t in islice(contacts(pair, hint), MOST_CANDIDATES):
        certificate = CrossingProof((s, t))
        try:
            prove("penetrating", certificate, pair, Fraction(0), Fraction(0))
        except Rejected:
            continue
        return certificate
    return None
