"""Bounds of the rounding errors of float64 coordinates, each with its name and derivation."""

from __future__ import annotations

# Unit roundoff of float64: a rounded sum or product is off by at most this much, relatively.
UNIT_ROUNDOFF = 2.0**-53

# A short chain of float64 operations on coordinates (a rotation, a translation, a scaling about a
# point: fewer than 16 roundings each of at most UNIT_ROUNDOFF times the largest intermediate, which
# is below 4 times the largest coordinate) stays within this many roundoffs of that coordinate.
CHAIN_ROUNDOFFS = 64

# Columns of a transform whose cosines are below this count as perpendicular: an oriented box is
# then fitted, and padded by the same fraction of its size, which covers what the cosines neglect.
ORTHOGONALITY = 1e-12


def rounding_pad(largest_coordinate: float) -> float:
    """World units: what a short chain of operations on such coordinates can be off by."""
    return CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * largest_coordinate
