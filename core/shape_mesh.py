"""Meshes of shapes: an inscribed one with its vertices on the surface, and an enclosing one.

Also a simpler body around a curved shape, in the frame of the shape.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterator
from functools import lru_cache

from satcheck._native.core import Mesh
from satcheck.core.conventions import Vector
from satcheck.core.shapes import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    Primitive,
    Sphere,
    half_sizes,
    support,
)

DEFAULT_SEGMENTS = 64
# Covers the rounding of face normals, supports and scaled corners.
_ROUNDED_UP = 1 + 2.0**-40
# Factors far beyond any rounding.
_LARGER, _SMALLER = 1 + 1e-9, 1 - 1e-9
# Sides of the prism around a cylinder.
_SIDES = 16


def mesh_of(shape: Primitive, segments: int = DEFAULT_SEGMENTS) -> Mesh:
    """The hull of points on the surface: closed, wound outward, and exactly convex.

    A box is exact, with 8 vertices and 12 triangles, and so is the block of a half space. A curved
    shape has `segments` points on each of its circles, including those on its axes, and half as
    many bands from pole to pole. segments: a multiple of 4, at least 8. Vertices lie on the surface
    up to the rounding of their coordinates to float64. Raises OverflowError for sizes beyond the
    range of exact arithmetic.
    """
    if segments < 8 or segments % 4:
        raise ValueError(f"segments should be a multiple of 4 from 8 on, not {segments}")
    points = array("d", (c for point in _surface_points(shape, segments) for c in point))
    return (
        Mesh.from_bytes(points.tobytes(), array("I", (0, 1, 2)).tobytes()).convex_hull().to_mesh()
    )


def sag_of(shape: Primitive, segments: int) -> float:
    """An upper bound of the distance of a point of the shape from `mesh_of(shape, segments)`.

    A facet of the unit ball, between two rings and two meridians, has at least the distance cos(pi
    / segments) squared from the centre. The other shapes are stretched or extruded balls and discs.
    """
    match shape:
        case Box() | HalfSpace():
            return 0.0
        case Ellipsoid(radii):
            radius = max(radii)
        case _:
            radius = shape.radius
    return radius * (math.cos(math.pi / segments) ** -2 - 1.0)


@lru_cache(maxsize=64)  # a robot in many poses has few shapes
def mesh_around(shape: Primitive, segments: int = DEFAULT_SEGMENTS) -> Mesh:
    """A mesh that contains the shape: the inner mesh, scaled by s about the origin, which lies
    inside. s is the least factor for which no face plane is nearer to the origin than the support
    of the shape along its normal."""
    import numpy as np

    inner = mesh_of(shape, segments)
    vertices = np.asarray(inner.vertices)
    a, b, c = (vertices[np.asarray(inner.triangles)[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    offsets = np.einsum("ij,ij->i", normals, a)
    reaches = np.array([support(shape, tuple(normal)) for normal in normals.tolist()])
    growth = float((reaches / offsets).max()) * _ROUNDED_UP
    return Mesh(vertices * growth, inner.triangles)


def meshes_beside(shape: Primitive, segments: int) -> tuple[Mesh, Mesh]:
    """A mesh around the shape and one within it. No rounding brings either to its surface."""
    import numpy as np

    outer, inner = mesh_around(shape, segments), mesh_of(shape, segments)
    return (
        Mesh(np.asarray(outer.vertices) * _LARGER, outer.triangles),
        Mesh(np.asarray(inner.vertices) * _SMALLER, inner.triangles),
    )


def _surface_points(shape: Primitive, segments: int) -> Iterator[Vector]:
    match shape:
        case Box(size):
            x, y, z = (c / 2 for c in size)
            return ((i * x, j * y, k * z) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1))
        case HalfSpace(r):
            return ((i * r, j * r, k * r) for i in (-1, 1) for j in (-1, 1) for k in (-1, 0))
        case Sphere(radius):
            return _ball((radius, radius, radius), segments)
        case Ellipsoid(radii):
            return _ball(radii, segments)
        case Capsule(radius, length):
            return _ball((radius, radius, radius), segments, length / 2)
        case Cylinder(radius, height):
            ring = [(radius * x, radius * y) for x, y in _circle(segments)]
            return ((x, y, z) for z in (-height / 2, height / 2) for x, y in ring)
        case Cone(radius, height):
            ring = [(radius * x, radius * y) for x, y in _circle(segments)]
            return iter([(0.0, 0.0, height / 2), *((x, y, -height / 2) for x, y in ring)])


def _ball(radii: Vector, segments: int, half_length: float = 0.0) -> Iterator[Vector]:
    """Rings around z from both poles to the equator. Each half is moved outward by
    `half_length`."""
    rx, ry, rz = radii
    circle = _circle(segments)
    for cosine, sine in circle[: segments // 4 + 1]:  # angle to the axis
        z = rz * cosine + half_length
        for x, y in circle if sine else circle[:1]:
            yield rx * sine * x, ry * sine * y, z
            yield rx * sine * x, ry * sine * y, -z


def _circle(segments: int) -> list[tuple[float, float]]:
    """Points of the unit circle, starting at (1, 0). A quarter turn maps the set exactly to
    itself."""
    steps = [math.tau * k / segments for k in range(1, segments // 4)]
    first = [(1.0, 0.0), *((math.cos(angle), math.sin(angle)) for angle in steps)]
    second = [(-y, x) for x, y in first]
    return [*first, *second, *((-x, -y) for x, y in first), *((-x, -y) for x, y in second)]


def shape_bounds(shape: Primitive) -> tuple[list[Vector], float]:
    """(corners, margin): the shape lies in the hull of the corners, grown by the margin."""
    a, b, c = half_sizes(shape)
    match shape:
        case Sphere():
            return [(0.0, 0.0, 0.0)], a * _LARGER
        case Capsule():
            return [(0.0, 0.0, -c * _LARGER), (0.0, 0.0, c * _LARGER)], a * _LARGER
        case Cylinder() | Cone():
            return _prism(a, c), 0.0
        case _:
            x, y, z = a * _LARGER, b * _LARGER, c * _LARGER
            return [(u, v, w) for u in (-x, x) for v in (-y, y) for w in (-z, z)], 0.0


def _prism(radius: float, half: float) -> list[Vector]:
    """The corners of a prism around a cylinder about z."""
    wide = radius / math.cos(math.pi / _SIDES) * _LARGER
    angles = [2 * math.pi * k / _SIDES for k in range(_SIDES)]
    return [
        (wide * math.cos(angle), wide * math.sin(angle), end)
        for angle in angles
        for end in (-half * _LARGER, half * _LARGER)
    ]
