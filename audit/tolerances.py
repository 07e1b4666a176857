"""Every tolerance of this room: its name, its unit, where it comes from."""

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

# How much longer than its nominal length an MTV may become until the moved mesh is found free, in
# ulps of the largest coordinate of the pair. The first step covers another program's order of
# rounding; each next one is four times longer. The last is about 1e-9 of the size.
LENGTHENING_ULPS = (4, 16, 64, 256, 1024, 4096, 16384, 65536, 262144, 1048576, 4194304)

# The default touch band is at most this fraction of the smaller body's box diagonal. The float32
# coordinates of a part that is 1/4000 of the assembly it sits in still keep their full precision.
TOUCH_FRACTION = 1e-3

# A depth interval this narrow, relatively, comes from rounding alone and is called exact.
EXACT_WIDTH = 1e-9

# The signed volume of a mesh is a sum of determinants from one of its corners: six products of the
# edges of its box each, 9 roundings, as much again for the sum, a sixth of it. So many roundoffs of
# the volume of the box for each triangle.
VOLUME_ROUNDOFFS = 18


def is_within(limit: float, least: float, greatest: float) -> bool | None:
    """Whether a figure between these bounds is within a limit; None: not decided. Figures are
    rounded: one that equals its limit to EXACT_WIDTH is within it."""
    if greatest <= limit * (1 + EXACT_WIDTH):
        return True
    return False if least > limit else None


def rounding_pad(largest_coordinate: float) -> float:
    """World units: what a short chain of operations on such coordinates can be off by."""
    return CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * largest_coordinate
