"""Every tolerance of this room: its name, its unit, where it comes from. Those of float64
arithmetic are in `core/tolerances.py`."""

from __future__ import annotations

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


def keeps(clearance: float, least: float, most: float) -> bool | None:
    """Whether a gap between these bounds keeps the clearance; None: not decided. Figures are
    rounded: bounds that hold a clearance less than that below their ends keep it."""
    if most < clearance:
        return False
    return True if least >= clearance * (1 - EXACT_WIDTH) else None
