"""How much a variant may change an answer, derived; u is the unit roundoff of float64.

The signed distance of two convex bodies, and any gap, changes by at most the sum of how far the two
surfaces are moved against each other: their support functions do, and so do closest points.
"""

from __future__ import annotations

import math
from fractions import Fraction

from satcheck.core.tolerances import UNIT_ROUNDOFF
from satcheck.studies.stability.variant import Rows

# A figure of the convex tier lies in its proven bounds. They close to two support errors of 40 u
# and 16 u of slack, all times the scale of the pair: the extents of both and their offset, each at
# most twice the largest coordinate. The chain of operations of the mesh tier, 64 u, is shorter.
FIGURE_ROUNDOFFS = (2 * 40 + 16) * 6

# A vertex of which each coordinate is off by one unit is off by the square root of 3.
VERTEX = math.sqrt(3.0)


def rounding_of_figures(largest_coordinate: float) -> float:
    """What a computed gap or depth may be off by."""
    return FIGURE_ROUNDOFFS * UNIT_ROUNDOFF * largest_coordinate


def rounded_once(largest_coordinate: float) -> float:
    """How far rounding each coordinate to nearest moves a vertex."""
    return VERTEX * UNIT_ROUNDOFF * largest_coordinate


def one_ulp(largest_coordinate: float) -> float:
    """How far a vertex moves when each coordinate goes to its neighbour: at most 2 u of it."""
    return 2 * VERTEX * UNIT_ROUNDOFF * largest_coordinate


def stretch(turn: Rows) -> float:
    """By how much, relatively, a matrix that is nearly a rotation changes a length, at most.

    Its singular values differ from 1 by at most the norm of M^T M - 1, here computed exactly.
    """
    rows = [[Fraction(entry) for entry in row] for row in turn]
    excess = [
        sum(rows[k][i] * rows[k][j] for k in range(3)) - (i == j)
        for i in range(3)
        for j in range(3)
    ]
    return math.hypot(*(float(one) for one in excess)) * (1 + 8 * UNIT_ROUNDOFF)
