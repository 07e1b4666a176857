"""Shapes defined by their sizes: a box, five curved shapes, and a half space.

Each is convex. All but the half space are centred at their own origin, with their axis along z. The
apex of a cone is at +z.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, TypeGuard

from msgspec import Meta, Struct, to_builtins
from msgspec.structs import force_setattr

from satcheck.core.conventions import Vector

Size = Annotated[float, Meta(gt=0)]
Sizes = tuple[Size, Size, Size]
Values = dict[str, str | float | Vector]
Columns = tuple[Vector, Vector, Vector]

_TRIPLES = frozenset(("size", "radii"))
_NUMBERS = frozenset((int, float))
UNTURNED: Columns = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
# The rounding error of the entries of M^T M for a rotation M in float64.
_TURN_ROUNDING = 2.0**-47


class Sized(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag=str.lower):
    """Base of shapes. Fields are positive finite numbers, or tuples of three. Else raises
    ValueError."""

    def __post_init__(self) -> None:
        for name in self.__struct_fields__:
            force_setattr(self, name, _checked_size(name, getattr(self, name)))


class Box(Sized, frozen=True):
    """size: full extents along x, y and z."""

    size: Sizes


class HalfSpace(Sized, frozen=True, tag="half-space"):
    """All points with z <= 0.

    A check replaces it by a block: |x|, |y| <= reach, -reach <= z <= 0. Both are the same to every
    body that `reaches` holds: any way out of the block but through z = 0 is longer, and no ball in
    such a body is nearer to another face.
    """

    reach: Size = 1.0

    @property
    def reaches(self) -> float:
        """Return how far from the origin the points of another body may be, in the frame of the
        shape."""
        return self.reach * 3 / 8


class Sphere(Sized, frozen=True):
    """All points at most `radius` from the origin."""

    radius: Size


class Capsule(Sized, frozen=True):
    """All points at most `radius` from a segment of `length` along z. `length` excludes the
    caps."""

    radius: Size
    length: Size


class Cylinder(Sized, frozen=True):
    """height: from one flat end to the other."""

    radius: Size
    height: Size


class Cone(Sized, frozen=True):
    """radius: of its base, at z = -height / 2; the apex is at z = height / 2."""

    radius: Size
    height: Size


class Ellipsoid(Sized, frozen=True):
    """radii: along x, y and z."""

    radii: Sizes


Curved = Sphere | Capsule | Cylinder | Cone | Ellipsoid
Primitive = Box | HalfSpace | Curved


def is_curved(shape: object) -> TypeGuard[Curved]:
    """Return whether a mesh only approximates the shape."""
    return isinstance(shape, Curved)


def values_of(shape: Struct) -> Values:
    """The shape as a scene file states it, for example {"type": "box", "size": (x, y, z)}."""
    return to_builtins(shape)  # type: ignore[no-any-return]


def sizes_of(shape: Primitive) -> tuple[float, ...]:
    """The sizes in the order of the fields."""
    sizes = (getattr(shape, name) for name in shape.__struct_fields__)
    return tuple(s for size in sizes for s in (size if isinstance(size, tuple) else (size,)))


def half_sizes(shape: Primitive) -> Vector:
    """Half sizes along x, y, z: radius, radius, half height (of a capsule without its caps); for an
    ellipsoid, its radii; for a half space, those of its block."""
    match shape:
        case Sphere(radius):
            return radius, radius, 0.0
        case Capsule(radius, height) | Cylinder(radius, height) | Cone(radius, height):
            return radius, radius, height / 2
        case Ellipsoid(radii):
            return radii
        case Box((x, y, z)):
            return x / 2, y / 2, z / 2
        case HalfSpace(reach):
            return reach, reach, reach / 2


def support(shape: Primitive, direction: Vector) -> float:
    """The support value: the largest dot product of the direction with a point of the shape, in its
    own frame."""
    x, y, z = direction
    across = math.hypot(x, y)
    match shape:
        case Box((a, b, c)):
            return (a * abs(x) + b * abs(y) + c * abs(z)) / 2
        case HalfSpace(reach):
            return reach * (abs(x) + abs(y) + max(-z, 0.0))
        case Sphere(radius):
            return radius * math.hypot(x, y, z)
        case Capsule(radius, length):
            return radius * math.hypot(x, y, z) + length / 2 * abs(z)
        case Cylinder(radius, height):
            return radius * across + height / 2 * abs(z)
        case Cone(radius, height):
            return max(height / 2 * z, radius * across - height / 2 * z)
        case Ellipsoid((a, b, c)):
            return math.hypot(a * x, b * y, c * z)


class ShapeImage(Struct, frozen=True):
    """The exact image of a shape under a matrix: the points origin + y[0] columns[0] + y[1]
    columns[1] + y[2] columns[2] for y in the primitive, in rational numbers."""

    primitive: Primitive
    columns: Columns
    origin: Vector


def image_of(primitive: Primitive, transform: tuple[float, ...] | None) -> ShapeImage:
    """The image under a row-major affine 4x4; None: the identity. The rotation of a sphere is
    ignored, so that its rounding has no effect."""
    if transform is None:
        return ShapeImage(primitive, UNTURNED, (0.0, 0.0, 0.0))
    x, y, z = (tuple(transform[k:12:4]) for k in range(3))
    columns: Columns = x, y, z  # type: ignore[assignment]
    if isinstance(primitive, Sphere) and _is_turn(columns):
        columns = UNTURNED
    return ShapeImage(primitive, columns, (transform[3], transform[7], transform[11]))


def _is_turn(columns: Columns) -> bool:
    """Return whether the columns are a rotation, perhaps with a reflection."""
    for i in range(3):
        for j in range(i + 1):
            (a, b, c), (x, y, z) = columns[i], columns[j]
            if abs(a * x + b * y + c * z - (i == j)) > _TURN_ROUNDING:
                return False
    return True


def _checked_size(name: str, value: float | tuple[float, ...]) -> float | tuple[float, ...]:
    """The size in float64."""
    wanted = 3 if name in _TRIPLES else 1
    numbers = value if isinstance(value, tuple) else (value,)
    if isinstance(value, tuple) != (wanted == 3) or len(numbers) != wanted:
        what = "three numbers" if wanted == 3 else "a number"
        raise ValueError(f"{name} should be {what}")
    if not _NUMBERS.issuperset(map(type, numbers)):
        raise ValueError(f"{name} should contain only numbers")
    if not _are_positive(numbers):
        raise ValueError(f"{name} should be positive and finite")
    return tuple(map(float, numbers)) if isinstance(value, tuple) else float(value)


def _are_positive(numbers: Sequence[float]) -> bool:
    """Return whether all numbers are positive and finite."""
    try:
        return min(numbers) > 0 and all(map(math.isfinite, numbers))
    except OverflowError:  # an integer beyond float64
        return False
