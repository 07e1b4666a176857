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

# The range of the core (native/base/numeric_range.hpp): no coordinate of a mesh is larger, and no
# mesh or shape is smaller, unless all its points coincide.
LARGEST_LENGTH = 1e45
SMALLEST_SIZE = 1e-45

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
