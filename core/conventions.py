"""Signs, frames and units of the whole program.

World frame, right-handed, float64, units as in the files.

``normal``    unit, from A to B.
``distance``  signed: > 0 a gap, < 0 a penetration; ``distance * normal = witness_b - witness_a``.
``depth``     ``max(0, -distance)``: the length of the shortest translation of A, without rotation,
              after which A and B share no interior.
``mtv``       minimum translation vector, added to A: ``mtv = -depth * normal``. Swapping A and B
              negates it.
"""

from __future__ import annotations

from typing import Literal, get_args

Vector = tuple[float, float, float]
Bounds = tuple[Vector, Vector]  # least and greatest corner of an axis-aligned box

# The meaning of the numbers in PairResults.outcome.
OUTCOMES = ("separated", "touching", "penetrating", "undecided")

Plane = Literal["xy", "yz", "xz"]
PLANES: tuple[Plane, ...] = get_args(Plane)


def axes_of(plane: Plane) -> tuple[int, int]:
    """The two world axes of a plane, in world order."""
    first, second = ("xyz".index(letter) for letter in plane)
    return first, second


def axis_across(plane: Plane) -> int:
    """The world axis perpendicular to a plane."""
    return 3 - sum(axes_of(plane))


def depth_from_distance(distance: float) -> float:
    """Penetration depth of a signed distance; 0.0 for a gap or a touch."""
    return max(0.0, -distance)


def mtv_from(distance: float, normal: Vector) -> Vector:
    """Minimum translation vector of A from the signed distance and the unit normal A to B."""
    depth = depth_from_distance(distance)
    return (-depth * normal[0], -depth * normal[1], -depth * normal[2])
