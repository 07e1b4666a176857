"""A curved shape in the world: a shape of the core, its pose, and the rounding error of placing
it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol

from msgspec import Struct
from msgspec.structs import replace

from satcheck._native import core as native
from satcheck.core.conventions import Bounds, Vector
from satcheck.core.rounding import CHAIN_ROUNDOFFS, ORTHOGONALITY, UNIT_ROUNDOFF
from satcheck.core.shapes import (
    UNTURNED,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Primitive,
    ShapeImage,
    Sphere,
    half_sizes,
    image_of,
    support,
)

Pose = tuple[float, ...]  # (tx, ty, tz, qx, qy, qz, qw)
Quaternion = tuple[float, float, float, float]
_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_PAIRS = ((0, 1), (0, 2), (1, 2))
_UPRIGHT: dict[type, Callable[[float, float], native.Shape]] = {
    Capsule: native.Capsule,
    Cylinder: native.Cylinder,
    Cone: native.Cone,
}


class CurvedShape(Struct, frozen=True):
    """shape: in its own frame; pose: rigid. slack: no point of the placed shape is farther than
    this from the true body, world units. primitive: the sizes, including the scale. image: the
    exact values before pose and sizes were rounded."""

    primitive: Primitive
    shape: native.Shape
    pose: Pose
    slack: float
    image: ShapeImage

    @property
    def centre(self) -> Vector:
        return self.pose[0], self.pose[1], self.pose[2]

    @property
    def turn(self) -> Quaternion:
        x, y, z, w = self.pose[3:]
        return x, y, z, w

    @property
    def inner_radius(self) -> float:
        """A lower bound of the radius of the largest ball about the centre in the shape, world
        units."""
        return _inner_radius(self.primitive) - self.slack

    def moved(self, by: Vector) -> CurvedShape:
        """The shape translated by `by`. Each coordinate of the centre is rounded once, and the
        image moves to the rounded centre."""
        x, y, z = (c + d for c, d in zip(self.centre, by, strict=True))
        image = replace(self.image, origin=(x, y, z))
        return replace(self, pose=(x, y, z, *self.turn), image=image)

    def bounds(self) -> Bounds:
        """A world box around the shape, by its support along each axis, rounded outward."""
        rows = rows_of(self.turn)
        reach = [support(self.primitive, row) for row in rows]
        pads = [
            self.slack + CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * (abs(c) + r)
            for c, r in zip(self.centre, reach, strict=True)
        ]
        # The reach in the opposite direction differs for a cone. All other shapes are symmetric.
        back = [support(self.primitive, (-x, -y, -z)) for x, y, z in rows]
        low = tuple(c - b - p for c, b, p in zip(self.centre, back, pads, strict=True))
        high = tuple(c + r + p for c, r, p in zip(self.centre, reach, pads, strict=True))
        return low, high  # type: ignore[return-value]


class Body(Protocol):
    """A body in the world: a mesh, or a curved shape with its inscribed mesh."""

    @property
    def curved(self) -> CurvedShape | None: ...

    @property
    def bounds(self) -> Bounds:
        """The box of the body; for a curved shape, around the true shape."""

    @property
    def mesh(self) -> native.Mesh: ...

    @property
    def convex(self) -> bool:
        """Whether the mesh is convex."""

    def surface(self) -> native.Surface: ...

    def hull(self) -> native.Polytope: ...

    def hull_shape(self) -> native.Shape: ...


def is_convex(body: Body) -> bool:
    return body.curved is not None or body.convex


def curved_shape(primitive: Primitive, transform: tuple[float, ...] | None) -> CurvedShape:
    """The shape placed by a row-major 4x4. Raises ValueError if its image is not a shape of this
    kind."""
    image = image_of(primitive, transform)
    columns, centre = image.columns, image.origin
    if transform is None:
        return CurvedShape(primitive, _native_shape(primitive), (*centre, *_NO_TURN), 0.0, image)
    stretch = [math.hypot(*column) for column in columns]
    axes = [tuple(c / s for c in column) for column, s in zip(columns, stretch, strict=True)]
    skew = max(abs(sum(p * q for p, q in zip(axes[i], axes[j], strict=True))) for i, j in _PAIRS)
    if skew > ORTHOGONALITY:
        raise ValueError("a curved shape cannot be skewed")
    if _determinant(axes) < 0:  # each shape is symmetric under x -> -x
        axes[0] = tuple(-c for c in axes[0])
    scaled = _scaled(primitive, stretch)
    turn = _quaternion_of(axes[0], axes[1], axes[2])
    is_exact = stretch == [1.0, 1.0, 1.0] and tuple(axes) == UNTURNED
    rounding = CHAIN_ROUNDOFFS * UNIT_ROUNDOFF + 2 * ORTHOGONALITY * (skew > 0)
    slack = 0.0 if is_exact else rounding * _extent(scaled)
    return CurvedShape(scaled, _native_shape(scaled), (*centre, *turn), slack, image)


def _native_shape(primitive: Primitive) -> native.Shape:
    sizes = half_sizes(primitive)
    if isinstance(primitive, Ellipsoid):
        return native.Ellipsoid(sizes)
    radius, _, half_height = sizes
    if isinstance(primitive, Sphere):
        return native.Sphere(radius)
    return _UPRIGHT[type(primitive)](radius, half_height)


def _inner_radius(primitive: Primitive) -> float:
    a, b, half_height = half_sizes(primitive)
    match primitive:
        case Sphere() | Capsule():
            return a
        case Cone(radius, height):  # distance from the centre to the side
            return min(half_height, radius / 2 * (height / math.hypot(radius, height)))
        case _:
            return min(a, b, half_height)


def _extent(primitive: Primitive) -> float:
    return sum(support(primitive, axis) for axis in ((1.0, 0, 0), (0, 1.0, 0), (0, 0, -1.0)))


def _scaled(primitive: Primitive, by: list[float]) -> Primitive:
    a, b, c = by
    across = _same(a, b)
    evenly = across and _same(a, c)
    match primitive:
        case Sphere(radius) if not evenly:
            return Ellipsoid((radius * a, radius * b, radius * c))
        case Sphere(radius):
            return Sphere(radius * a)
        case Ellipsoid((x, y, z)):
            return Ellipsoid((x * a, y * b, z * c))
        case Capsule(radius, length) if evenly:
            return Capsule(radius * a, length * c)
        case Cylinder(radius, height) if across:
            return Cylinder(radius * a, height * c)
        case Cone(radius, height) if across:
            return Cone(radius * a, height * c)
    kind = type(primitive).__name__.lower()
    raise ValueError(f"a {kind} scaled unevenly is no {kind}")


def _same(a: float, b: float) -> bool:
    """Whether two lengths of columns are equal up to rounding."""
    return abs(a - b) <= CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * max(a, b)


def _determinant(columns: list[tuple[float, ...]]) -> float:
    a, b, c = columns
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def rows_of(quaternion: Quaternion) -> list[Vector]:
    """The rows of the rotation matrix: the world axes in the shape's frame."""
    x, y, z, w = quaternion
    return [
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    ]


def _quaternion_of(x: tuple[float, ...], y: tuple[float, ...], z: tuple[float, ...]) -> Quaternion:
    """(qx, qy, qz, qw) of the rotation with these columns.

    Method: Stanley W. Shepperd, "Quaternion from Rotation Matrix" (1978): divide by the largest of
    the four candidates.
    """
    squares = (
        1 + x[0] - y[1] - z[2],
        1 - x[0] + y[1] - z[2],
        1 - x[0] - y[1] + z[2],
        1 + x[0] + y[1] + z[2],
    )
    rows = (
        (squares[0], y[0] + x[1], z[0] + x[2], y[2] - z[1]),
        (y[0] + x[1], squares[1], z[1] + y[2], z[0] - x[2]),
        (z[0] + x[2], z[1] + y[2], squares[2], x[1] - y[0]),
        (y[2] - z[1], z[0] - x[2], x[1] - y[0], squares[3]),
    )
    row = rows[squares.index(max(squares))]
    length = math.hypot(*row)
    return row[0] / length, row[1] / length, row[2] / length, row[3] / length
