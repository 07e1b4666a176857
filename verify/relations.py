"""What each kind of certificate proves about the relation of two bodies, checked exactly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from satcheck.verify.boundary import boundary_point, contacts_if_apart
from satcheck.verify.cells import Sides, sheets_among, sides_of
from satcheck.verify.evidence import (
    axis,
    exceeds,
    gap_along,
    index,
    member,
    on_body,
    triangle_of,
    vector,
)
from satcheck.verify.exact import Point, Rejected, Vector, cross, dot, sub
from satcheck.verify.polytope import inner_radius_exceeds
from satcheck.verify.sheets import no_crossing
from satcheck.verify.surfaces import common, meeting
from satcheck.verify.world import Exact, count_by_triangle

OVERLAPS = ("penetrating", "contains", "inside", "coincident")
# How a point lies: (in A, in B).
BOTH, A_ALONE, B_ALONE = (True, True), (True, False), (False, True)
Way = tuple[bool, bool]


@dataclass(frozen=True, slots=True)
class Pair:
    """Two bodies on one lattice. convex: both are exactly convex in their files, so that each is
    taken as the hull of its world vertices."""

    a: Exact
    b: Exact
    convex: bool


def prove(relation: str, certificate: Any, pair: Pair, beyond: Fraction, least: Fraction) -> bool:
    """Rejects a certificate that does not prove the exact relation.

    A separation has to be over `beyond` and at least `least`, world units. Returns whether the
    hulls have no common interior, so that neither body can lie inside the other.
    """
    kind = member(certificate, "kind")
    proofs: dict[tuple[str, str], Callable[[Any, Pair], None]] = {
        ("touching", "axis"): _touching_by_axis,
        ("touching", "surfaces"): _touching_by_surfaces,
        ("penetrating", "overlap"): _overlap,
        ("penetrating", "crossing"): _crossing,
        ("penetrating", "polytope"): _hulls_overlap,
        ("contains", "surfaces"): _contains,
        ("inside", "surfaces"): _inside,
        ("coincident", "same"): _same,
    }
    if (relation, kind) == ("separated", "axis"):
        n = axis(member(certificate, "axis"))
        gap = gap_along(pair.a, pair.b, n)
        if not exceeds(gap, n, beyond) or gap * gap < least * least * dot(n, n):
            raise Rejected("the axis does not separate the bodies by as much as claimed")
        return True
    if (relation, kind) == ("separated", "surfaces"):
        _nowhere({BOTH}, pair, contacts_if_apart(pair.a, pair.b, beyond, least))
        return False
    if not isinstance(kind, str) or (relation, kind) not in proofs:
        raise Rejected(f"a certificate of this kind proves no relation {relation!r}")
    proofs[relation, kind](certificate, pair)
    return (relation, kind) == ("touching", "axis")


def prove_free(certificate: Any, pair: Pair) -> None:
    """No common interior: separated or touching."""
    kind = member(certificate, "kind")
    if kind == "axis":
        _weakly_separated(certificate, pair)
    elif kind == "surfaces":
        _no_overlap(pair)
    else:
        raise Rejected("a certificate of this kind proves no way out")


def common_point(certificate: Any, pair: Pair, *, of_hulls: bool) -> None:
    """{"a": point, "b": point}, which must be the same, of both boundaries or both hulls."""
    p = boundary_point(member(certificate, "a"), pair.a, of_hull=of_hulls)
    if p != boundary_point(member(certificate, "b"), pair.b, of_hull=of_hulls):
        raise Rejected("the common point is not the same point on both bodies")


def _weakly_separated(certificate: Any, pair: Pair) -> None:
    if gap_along(pair.a, pair.b, axis(member(certificate, "axis"))) < 0:
        raise Rejected("the bodies overlap along the axis")


def _touching_by_axis(certificate: Any, pair: Pair) -> None:
    common_point(member(certificate, "contact"), pair, of_hulls=pair.convex)
    _weakly_separated(certificate, pair)


def _touching_by_surfaces(certificate: Any, pair: Pair) -> None:
    common_point(member(certificate, "contact"), pair, of_hulls=False)
    _no_overlap(pair)


def _no_overlap(pair: Pair) -> None:
    contacts = meeting(pair.a, pair.b)
    _nowhere({BOTH}, pair, contacts)
    of_a, of_b = (sheets_among(body, contacts, k) for k, body in enumerate((pair.a, pair.b)))
    no_crossing(pair.a, pair.b, [(s, t) for s, t in contacts if s in of_a and t in of_b])


def _nowhere(ways: set[Way], pair: Pair, contacts: list[tuple[int, int]]) -> None:
    """Rejects bodies with a point that lies in one of these ways. contacts: all pairs that meet.

    A region of one surface that the other does not meet lies inside of that or outside; it is
    looked at where that is part of one of the ways. A sheet is its points, and has no inside.
    """
    a, b = pair.a, pair.b
    views = [(a, b, contacts, ways)]
    views += [(b, a, [(t, s) for s, t in contacts], {(in_b, in_a) for in_a, in_b in ways})]
    for x, y, pairs, seen_from_x in views:
        if not y.world.solid:
            continue
        theirs = {in_y for _, in_y in seen_from_x}
        for sides in sides_of(x, y, pairs, theirs.__contains__):
            if seen_from_x & _ways_beside(sides, x.world.solid):
                raise Rejected("beside a point of the surfaces the bodies lie otherwise")


def _ways_beside(sides: Sides, solid: bool) -> set[Way]:
    ways = {sides.front, sides.back} if solid else set()
    if solid and (sides.front[0] or sides.back[0]):
        return ways
    # A sheet within the boundary of a solid is neither inside nor outside of it.
    return ways | {(True, inside) for inside in (sides.front[1],) if inside == sides.back[1]}


def _contains(certificate: Any, pair: Pair) -> None:
    if not pair.a.world.solid:
        raise Rejected("what is not solid contains nothing")
    _has_point(BOTH, certificate, "both", pair)
    _nowhere({B_ALONE}, pair, contacts_if_apart(pair.a, pair.b, Fraction(0), Fraction(0)))


def _inside(certificate: Any, pair: Pair) -> None:
    if not pair.b.world.solid:
        raise Rejected("what is not solid contains nothing")
    _has_point(BOTH, certificate, "both", pair)
    _nowhere({A_ALONE}, pair, contacts_if_apart(pair.a, pair.b, Fraction(0), Fraction(0)))


def _overlap(certificate: Any, pair: Pair) -> None:
    """A point inside both, and one inside either alone; or inside one of them alone, and a common
    point of the boundaries. Something of a solid is always outside of a sheet."""
    if not (pair.a.world.solid or pair.b.world.solid):
        raise Rejected("two bodies without an inside have no common interior")
    _has_point(BOTH, certificate, "both", pair)
    alone = 0
    for key, way, other in (("a_alone", A_ALONE, pair.b), ("b_alone", B_ALONE, pair.a)):
        if other.world.solid and key in certificate:
            _has_point(way, certificate, key, pair)
        alone += not other.world.solid or key in certificate
    if alone == 0:
        raise Rejected("no point shows that one is not the other")
    if alone == 1:
        common_point(member(certificate, "meet"), pair, of_hulls=False)


def _has_point(way: Way, certificate: Any, key: str, pair: Pair) -> None:
    """Of two solids: three numbers. Of a solid and a sheet: a point of the sheet."""
    value, bodies = member(certificate, key), (pair.a, pair.b)
    sheet = next((body for body in bodies if not body.world.solid), None)
    inside = _solids_at(value, pair) if sheet is None else _solid_at(value, sheet, pair)
    if inside != way:
        raise Rejected(f"the point given as {key!r} lies otherwise")


def _solids_at(value: Any, pair: Pair) -> Way:
    x, y, z = (c * (1 << pair.a.k) for c in vector(value))
    windings = [body.winding((x, y, z)) for body in (pair.a, pair.b)]
    if None in windings:
        raise Rejected("a point lies on a surface")
    return windings[0] != 0, windings[1] != 0


def _solid_at(value: Any, sheet: Exact, pair: Pair) -> Way:
    solid = pair.b if sheet is pair.a else pair.a
    p = on_body(value, sheet, of_hull=False)
    winding = solid.winding(p)
    if winding is None:  # within the material or outside, if both sides of the sheet are there
        corners = sheet.corners(triangle_of(value["vertices"], sheet))
        normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]))
        front, back = (any(normal) and solid.beside(p, normal)) or (0, 1)
        if (front != 0) != (back != 0):
            raise Rejected("a point lies on a surface")
        winding = front
    return (True, winding != 0) if sheet is pair.a else (winding != 0, True)


def _crossing(certificate: Any, pair: Pair) -> None:
    """Two triangles of which each passes through the other's inside, one of them of a sheet."""
    named = member(certificate, "triangles")
    if not isinstance(named, list) or len(named) != 2:
        raise Rejected("a crossing names two triangles")
    s, t = (
        index(named[0], len(pair.a.world.triangles)),
        index(named[1], len(pair.b.world.triangles)),
    )
    corners = pair.a.corners(s), pair.b.corners(t)
    normals = [cross(sub(c[1], c[0]), sub(c[2], c[0])) for c in corners]
    shared = common(*corners)
    if len(shared) != 2 or not any(cross(*normals)):
        raise Rejected("the triangles do not cross")
    middle = tuple((p + q) / 2 for p, q in zip(*shared, strict=True))
    for c, normal in zip(corners, normals, strict=True):
        for k in range(3):
            inward = cross(normal, sub(c[(k + 1) % 3], c[k]))
            if dot(inward, middle) <= dot(inward, c[k]):
                raise Rejected("the triangles meet at an edge only")
    sides = [_sides(body, middle, n) for body, n in zip((pair.a, pair.b), normals, strict=True)]
    if (True, True) in sides or (False, False) not in sides:
        raise Rejected("no triangle of the crossing is of a sheet, or one lies within material")


