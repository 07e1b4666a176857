"""The exact check of each kind of certificate of a relation."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from msgspec import UNSET, UnsetType

from satcheck.report.certificate import (
    AxisProof,
    CrossingProof,
    Ends,
    ExactVector,
    OnBody,
    OverlapProof,
    PolytopeProof,
    Proof,
    SameProof,
    SurfacesProof,
)
from satcheck.report.certificate import Point as ProofPoint
from satcheck.report.values import Relation
from satcheck.verify.bodies import Placed
from satcheck.verify.boundary import boundary_point, contacts_if_apart
from satcheck.verify.cells import Sides, sheets_among, sides_of
from satcheck.verify.evidence import (
    axis,
    exceeds,
    gap_along,
    given,
    index,
    on_body,
    triangle_of,
    vector,
)
from satcheck.verify.exact import IntVector, Point, Rejected, cross, dot, sub
from satcheck.verify.polytope import inner_radius_exceeds
from satcheck.verify.sheets import no_crossing
from satcheck.verify.surfaces import common, meeting
from satcheck.verify.world import Exact, World, count_by_triangle

# How a point lies: (in A, in B).
BOTH, A_ALONE, B_ALONE = (True, True), (True, False), (False, True)
Way = tuple[bool, bool]


@dataclass(frozen=True, slots=True)
class Pair:
    """Two bodies on one lattice. convex: both are exactly convex in their files, so each is the
    hull of its world vertices."""

    a: Exact
    b: Exact
    convex: bool


def pair_of(a: Placed, b: Placed, world_a: World, world_b: World) -> Pair:
    k = max(world_a.lattice, world_b.lattice)
    return Pair(Exact(world_a, k), Exact(world_b, k), a.convex and b.convex)


def prove(
    relation: Relation | None, proof: Proof, pair: Pair, beyond: Fraction, least: Fraction
) -> bool:
    """Rejects a proof that does not prove the exact relation.

    A gap must be greater than `beyond` and at least `least`, world units. Returns whether the hulls
    have no common interior; then neither body can lie inside the other.
    """
    match relation, proof:
        case "separated", AxisProof() as separation:
            _separated_by_axis(separation, pair, beyond, least)
            return True
        case "separated", SurfacesProof():
            _nowhere({BOTH}, pair, contacts_if_apart(pair.a, pair.b, beyond, least))
        case "touching", AxisProof() as separation:
            common_point(given(separation.contact, "contact"), pair, of_hulls=pair.convex)
            _weakly_separated(separation, pair)
            return True
        case "touching", SurfacesProof() as surfaces:
            common_point(given(surfaces.contact, "contact"), pair, of_hulls=False)
            _no_overlap(pair)
        case "penetrating", OverlapProof() as overlap:
            _overlap(overlap, pair)
        case "penetrating", CrossingProof() as crossing:
            _crossing(crossing, pair)
        case "penetrating", PolytopeProof() as polytope:
            _hulls_overlap(polytope, pair)
        case "contains", SurfacesProof() as surfaces:
            _holds(pair.a, surfaces, B_ALONE, pair)
        case "inside", SurfacesProof() as surfaces:
            _holds(pair.b, surfaces, A_ALONE, pair)
        case "coincident", SameProof() as same:
            _same(same, pair)
        case _:
            raise Rejected(f"a certificate of this kind proves no relation {relation!r}")
    return False


def prove_free(proof: Proof, pair: Pair) -> None:
    """No common interior: separated or touching."""
    if isinstance(proof, AxisProof):
        _weakly_separated(proof, pair)
    elif isinstance(proof, SurfacesProof):
        _no_overlap(pair)
    else:
        raise Rejected("a certificate of this kind proves no way out")


def common_point(ends: Ends, pair: Pair, *, of_hulls: bool) -> None:
    """One point of both boundaries or both hulls."""
    p = boundary_point(ends.a, pair.a, of_hull=of_hulls)
    if p != boundary_point(ends.b, pair.b, of_hull=of_hulls):
        raise Rejected("the common point is not the same point on both bodies")


def check_within(pair: Pair) -> None:
    """Rejects bodies of which a point of A lies outside of B, which is solid."""
    _nowhere({A_ALONE}, pair, meeting(pair.a, pair.b))


def _separated_by_axis(proof: AxisProof, pair: Pair, beyond: Fraction, least: Fraction) -> None:
    n = axis(proof.axis)
    gap = gap_along(pair.a, pair.b, n)
    if not exceeds(gap, n, beyond) or gap * gap < least * least * dot(n, n):
        raise Rejected("the axis does not separate the bodies by as much as claimed")


def _weakly_separated(proof: AxisProof, pair: Pair) -> None:
    if gap_along(pair.a, pair.b, axis(proof.axis)) < 0:
        raise Rejected("the bodies overlap along the axis")


def _no_overlap(pair: Pair) -> None:
    contacts = meeting(pair.a, pair.b)
    _nowhere({BOTH}, pair, contacts)
    of_a, of_b = (sheets_among(body, contacts, k) for k, body in enumerate((pair.a, pair.b)))
    no_crossing(pair.a, pair.b, [(s, t) for s, t in contacts if s in of_a and t in of_b])


def _nowhere(ways: set[Way], pair: Pair, contacts: list[tuple[int, int]]) -> None:
    """Rejects bodies with a point that lies in one of these ways. contacts: all pairs that meet.

    A region of one surface that the other does not meet lies inside or outside of the other body as
    a whole. It is checked only if one of the ways includes that. A sheet has no inside.
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


