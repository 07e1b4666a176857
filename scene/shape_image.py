"""What a primitive shape is once a matrix has placed it, exactly."""

from __future__ import annotations

from msgspec import Struct

from satcheck.scene.primitives import Primitive, Sphere

Vector = tuple[float, float, float]
Columns = tuple[Vector, Vector, Vector]

UNTURNED: Columns = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
# Of the entries of M^T M of a rotation: what a chain of float64 products makes of 0 and 1.
_TURN_ROUNDING = 2.0**-47


class ShapeImage(Struct, frozen=True):
    """The points origin + y[0] columns[0] + y[1] columns[1] + y[2] columns[2], in rationals, for y
    in the primitive."""

    primitive: Primitive
    columns: Columns
    origin: Vector


def image_of(primitive: Primitive, transform: tuple[float, ...] | None) -> ShapeImage:
    """Under a row-major affine 4x4; None: as it is. A sphere that is turned stays what it was,
    whatever was rounded in the rotation."""
    if transform is None:
        return ShapeImage(primitive, UNTURNED, (0.0, 0.0, 0.0))
    x, y, z = (tuple(transform[k:12:4]) for k in range(3))
    columns: Columns = x, y, z  # type: ignore[assignment]
    if isinstance(primitive, Sphere) and _is_turn(columns):
        columns = UNTURNED
    return ShapeImage(primitive, columns, (transform[3], transform[7], transform[11]))


def _is_turn(columns: Columns) -> bool:
    """Mirrored or not."""
    for i in range(3):
        for j in range(i + 1):
            (a, b, c), (x, y, z) = columns[i], columns[j]
            if abs(a * x + b * y + c * z - (i == j)) > _TURN_ROUNDING:
                return False
    return True
