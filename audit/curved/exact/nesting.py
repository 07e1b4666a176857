"""Whether a body lies within another one and reaches its border nowhere."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.curved.exact.curved_body import CurvedBody
from satcheck.audit.curved.exact.lattice import Vector, negated
from satcheck.audit.curved.exact.pair import Lattice, side_of
from satcheck.audit.curved.exact.polytope_body import PolytopeBody
from satcheck.audit.curved.exact.reach import sign_of_difference
from satcheck.audit.curved.signed import ORIGIN

if TYPE_CHECKING:
    from satcheck.audit.bodies.placed_body import PlacedBody

ExactPair = tuple[CurvedBody | PolytopeBody, CurvedBody | PolytopeBody]


def nesting(a: PlacedBody, b: PlacedBody) -> tuple[bool | None, bool | None]:
    """Whether A holds B, whether B holds A; None: not known. Both are convex, one is curved."""
    sides = side_of(a, ORIGIN), side_of(b, ORIGIN)
    lattice = Lattice(sides)
    first, second = (lattice.body(side) for side in sides)
    if isinstance(first, CurvedBody) and isinstance(second, CurvedBody):
        return _of_shapes(first, second)
    return _holds(first, second), _holds(second, first)


def _holds(outer: CurvedBody | PolytopeBody, inner: CurvedBody | PolytopeBody) -> bool:
    if isinstance(outer, PolytopeBody):
        return all(
            sign_of_difference(inner.reach(n), outer.reach(n)) < 0 for n in outer.face_normals()
        )
    assert isinstance(inner, PolytopeBody)
    return all(outer.side(p) > 0 for p in inner.corners())


def _of_shapes(a: CurvedBody, b: CurvedBody) -> tuple[bool | None, bool | None]:
    """One that reaches as far as the other somewhere does not lie within it. If that is all that is
    known both ways, they may be the same."""
    signs = {sign_of_difference(a.reach(n), b.reach(n)) for n in _axes(a, b)}
    if signs <= {0}:
        return None, None
    return (False if signs - {1} else None), (False if signs - {-1} else None)


def _axes(a: CurvedBody, b: CurvedBody) -> list[Vector]:
    found = [n for body in (a, b) for n in body.inverse]
    return found + [negated(n) for n in found]
