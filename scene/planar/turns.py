"""Exact orientation of triangles in the plane."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

# Rounding of the 2 x 2 determinant of coordinate differences: Shewchuk, "Adaptive Precision
# Floating-Point Arithmetic and Fast Robust Geometric Predicates" (1997), the bound ccwerrboundA.
_FILTER = (3 + 16 * 2.0**-53) * 2.0**-53
# Products below this may have lost digits to underflow.
_TINY = 2.0**-960


def turns(points: Floats, triangles: Indices) -> npt.NDArray[np.int8]:
    """The exact orientation of each triangle: +1 counter-clockwise, -1 clockwise, 0 on a line.

    points: (n, 2); triangles: (m, 3).
    """
    a, b, c = (points[triangles[:, k]] for k in range(3))
    with np.errstate(over="ignore", invalid="ignore", under="ignore"):
        left = (a[:, 0] - c[:, 0]) * (b[:, 1] - c[:, 1])
        right = (a[:, 1] - c[:, 1]) * (b[:, 0] - c[:, 0])
        value, size = left - right, np.abs(left) + np.abs(right)
        certain = (np.abs(value) > _FILTER * size) & (size > _TINY) & np.isfinite(size)
    signs = np.sign(np.where(certain, value, 0.0)).astype(np.int8)
    for k in np.flatnonzero(~certain):
        signs[k] = _exact_turn(points[triangles[k]].tolist())
    return signs


def _exact_turn(corners: list[list[float]]) -> int:
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in corner] for corner in corners)
    value = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
    return (value > 0) - (value < 0)
