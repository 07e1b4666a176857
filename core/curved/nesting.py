"""Decides whether one body contains another. An inner body must not reach the surface."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
import numpy.typing as npt
from msgspec import Struct

from satcheck.core import Polytope
from satcheck.core.conventions import Bounds
from satcheck.core.curved.exact.curved_body import CurvedBody
from satcheck.core.curved.exact.lattice import IntVector, negated, sign_of_difference
from satcheck.core.curved.exact.pair import on_lattice
from satcheck.core.curved.exact.polytope_body import PolytopeBody
from satcheck.core.curved.exact.proof import ExactBody
from satcheck.core.curved.placed import Body, CurvedShape, Quaternion, rows_of
from satcheck.core.rounding import CHAIN_ROUNDOFFS, UNIT_ROUNDOFF
from satcheck.core.shape_mesh import mesh_around
from satcheck.core.shapes import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Primitive,
    Sphere,
    half_sizes,
    support,
)

Floats = npt.NDArray[np.float64]


class Nesting(Struct, frozen=True):
    """relation: of A to B, which overlap. known: False: the relation may be another one of these.
    exact: exact arithmetic was used."""

    relation: Literal["contains", "inside", "penetrating"]
    known: bool
    exact: bool


def nesting(a: Body, b: Body) -> Nesting:
    """The nesting of two overlapping convex bodies, of which at least one is curved."""
    if (translated := _between_translates(a, b)) is not None:
        return translated
    forth, back = _holds(a, b), _holds(b, a)
    exact = forth is None or back is None
    if exact:
        exact_forth, exact_back = exact_nesting(a, b)
        forth = exact_forth if forth is None else forth
        back = exact_back if back is None else back
    if forth or back:
        return Nesting("contains" if forth else "inside", True, exact)
    return Nesting("penetrating", forth is False and back is False, exact)


def _between_translates(a: Body, b: Body) -> Nesting | None:
    """Return the nesting of two shapes of which a translation takes one to the other, exactly:
    neither contains the other, but they may coincide. None for other bodies."""
    if a.curved is None or b.curved is None:
        return None
    of_a, of_b = a.curved.image, b.curved.image
    if of_a.primitive != of_b.primitive or of_a.columns != of_b.columns:
        return None
    coincide = of_a.origin == of_b.origin
    return Nesting("penetrating", not coincide, coincide)


def _holds(outer: Body, inner: Body) -> bool | None:
    """Decides in float64 with error bounds; None: too close."""
    if not box_holds(outer.bounds, inner.mesh.bounds):
        return False
    if outer.curved is not None:
        return shape_holds(outer.curved, inner)
    assert inner.curved is not None
    return is_within_hull(inner.curved, outer.hull())


def box_holds(outer: Bounds, inner: Bounds) -> bool:
    """Whether the closed outer box contains the inner one. Containment of bodies requires this."""
    return all(
        outer[0][axis] <= inner[0][axis] and inner[1][axis] <= outer[1][axis] for axis in range(3)
    )


def shape_holds(curved: CurvedShape, other: Body) -> bool | None:
    """Whether the body lies within the shape and does not reach its surface; None: too close to
    tell."""
    inner = other.curved
    if inner is None:
        return _all_within(curved, np.asarray(other.mesh.vertices))
    ball = _radius_around(inner.primitive) * (1 + CHAIN_ROUNDOFFS * UNIT_ROUNDOFF)
    if _all_within(curved, np.array([inner.centre]), ball + inner.slack):
        return True
    outside = _turned(np.asarray(mesh_around(inner.primitive).vertices), inner.turn)
    if _all_within(curved, outside + np.array(inner.centre), inner.slack):
        return True
    return False if _all_within(curved, np.asarray(other.mesh.vertices)) is False else None


def _radius_around(primitive: Primitive) -> float:
    """Return the radius of a ball about the centre that the shape lies in."""
    across, along, up = half_sizes(primitive)
    match primitive:
        case Ellipsoid():
            return max(across, along, up)
        case Sphere() | Capsule():
            return up + across
    return math.hypot(across, up)


def _turned(points: Floats, quaternion: Quaternion) -> Floats:
    turned: Floats = points @ np.array(rows_of(quaternion)).T
    return turned


def _inverse(quaternion: Quaternion) -> Quaternion:
    x, y, z, w = quaternion
    return -x, -y, -z, w


def _all_within(curved: CurvedShape, points: Floats, slack: float = 0.0) -> bool | None:
    """slack: how far a body may reach beyond these points, world units."""
    turned = _turned(points - np.array(curved.centre), _inverse(curved.turn))
    beyond = _beyond(curved.primitive, turned)
    size = float(np.abs(points).max()) + float(np.abs(curved.centre).max())
    pad = curved.slack + slack + CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * size
    if (beyond > pad).any():
        return False
    return True if (beyond < -pad).all() else None


def _beyond(primitive: Primitive, points: Floats) -> Floats:
    """A value for each point in the frame of the shape: > 0 outside, < 0 inside. Its absolute value
    is at most the distance from the surface."""
    x, y, z = points.T
    across = np.hypot(x, y)
    beyond: Floats
    match primitive:
        case Sphere(radius):
            beyond = np.hypot(across, z) - radius
        case Capsule(radius, length):
            beyond = np.hypot(across, np.maximum(np.abs(z) - length / 2, 0.0)) - radius
        case Cylinder(radius, height):
            beyond = np.maximum(across - radius, np.abs(z) - height / 2)
        case Cone(radius, height):
            slant = (height * across + radius * (z - height / 2)) / math.hypot(radius, height)
            beyond = np.maximum(slant, -z - height / 2)
        case Ellipsoid((a, b, c)):
            beyond = (np.hypot(np.hypot(x / a, y / b), z / c) - 1.0) * min(a, b, c)
        case Box():
            raise ValueError("a box is its mesh")
    return beyond


def is_within_hull(curved: CurvedShape, hull: Polytope) -> bool | None:
    """Whether the shape lies within a polytope and reaches no face; None: too close to tell.

    The normal of a face is a cross product. Its error is some roundoffs of the product of two edge
    lengths. For a sliver that product is much larger than the normal, so the pad of its plane grows
    by the same factor."""
    vertices = np.asarray(hull.vertices)
    a, b, c = (vertices[np.asarray(hull.triangles)[:, k]] for k in range(3))
    normals, edges = np.cross(b - a, c - a), (np.linalg.norm(p - a, axis=1) for p in (b, c))
    lengths = np.linalg.norm(normals, axis=1)
    if not lengths.all():
        return None
    slant = math.prod(edges) / lengths  # >= 1
    normals /= lengths[:, None]
    turned = _turned(normals, _inverse(curved.turn))
    reaches = np.array([support(curved.primitive, tuple(n)) for n in turned.tolist()])
    beyond = reaches - np.einsum("ij,ij->i", normals, a - np.array(curved.centre))
    size = float(np.abs(vertices - np.array(curved.centre)).max()) + float(reaches.max())
    pad = curved.slack + CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * size * slant
    if (beyond < -pad).all():
        return True
    return False if (beyond > pad).any() else None


def exact_nesting(a: Body, b: Body) -> tuple[bool | None, bool | None]:
    """(whether A contains B, whether B contains A); None: unknown, for two shapes that may
    coincide."""
    first, second, _ = on_lattice(a, b)
    if isinstance(first, CurvedBody) and isinstance(second, CurvedBody):
        return _of_shapes(first, second)
    return _holds_exactly(first, second), _holds_exactly(second, first)


def _holds_exactly(outer: ExactBody, inner: ExactBody) -> bool:
    if isinstance(outer, PolytopeBody):
        return all(
            sign_of_difference(inner.reach(n), outer.reach(n)) < 0 for n in outer.face_normals()
        )
    assert isinstance(inner, PolytopeBody)
    return all(outer.side(p) > 0 for p in inner.corners())


def _of_shapes(a: CurvedBody, b: CurvedBody) -> tuple[bool | None, bool | None]:
    """A shape that reaches as far as the other along some axis does not lie within it. If both
    reach equally far along all axes, they may coincide, and both answers are None."""
    signs = {sign_of_difference(a.reach(n), b.reach(n)) for n in _axes(a, b)}
    if signs <= {0}:
        return None, None
    return (False if signs - {1} else None), (False if signs - {-1} else None)


def _axes(a: CurvedBody, b: CurvedBody) -> list[IntVector]:
    rows = [n for body in (a, b) for n in body.inverse]
    return rows + [negated(n) for n in rows]
