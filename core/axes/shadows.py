"""The shadows of two point sets on axes, and the exact sign of the gap between them.

An axis is a cross product of two differences of points, so it is known exactly although its unit
direction is rounded. Float64 with a bound of its error decides most signs; integers decide the
others, after J. R. Shewchuk's plan (1997) of a filter before exact arithmetic.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.core.rounding import UNIT_ROUNDOFF

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Integers = NDArray[Any]  # Python's, of any size

# Of a component of a float64 cross product, times both lengths: one rounding in each of the two
# differences, 3 in the product; times the square root of 3 for the vector.
CROSS_ROUNDOFFS = 12
# A direction that is off by more (radians) is computed again, from integers.
TRUSTED_DIRECTION = 1e-12
# Of a unit direction from integers: each component, its norm and the quotient are rounded.
EXACT_DIRECTION = 8 * UNIT_ROUNDOFF
# Of a height: a rounded difference from the centre, 3 products, 2 sums; times the root of 3.
HEIGHT_ROUNDOFFS = 16
# Of the value that follows from integers: quotient, root and product.
VALUE_ROUNDOFFS = 8
# Heights in memory at a time.
BLOCK = 1 << 21


class Shadows(Struct, frozen=True):
    """A row for each axis. direction: (m, 3), unit, from A to B. a, b: (m, 2), the least and the
    greatest world coordinate along it. gap: (m,), negative where the shadows overlap, by how much;
    off: (m,), how far it may be from the true one. sign: (m,), of the true gap."""

    direction: Floats
    a: Floats
    b: Floats
    gap: Floats
    off: Floats
    sign: NDArray[np.int8]


class Points:
    """World points in float64, and the same as integers times a power of two, `unit`.

    An axis is a row of four of them, p q r s: the line along (q - p) x (s - r).
    """

    def __init__(self, world: Floats) -> None:
        mantissas, exponents = np.frexp(world)
        shifts = np.where(mantissas == 0, 0, exponents - exponents[mantissas != 0].min(initial=0))
        least = int(exponents[mantissas != 0].min(initial=0))
        whole = np.ldexp(mantissas, 53).astype(np.int64)
        self.world = world
        self.exact: Integers = whole.astype(object) << shifts.astype(object)
        self.unit = Fraction(2) ** (least - 53)

    def directions(self, axes: Indices) -> tuple[Floats, Floats]:
        """Unit vectors along the axes, and how far each may be off (radians). A zero vector, and
        infinity, where the two differences are parallel."""
        p, q, r, s = (self.world[column] for column in axes.T)
        across = np.cross(q - p, s - r)
        length = np.linalg.norm(across, axis=1)
        room = np.linalg.norm(q - p, axis=1) * np.linalg.norm(s - r, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            off = np.where(length > 0, CROSS_ROUNDOFFS * UNIT_ROUNDOFF * room / length, np.inf)
            unit = np.where(length[:, None] > 0, across / length[:, None], 0.0)
        for k in np.flatnonzero(~(off <= TRUSTED_DIRECTION)):
            normal = self.normal(axes[k])
            largest = abs(normal).max()
            scaled = np.array([n / largest if largest else 0.0 for n in normal])
            unit[k] = scaled / np.linalg.norm(scaled) if largest else 0.0
            off[k] = EXACT_DIRECTION if largest else np.inf
        return unit, off

    def normal(self, axis: Indices) -> Integers:
        p, q, r, s = self.exact[axis]
        (ux, uy, uz), (vx, vy, vz) = q - p, s - r
        return np.array([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], dtype=object)

    def exact_gap(self, axis: Indices, a: Indices, b: Indices) -> tuple[int, float]:
        """Sign and value of the larger of the two gaps along an axis, B beyond A and A beyond B."""
        normal = self.normal(axis)
        on_a, on_b = ((self.exact[side] * normal).sum(axis=1) for side in (a, b))
        gap = max(on_b.min() - on_a.max(), on_a.min() - on_b.max())
        largest = abs(normal).max()
        length = float(np.linalg.norm([n / largest for n in normal]))
        return (gap > 0) - (gap < 0), float(Fraction(gap, largest) * self.unit) / length


def shadows(points: Points, axes: Indices, a: Indices, b: Indices) -> Shadows:
    """Of the points `a` and the points `b`; an axis has to have a direction."""
    unit, off = points.directions(axes)
    used = points.world[np.concatenate((a, b))]
    centre = 0.5 * (used.min(axis=0) + used.max(axis=0))
    local = points.world - centre
    reach = float(np.linalg.norm(used - centre, axis=1).max())
    heights_off = (HEIGHT_ROUNDOFFS * UNIT_ROUNDOFF + off) * reach
    ends = np.empty((len(unit), 4))
    step = max(1, BLOCK // len(used))
    for first in range(0, len(unit), step):
        rows = slice(first, first + step)
        on_a, on_b = _heights(unit[rows], local[a]), _heights(unit[rows], local[b])
        ends[rows] = np.column_stack((on_a.min(1), on_a.max(1), on_b.min(1), on_b.max(1)))
    turned = _points_back(unit, ends, heights_off)
    unit[turned] *= -1.0
    ends[turned] = -ends[turned][:, [1, 0, 3, 2]]
    gap, bound = ends[:, 2] - ends[:, 1], 2 * heights_off
    sign = np.sign(gap).astype(np.int8)
    for k in np.flatnonzero(np.abs(gap) <= bound):
        sign[k], gap[k] = points.exact_gap(axes[k], a, b)
        bound[k] = VALUE_ROUNDOFFS * UNIT_ROUNDOFF * abs(gap[k])
    places = _heights(unit, centre[None, :])
    return Shadows(unit, ends[:, :2] + places, ends[:, 2:] + places, gap, bound, sign)


def _points_back(unit: Floats, ends: Floats, off: Floats) -> NDArray[np.bool_]:
    """Whether an axis leads from B to A. Where both ways are as good, its largest component is
    positive."""
    forward, backward = ends[:, 2] - ends[:, 1], ends[:, 0] - ends[:, 3]
    largest = np.take_along_axis(unit, np.abs(unit).argmax(axis=1)[:, None], axis=1)[:, 0]
    alike = np.abs(forward - backward) <= 4 * off
    return np.where(alike, largest < 0, backward > forward)


def _heights(unit: Floats, points: Floats) -> Floats:
    """(m, n): along each axis. Not by a matrix product: BLAS rounds differently on each machine."""
    x, y, z = (np.multiply.outer(unit[:, k], points[:, k]) for k in range(3))
    return np.asarray((x + y) + z)
