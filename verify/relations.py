"""The exact check of what proves the relation of two bodies.

Of meshes that are not convex the checker decides all close pairs of triangles again: beside each
piece of the surfaces lie points of both bodies, of one of them alone, or of none.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from msgspec import UnsetType

from satcheck.report.certificate import (
    AxisProof,
    NestedProof,
    PointProof,
    PolytopeProof,
    Proof,
    SurfacesProof,
)
from satcheck.report.values import Relation
from satcheck.verify.bodies import Placed, box_gaps
from satcheck.verify.cells import (
    Contacts,
    chosen,
    contacts_if_apart,
    meet,
    no_crossing,
    sheets_among,
    sides_of,
)
from satcheck.verify.curved import Curved
from satcheck.verify.depth import inner_radius_exceeds
from satcheck.verify.exact import (
    Rejected,
    cross,
    half_spaces,
    height,
    homogeneous,
    normal_of,
    point,
    sign_of,
    sub,
)
from satcheck.verify.pairs import AnyPair, Pair, any_pair_of, axis, given, index, pair_of
from satcheck.verify.surfaces import comes_within, common, meeting
from satcheck.verify.world import Exact, count_by_triangle

# How a point lies: (in A, in B).
BOTH, A_ALONE, B_ALONE = (True, True), (True, False), (False, True)
Way = tuple[bool, ...]


def prove(
    relation: Relation | None, proof: Proof, pair: AnyPair, beyond: Fraction, least: Fraction
) -> bool:
    """Rejects a proof that does not prove the exact relation.

    A gap must be greater than `beyond` and at least `least`. Returns whether the hulls have no
    common interior; then neither body can lie inside the other.
    """
    match relation, proof:
        case "separated", AxisProof():
            n = axis(proof.axis)
            if pair.gap(n, beyond) <= 0 or pair.gap(n, least) < 0:
                raise Rejected("the axis does not separate the bodies by as much as claimed")
            return True
        case "touching", AxisProof():
            prove_free(proof, pair)
            p, q = pair.points(given(proof.contact, "contact"))
            if p != q:
                raise Rejected("the common point is not the same point on both bodies")
            return True
        case "penetrating", PointProof():
            # The point is in the interior of one body and in the other, closed body. The other has
            # an interior, so points nearby lie inside both.
            a, b = pair.points(proof.both)
            inner = (isinstance(x, Curved) and x.side(a) > 0 for x in (pair.a, pair.b))
            if a != b or not any(inner):
                raise Rejected("the point does not lie inside both")
            _neither_holds(proof, pair)
        case "penetrating", PolytopeProof():
            if not (isinstance(pair, Pair) and pair.convex):
                raise Rejected("a polytope proves something about convex meshes only")
            inner_radius_exceeds(proof, pair.a, pair.b, Fraction(0))
            _neither_holds(proof, pair)
        case "contains", NestedProof():
            _nested(pair.a, pair.b)
        case "inside", NestedProof():
            _nested(pair.b, pair.a)
        case _, SurfacesProof() if isinstance(pair, Pair):
            _prove_by_surfaces(relation, proof, pair, beyond, least)
        case _:
            raise Rejected(f"a certificate of this kind proves no relation {relation!r}")
    return False


def prove_free(proof: Proof, pair: AnyPair) -> None:
    """No common interior: separated or touching."""
    if isinstance(proof, AxisProof):
        if pair.gap(axis(proof.axis)) < 0:
            raise Rejected("the bodies overlap along the axis")
    elif isinstance(proof, SurfacesProof) and isinstance(pair, Pair):
        _no_overlap(pair, meeting(pair.a, pair.b))
    else:
        raise Rejected("a certificate of this kind proves no way out")


def _neither_holds(proof: PointProof | PolytopeProof, pair: AnyPair) -> None:
    """Each of two convex bodies reaches at least as far as the other along some axis, and one
    farther."""
    reaches = axis(proof.a_reaches), axis(proof.b_reaches)
    if isinstance(pair, Pair) and pair.across is not None and any(n[pair.across] for n in reaches):
        raise Rejected("an axis leaves the plane")
    leads = pair.lead(reaches[0]), -pair.lead(reaches[1])
    if min(leads) < 0 or max(leads) == 0:
        raise Rejected("the axes do not show that neither body lies inside the other")


def _nested(outer: Curved | Exact, inner: Curved | Exact) -> None:
    """Inner lies inside of outer, and does not reach its border. One of them is curved."""
    if isinstance(outer, Curved):
        if isinstance(inner, Curved):
            raise Rejected("of two curved shapes it is not certified that one holds the other")
        used = (inner.points[k] for k in inner.world.used[0].tolist())
        if not all(outer.side(point(Fraction(c, inner.scale) for c in p)) > 0 for p in used):
            raise Rejected("a vertex does not lie inside the curved shape")
        return
    if isinstance(inner, Exact):
        raise Rejected("of two meshes the surfaces show that one holds the other")
    for n, limit in outer.planes():
        most = inner.reach(point(n))
        if sign_of(Fraction(limit, outer.scale) - most.q, [most.p]) <= 0:
            raise Rejected("the curved shape is not behind each face")
    if not outer.winding(outer.at(inner.image.origin)):
        raise Rejected("the curved shape lies outside of the mesh")


def _prove_by_surfaces(
    relation: Relation | None, proof: SurfacesProof, pair: Pair, beyond: Fraction, least: Fraction
) -> None:
    match relation:
        case "separated":
            _nowhere({BOTH}, pair, contacts_if_apart(pair.a, pair.b, beyond, least))
        case "touching":
            contacts = meeting(pair.a, pair.b)
            _no_overlap(pair, contacts)
            if not meet(pair.a, pair.b, contacts):
                raise Rejected("the boundaries do not meet")
        case "penetrating":
            _overlap(proof, pair)
        case "contains":
            _holds(pair.a, B_ALONE, pair)
        case "inside":
            _holds(pair.b, A_ALONE, pair)
        case "coincident":
            _same(pair)
        case _:
            raise Rejected(f"surfaces prove no relation {relation!r}")


def check_apart(a: Placed, b: Placed, tolerance: float) -> None:
    """Rejects bodies that are not farther apart than the tolerance. If one is a ball, the tolerance
    may be negative: then the bodies may overlap by less than that."""
    least = Fraction(tolerance)
    if max(box_gaps(a, b)) > least:
        return
    if a.world is not None and b.world is not None:
        pair = pair_of(a, b, a.world, b.world)
        prove("separated", SurfacesProof(), pair, least, Fraction(0))
        return
    round_, other = (b, a) if b.world is None else (a, b)
    centre, radius = round_.ball
    if other.world is None:
        along = sub(point(centre), point(other.ball[0]))
        is_apart = any_pair_of(other, round_).gap(along, least) > 0
    else:
        mesh = Exact(other.world, other.world.lattice)
        middle = mesh.at(centre)
        reach = max(Fraction(radius) + least, Fraction(0))
        is_apart = not comes_within(mesh, middle, reach, open_=False)
        if is_apart and mesh.world.solid and mesh.winding(middle) != 0:
            raise Rejected("a body that should be apart lies in another")
    if not is_apart:
        raise Rejected("bodies that should be apart are within the tolerance")


def check_within(pair: Pair) -> None:
    """Rejects bodies of which a point of A lies outside of B, which is solid."""
    _nowhere({A_ALONE}, pair, meeting(pair.a, pair.b))


def _no_overlap(pair: Pair, contacts: Contacts) -> None:
    _nowhere({BOTH}, pair, contacts)
    of_a, of_b = (sheets_among(body, contacts, k) for k, body in enumerate((pair.a, pair.b)))
    no_crossing(pair.a, pair.b, [(s, t) for s, t in contacts if s in of_a and t in of_b])


def _nowhere(ways: set[Way], pair: Pair, contacts: Contacts) -> None:
    """Rejects bodies with a point that lies in one of these ways. contacts: all pairs that meet."""
    if any(ways & beside for beside in _ways(ways, pair, contacts)):
        raise Rejected("beside a point of the surfaces the bodies lie otherwise")


def _ways(
    ways: set[Way], pair: Pair, contacts: Contacts, only: tuple[int, int] | None = None
) -> Iterator[set[Way]]:
    """The ways beside each piece of either surface. contacts: all pairs that meet. only: one
    triangle of either surface, instead of all; contacts are then those of these two.

    A region of one surface that the other does not meet lies inside or outside of the other body as
    a whole. It is looked at only if one of the ways includes that. A sheet has no inside.
    """
    a, b = pair.a, pair.b
    for turn, x, y, pairs in ((1, a, b, contacts), (-1, b, a, [(t, s) for s, t in contacts])):
        if not y.world.solid:
            continue
        theirs = {way[::turn][1] for way in ways}
        triangles = [only[::turn][0]] if only else chosen(x, y, pairs, theirs.__contains__)
        for sides in sides_of(triangles, x, y, pairs):
            beside = {sides.front, sides.back} if x.world.solid else set()
            is_sheet = not any(in_x for in_x, _ in beside)
            # A sheet within the boundary of a solid is neither inside nor outside of it.
            if is_sheet and sides.front[1] == sides.back[1]:
                beside.add((True, sides.front[1]))
            yield {way[::turn] for way in beside}


def _holds(outer: Exact, alone: Way, pair: Pair) -> None:
    """Checks that one body contains the other. alone: a point of the inner body outside of the
    outer one."""
    if not outer.world.solid:
        raise Rejected("what is not solid contains nothing")
    contacts = contacts_if_apart(pair.a, pair.b, Fraction(0), Fraction(0))
    _nowhere({alone}, pair, contacts)
    _somewhere_in_both(pair, contacts)


def _somewhere_in_both(pair: Pair, contacts: Contacts) -> None:
    if not any(BOTH in beside for beside in _ways({BOTH}, pair, contacts)):
        raise Rejected("the bodies have no common interior")


def _overlap(proof: SurfacesProof, pair: Pair) -> None:
    """Checks an overlap, first beside the triangles that the proof names."""
    a, b = pair.a, pair.b
    if not isinstance(proof.triangles, UnsetType):
        s, t = proof.triangles
        named = index(s, len(a.world.triangles)), index(t, len(b.world.triangles))
        near = {(s, u) for _, u in meeting(a.part([s]), b)}
        near |= {(u, t) for u, _ in meeting(a, b.part([t]))}
        if _cross(named, pair) or _shows_overlap(pair, sorted(near), named):
            return
    contacts = meeting(a, b)
    if not (_shows_overlap(pair, contacts) or any(_cross(both, pair) for both in contacts)):
        raise Rejected("the surfaces show no overlap in which neither body holds the other")


def _shows_overlap(pair: Pair, contacts: Contacts, only: tuple[int, int] | None = None) -> bool:
    """Whether points lie in both bodies, and in each one alone; or in one alone, and the boundaries
    meet. A part of a solid always lies outside of a sheet."""
    found: set[Way] = {
        way for way, other in ((A_ALONE, pair.b), (B_ALONE, pair.a)) if not other.world.solid
    }
    if len(found) == 2:
        return False  # two bodies without an inside have no common interior
    boundaries_meet = None
    for beside in _ways({BOTH, A_ALONE, B_ALONE}, pair, contacts, only):
        found |= beside
        if BOTH not in found or not found & {A_ALONE, B_ALONE}:
            continue
        if boundaries_meet is None:
            boundaries_meet = meet(pair.a, pair.b, contacts, pair.across)
        if boundaries_meet or found >= {A_ALONE, B_ALONE}:
            return True
    return False


def _cross(named: tuple[int, int], pair: Pair) -> bool:
    """Whether two triangles pass through each other's interior, one of them of a sheet."""
    corners = pair.a.corners(named[0]), pair.b.corners(named[1])
    normals = [normal_of(c) for c in corners]
    shared = common(*corners)
    if len(shared) != 2 or not any(cross(*normals)):
        return False
    middle = point((p + q) / 2 for p, q in zip(*shared, strict=True))
    at = homogeneous(middle)
    if any(height(edge, at) >= 0 for c in corners for edge in half_spaces(c)[2:]):
        return False  # they meet at an edge
    sides = [body.beside(middle, n) for body, n in zip((pair.a, pair.b), normals, strict=True)]
    return (False, False) in sides and (True, True) not in sides and None not in sides


def _same(pair: Pair) -> None:
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
    contacts = meeting(pair.a, pair.b)
    _nowhere({A_ALONE, B_ALONE}, pair, contacts)
    _somewhere_in_both(pair, contacts)
