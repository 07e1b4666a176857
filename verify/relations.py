"""What each kind of certificate proves about the relation of two bodies, checked exactly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from satcheck.verify.cells import Sides, sides_of
from satcheck.verify.evidence import axis, exceeds, gap_along, index, member, on_body, vector
from satcheck.verify.exact import Point, Rejected, cross, dot, sub
from satcheck.verify.polytope import inner_radius_exceeds
from satcheck.verify.sheets import no_crossing
from satcheck.verify.surfaces import close_pairs, common, meeting
from satcheck.verify.world import Exact, count_by_triangle

OVERLAPS = ("penetrating", "contains", "inside", "coincident")


@dataclass(frozen=True, slots=True)
class Pair:
    """Two bodies on one lattice. convex: both are exactly convex in their files, so that each is
    taken as the hull of its world vertices."""

    a: Exact
    b: Exact
    convex: bool


def prove(relation: str, certificate: Any, pair: Pair, beyond: Fraction, least: Fraction) -> bool:
    """Rejects a certificate that does not prove the exact relation.

    A separation has to be over `beyond` and at least `least`, world units. Returns whether it holds
    for the hulls, so that neither body can lie inside the other.
    """
    kind = member(certificate, "kind")
    proofs: dict[tuple[str, str], Callable[[Any, Pair], None]] = {
        ("touching", "axis"): _touching_by_axis,
        ("touching", "surfaces"): _touching_by_surfaces,
        ("penetrating", "overlap"): _overlap,
        ("penetrating", "crossing"): _crossing,
        ("penetrating", "polytope"): _hulls_overlap,
        ("penetrating", "surfaces"): _nested("penetrating"),
        ("contains", "surfaces"): _nested("contains"),
        ("inside", "surfaces"): _nested("inside"),
        ("coincident", "same"): _same,
    }
    if (relation, kind) == ("separated", "axis"):
        n = axis(member(certificate, "axis"))
        gap = gap_along(pair.a, pair.b, n)
        if not exceeds(gap, n, beyond) or gap * gap < least * least * dot(n, n):
            raise Rejected("the axis does not separate the bodies by as much as claimed")
        return True
    if (relation, kind) == ("separated", "surfaces"):
        _apart(pair, beyond, least)
        _nested("separated")(certificate, pair)
        return False
    if not isinstance(kind, str) or (relation, kind) not in proofs:
        raise Rejected(f"a certificate of this kind proves no relation {relation!r}")
    proofs[relation, kind](certificate, pair)
    return False


def prove_free(certificate: Any, pair: Pair) -> None:
    """No common interior: separated or touching."""
    kind = member(certificate, "kind")
    if kind == "axis":
        _weakly_separated(certificate, pair)
    elif kind == "surfaces":
        _no_overlap(pair)
    else:
        raise Rejected("a certificate of this kind proves no way out")


def common_point(certificate: Any, pair: Pair, *, of_hulls: bool) -> Point:
    """{"a": point, "b": point}, which must be the same."""
    p = on_body(member(certificate, "a"), pair.a, of_hull=of_hulls)
    if p != on_body(member(certificate, "b"), pair.b, of_hull=of_hulls):
        raise Rejected("the common point is not the same point on both bodies")
    return p


def _weakly_separated(certificate: Any, pair: Pair) -> None:
    if gap_along(pair.a, pair.b, axis(member(certificate, "axis"))) < 0:
        raise Rejected("the bodies overlap along the axis")


def _touching_by_axis(certificate: Any, pair: Pair) -> None:
    common_point(member(certificate, "contact"), pair, of_hulls=pair.convex)
    _weakly_separated(certificate, pair)


def _touching_by_surfaces(certificate: Any, pair: Pair) -> None:
    common_point(member(certificate, "contact"), pair, of_hulls=False)
    _no_overlap(pair)


def _apart(pair: Pair, beyond: Fraction, least: Fraction) -> None:
    scale = 1 << pair.a.k
    low, high = (beyond * scale) ** 2, (least * scale) ** 2
    for _, _, squared in close_pairs(pair.a, pair.b, max(beyond, least)):
        if squared <= low or squared < high:
            raise Rejected("the surfaces are closer than claimed, or meet")


def _no_overlap(pair: Pair) -> None:
    a, b = pair.a, pair.b
    contacts = meeting(a, b)
    if not contacts:
        inside = [_components_inside(a, b), _components_inside(b, a)]
        if any(any(found) for found in inside):
            raise Rejected("a part of one body lies inside the other")
        return
    if not (a.world.solid or b.world.solid):
        no_crossing(a, b, contacts)
        return
    swapped = [(t, s) for s, t in contacts]
    for x, y, pairs in ((a, b, contacts), (b, a, swapped)):
        if not y.world.solid:
            continue
        for sides in sides_of(x, y, pairs):
            if _overlap_beside(sides, x.world.solid):
                raise Rejected("the interiors overlap beside a point of the contact")


def _overlap_beside(sides: Sides, solid: bool) -> bool:
    if solid:
        return all(sides.front) or all(sides.back)
    return sides.front[1] and sides.back[1]  # a sheet is its points


def _components_inside(body: Exact, solid: Exact) -> list[bool]:
    """Of each part of one surface, whether it lies inside a solid that it does not meet."""
    if not solid.world.solid:
        return [False]
    found = []
    for vertex in body.world.components:
        x, y, z = body.points[vertex]
        winding = solid.winding((Fraction(x), Fraction(y), Fraction(z)))
        if winding is None:
            raise Rejected("the surfaces meet")
        found.append(winding != 0)
    return found


def _nested(relation: str) -> Callable[[Any, Pair], None]:
    def prove_nested(_: Any, pair: Pair) -> None:
        """Surfaces that do not meet: then each part of one lies inside the other, or outside."""
        if relation != "separated":  # there the gap has been proven
            _apart(pair, Fraction(0), Fraction(0))
        b_in_a = _components_inside(pair.b, pair.a)
        a_in_b = _components_inside(pair.a, pair.b)
        if all(b_in_a) and not any(a_in_b):
            found = "contains"
        elif all(a_in_b) and not any(b_in_a):
            found = "inside"
        else:
            found = "penetrating" if any(a_in_b) or any(b_in_a) else "separated"
        if found != relation:
            raise Rejected(f"the surfaces do not meet, and are {found}")
        for body, inside in ((pair.a, a_in_b), (pair.b, b_in_a)):
            if any(inside) and body.world.solid and not _has_material(body, inside):
                raise Rejected("what lies inside has no volume")

    return prove_nested


def _has_material(body: Exact, inside: list[bool]) -> bool:
    """Whether one of the parts that lie inside bounds material."""
    labels = body.world.labels(body.world.triangles)
    chosen = [v for v, yes in zip(body.world.components, inside, strict=True) if yes]
    for t, triangle in enumerate(body.world.triangles.tolist()):
        if int(labels[triangle[0]]) not in chosen:
            continue
        p, q, r = body.corners(t)
        normal = cross(sub(q, p), sub(r, p))
        middle = tuple(Fraction(2 * p[k] + 3 * q[k] + 4 * r[k], 9) for k in range(3))
        beside = body.beside(middle, normal) if any(normal) else None  # type: ignore[arg-type]
        if beside is not None and any(beside):
            return True
    return False


def _overlap(certificate: Any, pair: Pair) -> None:
    """A point inside both, one inside exactly one of them, and one on both surfaces."""
    common_point(member(certificate, "meet"), pair, of_hulls=False)
    if pair.a.world.solid and pair.b.world.solid:
        if _inside(member(certificate, "both"), pair) != [True, True]:
            raise Rejected("the point said to be inside both bodies is not")
        if sum(_inside(member(certificate, "one"), pair)) != 1:
            raise Rejected("the point said to be inside one body alone is not")
        return
    if not (pair.a.world.solid or pair.b.world.solid):
        raise Rejected("two bodies without an inside have no common interior")
    solid, sheet = (pair.a, pair.b) if pair.a.world.solid else (pair.b, pair.a)
    p = on_body(member(certificate, "both"), sheet, of_hull=False)
    if not solid.winding(p):
        raise Rejected("the point of the open surface is not inside the solid")


def _inside(point: Any, pair: Pair) -> list[bool]:
    x, y, z = (c * (1 << pair.a.k) for c in vector(point))
    windings = [body.winding((x, y, z)) for body in (pair.a, pair.b)]
    if None in windings:
        raise Rejected("a point lies on a surface")
    return [winding != 0 for winding in windings]


def _crossing(certificate: Any, pair: Pair) -> None:
    """Two triangles of which each passes through the other's inside."""
    if pair.a.world.solid or pair.b.world.solid:
        raise Rejected("crossing triangles prove nothing about the inside of a solid")
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


def _same(_: Any, pair: Pair) -> None:
    """The same triangles; or solids whose insides differ beside no point of either surface."""
    a, b = pair.a.world, pair.b.world
    if a.solid != b.solid:
        raise Rejected("one is a solid, the other is none")
    if count_by_triangle(a.vertices, a.triangles, a.solid) == count_by_triangle(
        b.vertices, b.triangles, b.solid
    ):
        return
    if not a.solid:
        raise Rejected("the surfaces do not have the same triangles")
    contacts = meeting(pair.a, pair.b)
    swapped = [(t, s) for s, t in contacts]
    for x, y, pairs in ((pair.a, pair.b, contacts), (pair.b, pair.a, swapped)):
        for sides in sides_of(x, y, pairs, quiet=False):
            if sides.front[0] != sides.front[1] or sides.back[0] != sides.back[1]:
                raise Rejected("the solids differ beside a point of their surfaces")