def _holds(outer: Exact, proof: SurfacesProof, alone: Way, pair: Pair) -> None:
    """Checks that one body contains the other. alone: a point of the outer body outside of the
    inner one."""
    if not outer.world.solid:
        raise Rejected("what is not solid contains nothing")
    _has_point(BOTH, proof.both, "both", pair)
    _nowhere({alone}, pair, contacts_if_apart(pair.a, pair.b, Fraction(0), Fraction(0)))


def _overlap(proof: OverlapProof, pair: Pair) -> None:
    """Checks an overlap: a point inside both, and a point inside each one alone; or a point inside
    one alone, and a common point of the boundaries. A part of a solid always lies outside of a
    sheet."""
    if not (pair.a.world.solid or pair.b.world.solid):
        raise Rejected("two bodies without an inside have no common interior")
    _has_point(BOTH, proof.both, "both", pair)
    alone = 0
    for name, point, way, other in (
        ("a_alone", proof.a_alone, A_ALONE, pair.b),
        ("b_alone", proof.b_alone, B_ALONE, pair.a),
    ):
        if other.world.solid and point is not UNSET:
            _has_point(way, point, name, pair)
        alone += not other.world.solid or point is not UNSET
    if alone == 0:
        raise Rejected("no point shows that one is not the other")
    if alone == 1:
        common_point(given(proof.meet, "meet"), pair, of_hulls=False)


def _has_point(way: Way, point: ProofPoint | UnsetType, name: str, pair: Pair) -> None:
    """Of two solids: three numbers. Of a solid and a sheet: a point of the sheet."""
    if isinstance(point, UnsetType):
        raise Rejected(f"the certificate has no {name!r}")
    sheet = next((body for body in (pair.a, pair.b) if not body.world.solid), None)
    if isinstance(point, OnBody):
        if sheet is None:
            raise Rejected("a point inside two solids is three numbers")
        inside = _solid_at(point, sheet, pair)
    else:
        if sheet is not None:
            raise Rejected("a point of a solid and a sheet is a point of the sheet")
        inside = _solids_at(point, pair)
    if inside != way:
        raise Rejected(f"the point given as {name!r} lies otherwise")


def _solids_at(place: ExactVector, pair: Pair) -> Way:
    x, y, z = (c * (1 << pair.a.k) for c in vector(place))
    windings = [body.winding((x, y, z)) for body in (pair.a, pair.b)]
    if None in windings:
        raise Rejected("a point lies on a surface")
    return windings[0] != 0, windings[1] != 0


def _solid_at(place: OnBody, sheet: Exact, pair: Pair) -> Way:
    solid = pair.b if sheet is pair.a else pair.a
    p = on_body(place, sheet, of_hull=False)
    winding = solid.winding(p)
    if winding is None:  # within the material or outside, if both sides of the sheet are there
        corners = sheet.corners(triangle_of(given(place.vertices, "vertices"), sheet))
        normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]))
        front, back = (any(normal) and solid.beside(p, normal)) or (0, 1)
        if (front != 0) != (back != 0):
            raise Rejected("a point lies on a surface")
        winding = front
    return (True, winding != 0) if sheet is pair.a else (winding != 0, True)


def _crossing(proof: CrossingProof, pair: Pair) -> None:
    """Two triangles that pass through each other's interior, one of them of a sheet."""
    s = index(proof.triangles[0], len(pair.a.world.triangles))
    t = index(proof.triangles[1], len(pair.b.world.triangles))
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


def _sides(body: Exact, p: Point, normal: IntVector) -> tuple[bool, bool]:
    """Whether there is material in front of a triangle of the body and behind it, next to p."""
    windings = body.beside(p, normal)
    if windings is None:
        raise Rejected("where the triangles cross another one lies")
    return (windings[0] != 0, windings[1] != 0) if body.world.solid else (False, False)


def _hulls_overlap(proof: PolytopeProof, pair: Pair) -> None:
    """An overlap of convex bodies: each reaches at least as far as the other along some axis, and
    one farther."""
    if not pair.convex:
        raise Rejected("a polytope proves something about convex bodies only")
    inner_radius_exceeds(proof, pair.a, pair.b, Fraction(0))
    leads = []
    for reach, body, other in (
        (proof.a_reaches, pair.a, pair.b),
        (proof.b_reaches, pair.b, pair.a),
    ):
        n = axis(reach)
        leads.append(Fraction(body.extent(n)) - Fraction(other.extent(n)))
    if min(leads) < 0 or max(leads) == 0:
        raise Rejected("the axes do not show that neither body lies inside the other")


def _same(proof: SameProof, pair: Pair) -> None:
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
    _has_point(BOTH, proof.both, "both", pair)
    _nowhere({A_ALONE, B_ALONE}, pair, meeting(pair.a, pair.b))
