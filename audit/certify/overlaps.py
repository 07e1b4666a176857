"""Points that show that two bodies overlap, and points that they share."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import islice
from math import isqrt
from typing import Any

from satcheck.verify.cells import sides_of
from satcheck.verify.exact import Point, Vector, cross, dot, nearest_to_origin, sub
from satcheck.verify.relations import Pair
from satcheck.verify.surfaces import close_pairs, common
from satcheck.verify.world import Exact

# A step from the surface is halved so often before it is given up.
HALVINGS = 100
MOST_CANDIDATES = 200
SETTLED = 12  # after so many halvings two equal answers are believed, where none is known

Json = dict[str, Any]


def as_json(value: Fraction) -> float | str:
    """A float where that is exact, else text."""
    rounded = float(value)
    exact = Fraction(rounded) == value
    return rounded if exact else f"{value.numerator}/{value.denominator}"


def on_surface(body: Exact, triangle: int, weights: list[Fraction]) -> Json:
    corners = body.world.triangles[triangle].tolist()
    used = [(v, w) for v, w in zip(corners, weights, strict=True) if w]
    return {"vertices": [v for v, _ in used], "weights": [as_json(w) for _, w in used]}


def nearest_points(pair: Pair, s: int, t: int) -> Json:
    """The points of two triangles next to each other; the same one where they meet."""
    corners = pair.a.corners(s), pair.b.corners(t)
    shared = common(*corners)
    if shared and all(any(_normal(c)) for c in corners):
        a, b = (_weights(c, _normal(c), shared[0]) for c in corners)
        return {"a": on_surface(pair.a, s, a), "b": on_surface(pair.b, t, b)}
    ends = [(i, j) for i in range(3) for j in range(3)]
    _, weights = nearest_to_origin([sub(corners[0][i], corners[1][j]) for i, j in ends])
    shares = [[Fraction(0)] * 3, [Fraction(0)] * 3]
    for k, weight in weights.items():
        shares[0][ends[k][0]] += weight
        shares[1][ends[k][1]] += weight
    return {"a": on_surface(pair.a, s, shares[0]), "b": on_surface(pair.b, t, shares[1])}


def contacts(pair: Pair, hint: tuple[int, int] | None) -> Iterator[tuple[int, int]]:
    """Pairs of triangles that meet, the hint first."""
    if hint is not None and common(pair.a.corners(hint[0]), pair.b.corners(hint[1])):
        yield hint
    for s, t, _ in close_pairs(pair.a, pair.b, Fraction(0)):
        if (s, t) != hint:
            yield s, t


def overlap(pair: Pair, hint: tuple[int, int] | None) -> Json | None:
    """For solids: a point inside both, one inside exactly one, and one on both surfaces.

    Beside triangles that cross lie all four combinations of the sides of two surfaces. Where no
    pair shows both (walls without thickness, faces that lie in each other) the cells of the contact
    are searched.
    """
    found: dict[str, Point] = {}
    meet = None
    for s, t in islice(contacts(pair, hint), MOST_CANDIDATES):
        meet = meet or nearest_points(pair, s, t)
        corners = pair.a.corners(s), pair.b.corners(t)
        size = min(_height(c) for c in corners)
        for start, way in _quadrants(*corners):
            if len(found) < 2:
                _look(pair, start, way, size, found)
        if len(found) == 2:
            break
    if meet is None:
        return None
    if len(found) < 2:
        _search_cells(pair, found)
    if len(found) < 2:
        return None
    points = {key: _world(point, pair.a.k) for key, point in found.items()}
    return {"kind": "overlap", "both": points["both"], "one": points["one"], "meet": meet}


def _world(p: Point, k: int) -> list[float | str]:
    return [as_json(c / (1 << k)) for c in p]


def _quadrants(a: Any, b: Any) -> Iterator[tuple[Point, Vector]]:
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
    for side_a in (-1, 1):  # behind both first: inside, as a rule
        for side_b in (-1, 1):
            way = tuple(
                side_a * (x << max(0, size_b - size_a)) + side_b * (y << max(0, size_a - size_b))
                for x, y in zip(up_a, up_b, strict=True)
            )
            yield middle, way


def _normal(t: Any) -> Vector:
    return cross(sub(t[1], t[0]), sub(t[2], t[0]))


def _height(t: Any) -> int:
    """The least height of a triangle, about, and at least 1: on the lattice."""
    n = _normal(t)
    longest = max(dot(e, e) for e in (sub(t[k], t[k - 1]) for k in range(3)))
    return isqrt(dot(n, n) // longest) or 1 if longest else 1


def _look(
    pair: Pair, start: Point, way: Any, size: int, found: dict[str, Point], key: str | None = None
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
        inside = [w != 0 for w in windings]
        found.setdefault("both" if all(inside) else "one" if any(inside) else "none", p)
        settled = key in found if key else inside == before and k > SETTLED
        if settled or len(found.keys() - {"none"}) == 2:
            break
        before = inside
    found.pop("none", None)


def _search_cells(pair: Pair, found: dict[str, Point]) -> None:
    meeting = list(contacts(pair, None))
    swapped = [(t, s) for s, t in meeting]
    for x, y, pairs in ((pair.a, pair.b, meeting), (pair.b, pair.a, swapped)):
        for sides in sides_of(x, y, pairs):
            for inside, way in ((sides.front, 1), (sides.back, -1)):
                key = "both" if all(inside) else "one" if any(inside) else "none"
                if key != "none" and key not in found:
                    normal = tuple(way * c for c in sides.normal)
                    size = _height(x.corners(sides.triangle))
                    _look(pair, sides.point, normal, size, found, key)
            if len(found) == 2:
                return


def sheet_overlap(pair: Pair, hint: tuple[int, int] | None) -> Json | None:
    """For a solid and an open surface: a point of that inside the solid, and a common one."""
    a_is_sheet = pair.b.world.solid
    sheet, solid = (pair.a, pair.b) if a_is_sheet else (pair.b, pair.a)
    for named in islice(contacts(pair, hint), MOST_CANDIDATES):
        triangle = named[0 if a_is_sheet else 1]
        for corner, p in enumerate(sheet.corners(triangle)):
            if solid.winding((Fraction(p[0]), Fraction(p[1]), Fraction(p[2]))):
                both = on_surface(sheet, triangle, [Fraction(k == corner) for k in range(3)])
                return {"kind": "overlap", "both": both, "meet": nearest_points(pair, *named)}
    meeting = list(contacts(pair, hint))
    pairs = meeting if a_is_sheet else [(t, s) for s, t in meeting]
    for sides in sides_of(sheet, solid, pairs):
        if sides.front[1] and sides.back[1]:
            weights = _weights(sheet.corners(sides.triangle), sides.normal, sides.point)
            both = on_surface(sheet, sides.triangle, weights)
            return {"kind": "overlap", "both": both, "meet": nearest_points(pair, *meeting[0])}
    return None


def _weights(corners: Any, normal: Vector, p: Point) -> list[Fraction]:
    """Of a point of the triangle, on its corners."""
    size = dot(normal, normal)
    steps = [tuple(c - d for c, d in zip(p, corner, strict=True)) for corner in corners]
    weights = []
    for k in range(3):
        u, v = steps[(k + 1) % 3], steps[(k + 2) % 3]
        weights.append(Fraction(dot(normal, cross(u, v))) / size)
    return weights


def crossing(pair: Pair, hint: tuple[int, int] | None) -> Json | None:
    """For open surfaces: two triangles that pass through each other."""
    from satcheck.verify import Rejected
    from satcheck.verify.relations import prove

    for s, t in islice(contacts(pair, hint), MOST_CANDIDATES):
        certificate = {"kind": "crossing", "triangles": [s, t]}
        try:
            prove("penetrating", certificate, pair, Fraction(0), Fraction(0))
        except Rejected:
            continue
        return certificate
    return None
