"""Whether a curved shape holds a body, or lies within one: surely, surely not, or too close."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from satcheck import core
from satcheck.audit.curved.around import mesh_around
from satcheck.audit.curved.shape import CurvedShape, rows_of, support
from satcheck.audit.tolerances import CHAIN_ROUNDOFFS, UNIT_ROUNDOFF
from satcheck.scene.primitives import Capsule, Cone, Cylinder, Ellipsoid, Primitive, Sphere

if TYPE_CHECKING:
    from satcheck.audit.bodies.placed_body import PlacedBody

Floats = npt.NDArray[np.float64]


def holds(curved: CurvedShape, other: PlacedBody) -> bool | None:
    """Whether the body lies within the shape and does not reach its surface; None: too close."""
    inner = other.curved
    if inner is None:
        return _all_within(curved, np.asarray(other.mesh.vertices))
    outside = _world(inner, np.asarray(mesh_around(inner.primitive).vertices))
    if _all_within(curved, outside, inner.slack):
        return True
    return False if _all_within(curved, np.asarray(other.mesh.vertices)) is False else None


def _world(curved: CurvedShape, points: Floats) -> Floats:
    placed: Floats = _turned(points, curved.pose[3:]) + np.array(curved.centre)
    return placed


def _turned(points: Floats, quaternion: tuple[float, ...]) -> Floats:
    turned: Floats = points @ np.array(rows_of(quaternion)).T
    return turned


def _all_within(curved: CurvedShape, points: Floats, slack: float = 0.0) -> bool | None:
    """slack: how far the body that the points stand for may stick out of them, world units."""
    turned = _turned(points - np.array(curved.centre), _inverse(curved.pose[3:]))
    beyond = _beyond(curved.primitive, turned)
    size = float(np.abs(points).max()) + float(np.abs(curved.centre).max())
    pad = curved.slack + slack + CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * size
    if (beyond > pad).any():
        return False
    return True if (beyond < -pad).all() else None


def _beyond(primitive: Primitive, points: Floats) -> Floats:
    """Of points in the frame of the shape: > 0 outside, < 0 inside, and nowhere farther from 0 than
    the point is from the surface."""
    x, y, z = points.T
    across = np.hypot(x, y)
    found: Floats
    match primitive:
        case Sphere(radius):
            found = np.hypot(across, z) - radius
        case Capsule(radius, length):
            found = np.hypot(across, np.maximum(np.abs(z) - length / 2, 0.0)) - radius
        case Cylinder(radius, height):
            found = np.maximum(across - radius, np.abs(z) - height / 2)
        case Cone(radius, height):
            slant = (height * across + radius * (z - height / 2)) / math.hypot(radius, height)
            found = np.maximum(slant, -z - height / 2)
        case Ellipsoid((a, b, c)):
            found = (np.hypot(np.hypot(x / a, y / b), z / c) - 1.0) * min(a, b, c)
        case _:
            raise ValueError("a box is its mesh")
    return found


def is_within_hull(curved: CurvedShape, hull: core.Polytope) -> bool | None:
    """Whether the shape lies within a polytope and reaches no face; None: too close to tell.

    The normal of a face, a cross product, is off by some roundoffs of the product of the lengths of
    its edges: of a sliver that is more than of its own length, and the pad of its plane with it."""
    vertices = np.asarray(hull.vertices)
    a, b, c = (vertices[np.asarray(hull.triangles)[:, k]] for k in range(3))
    normals, edges = np.cross(b - a, c - a), (np.linalg.norm(p - a, axis=1) for p in (b, c))
    lengths = np.linalg.norm(normals, axis=1)
    if not lengths.all():
        return None
    slant = math.prod(edges) / lengths  # >= 1
    normals /= lengths[:, None]
    turned = _turned(normals, _inverse(curved.pose[3:]))
    reaches = np.array([support(curved.primitive, tuple(n)) for n in turned.tolist()])
    beyond = reaches - np.einsum("ij,ij->i", normals, a - np.array(curved.centre))
    size = float(np.abs(vertices - np.array(curved.centre)).max()) + float(reaches.max())
    pad = curved.slack + CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * size * slant
    if (beyond < -pad).all():
        return True
    return False if (beyond > pad).any() else None


def _inverse(quaternion: tuple[float, ...]) -> tuple[float, ...]:
    x, y, z, w = quaternion
    return -x, -y, -z, w