def _sides(body: Exact, p: Point, normal: Vector) -> tuple[bool, bool]:
    """Whether there is material in front of a triangle of the body and behind it, next to p."""
    found = body.beside(p, normal)
    if found is None:
        raise Rejected("where the triangles cross another one lies")
    return (found[0] != 0, found[1] != 0) if body.world.solid else (False, False)


def _hulls_overlap(certificate: Any, pair: Pair) -> None:
    """For convex bodies; each reaches as far as the other along some axis, one of them farther."""
    if not pair.convex:
        raise Rejected("a polytope proves something about convex bodies only")
    inner_radius_exceeds(certificate, pair.a, pair.b, Fraction(0))
    leads = []
    for key, body, other in (("a_reaches", pair.a, pair.b), ("b_reaches", pair.b, pair.a)):
        n = axis(member(certificate, key))
        leads.append(Fraction(body.extent(n)) - Fraction(other.extent(n)))
    if min(leads) < 0 or max(leads) == 0:
        raise Rejected("the axes do not show that neither body lies inside the other")


def _same(certificate: Any, pair: Pair) -> None:
    """The same triangles; or solids with a common point, and no point in one of them alone."""
    a, b = pair.a.world, pair.b.world
    if a.solid != b.solid:
        raise Rejected("one is a solid, the other is not")
    if count_by_triangle(a.vertices, a.triangles, a.solid) == count_by_triangle(
        b.vertices, b.triangles, b.solid
    ):
        return
    if not a.solid:
        raise Rejected("the surfaces do not have the same triangles")
    _has_point(BOTH, certificate, "both", pair)
    _nowhere({A_ALONE, B_ALONE}, pair, meeting(pair.a, pair.b))
