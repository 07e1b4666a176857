"""Bounds of the rounding errors of float64 coordinates, each with its name and derivation."""

from __future__ import annotations

# Unit roundoff of float64: the largest relative error of a rounded sum or product.
UNIT_ROUNDOFF = 2.0**-53

# A short chain of float64 operations on coordinates (a rotation, a translation, a scaling about a
# point: fewer than 16 roundings each of at most UNIT_ROUNDOFF times the largest intermediate, which
# is below 4 times the largest coordinate) stays within this many roundoffs of that coordinate.
CHAIN_ROUNDOFFS = 64

# Columns of a transform count as perpendicular if their cosines are below this. An oriented box is
# then fitted and padded by the same fraction of its size, which covers the neglected cosines.
ORTHOGONALITY = 1e-12


def rounding_pad(largest_coordinate: float) -> float:
    """The largest error of a short chain of operations on such coordinates, world units."""
    return CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * largest_coordinate
