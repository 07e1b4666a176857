"""The shadows of two point sets on axes, and the exact sign of the gap between them.

An axis is a cross product of two differences of points, so it is known exactly although its unit
direction is rounded. Float64 with a bound of its error decides most signs; integers decide the
others, after J. R. Shewchuk's plan (1997) of a filter before exact arithmetic.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.core.rounding import UNIT_ROUNDOFF

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Integers = tuple[int, int, int]

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


class Axes(Struct, frozen=True):
    """The lines along (q - p) x (s - r). points: (n, 3), world; corners: (m, 4), p q r s."""

    points: Floats
    corners: Indices

    def __len__(self) -> int:
        return len(self.corners)

    def vectors(self) -> tuple[Floats, Floats]:
        """q - p and s - r, rounded."""
        p, q, r, s = (self.points[column] for column in self.corners.T)
        return q - p, s - r


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


class ExactPoints:
    """Float64 points as integers, times a power of two that all of them share."""

    def __init__(self, points: Floats) -> None:
        mantissas, exponents = np.frexp(points)
        self._mantissas = np.ldexp(mantissas, 53).astype(np.int64)
        used = exponents[mantissas != 0]
        self._shifts = exponents - (used.min() if len(used) else 0)
        self.unit = Fraction(2) ** (int(used.min()) - 53 if len(used) else 0)

    def __getitem__(self, index: int) -> Integers:
        x, y, z = (
            int(m) << max(int(k), 0)
            for m, k in zip(self._mantissas[index], self._shifts[index], strict=True)
        )
        return x, y, z

    def cross(self, corners: Indices) -> Integers:
        """(q - p) x (s - r)."""
        p, q, r, s = (self[int(index)] for index in corners)
        ux, uy, uz = (x - y for x, y in zip(q, p, strict=True))
        vx, vy, vz = (x - y for x, y in zip(s, r, strict=True))
        return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx

    def in_plane(self, corners: Indices, others: Indices) -> bool:
        """Whether the points `others` lie in the plane through p, q and s of the corners."""
        normal, p = self.cross(corners), self[int(corners[0])]
        offsets = (self[int(other)] for other in others)
        return all(
            sum(n * (x - y) for n, x, y in zip(normal, point, p, strict=True)) == 0
            for point in offsets
        )


def directions(axes: Axes, exact: ExactPoints) -> tuple[Floats, Floats]:
    """Unit vectors along the axes, and how far each may be off (radians). A zero vector, and
    infinity, where the two differences are parallel."""
    u, v = axes.vectors()
    across = np.cross(u, v)
    length = np.linalg.norm(across, axis=1)
    room = np.linalg.norm(u, axis=1) * np.linalg.norm(v, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        off = np.where(length > 0, CROSS_ROUNDOFFS * UNIT_ROUNDOFF * room / length, np.inf)
        unit = np.where(length[:, None] > 0, across / length[:, None], 0.0)
    for k in np.flatnonzero(~(off <= TRUSTED_DIRECTION)):
        normal = exact.cross(axes.corners[k])
        largest = max(map(abs, normal))
        scaled = np.array([n / largest for n in normal]) if largest else np.zeros(3)
        unit[k] = scaled / np.linalg.norm(scaled) if largest else 0.0
        off[k] = EXACT_DIRECTION if largest else np.inf
    return unit, off


def shadows(a: Indices, b: Indices, axes: Axes, exact: ExactPoints) -> Shadows:
    """Of the points `a` and the points `b` of the axes; an axis has to have a direction."""
    unit, off = directions(axes, exact)
    used = axes.points[np.concatenate((a, b))]
    centre = 0.5 * (used.min(axis=0) + used.max(axis=0))
    local = axes.points - centre
    reach = float(np.linalg.norm(used - centre, axis=1).max())
    heights_off = (HEIGHT_ROUNDOFFS * UNIT_ROUNDOFF + off) * reach
    ends = np.empty((len(unit), 4))
    step = max(1, BLOCK // len(used))
    for first in range(0, len(unit), step):
        rows = slice(first, first + step)
        on_a, on_b = heights(unit[rows], local[a]), heights(unit[rows], local[b])
        ends[rows] = np.column_stack((on_a.min(1), on_a.max(1), on_b.min(1), on_b.max(1)))
    turned = _points_back(unit, ends, heights_off)
    unit[turned] *= -1.0
    ends[turned] = -ends[turned][:, [1, 0, 3, 2]]
    gap, bound = ends[:, 2] - ends[:, 1], 2 * heights_off
    sign = np.sign(gap).astype(np.int8)
    for k in np.flatnonzero(np.abs(gap) <= bound):
        near = 2 * heights_off[k]
        sign[k], gap[k] = _exact_gap(exact, axes.corners[k], unit[k], local, (a, b), near)
        bound[k] = VALUE_ROUNDOFFS * UNIT_ROUNDOFF * abs(gap[k])
    places = heights(unit, centre[None, :])
    return Shadows(unit, ends[:, :2] + places, ends[:, 2:] + places, gap, bound, sign)


def _points_back(unit: Floats, ends: Floats, off: Floats) -> NDArray[np.bool_]:
    """Whether an axis leads from B to A. Where both ways are as good, its largest component is
    positive."""
    forward, backward = ends[:, 2] - ends[:, 1], ends[:, 0] - ends[:, 3]
    largest = np.take_along_axis(unit, np.abs(unit).argmax(axis=1)[:, None], axis=1)[:, 0]
    alike = np.abs(forward - backward) <= 4 * off
    return np.where(alike, largest < 0, backward > forward)


def heights(unit: Floats, points: Floats) -> Floats:
    """(m, n): along each axis. Not by a matrix product: BLAS rounds differently on each machine."""
    x, y, z = (np.multiply.outer(unit[:, k], points[:, k]) for k in range(3))
    return np.asarray((x + y) + z)


def _exact_gap(
    exact: ExactPoints,
    corners: Indices,
    unit: Floats,
    local: Floats,
    sides: tuple[Indices, Indices],
    near: float,
) -> tuple[int, float]:
    """Sign and value of the larger of the two gaps along an axis, B beyond A and A beyond B.

    near: points this close to an end of a shadow, as rounded, can be its end.
    """
    normal = exact.cross(corners)
    spans = []
    for side in sides:
        along = heights(unit[None, :], local[side])[0]
        ends = side[(along >= along.max() - near) | (along <= along.min() + near)]
        exactly = [sum(n * c for n, c in zip(normal, exact[int(i)], strict=True)) for i in ends]
        spans.append((min(exactly), max(exactly)))
    (low_a, high_a), (low_b, high_b) = spans
    gap = max(low_b - high_a, low_a - high_b)
    largest = max(map(abs, normal))
    length = float(np.linalg.norm([n / largest for n in normal]))
    return (gap > 0) - (gap < 0), float(Fraction(gap, largest) * exact.unit) / length
