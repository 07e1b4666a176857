"""Constants for the rounding of figures, each with its derivation, and how rounded figures compare
with limits. `core/rounding.py` bounds the rounding of float64 arithmetic."""

from __future__ import annotations

# By how much an MTV may be lengthened until the moved mesh is free, in ulps of the largest
# coordinate of the pair. The first step covers another order of rounding. Each step is four times
# longer than the last. The longest is about 1e-9 of the size.
LENGTHENING_ULPS = (4, 16, 64, 256, 1024, 4096, 16384, 65536, 262144, 1048576, 4194304)

# A depth interval of this relative width comes from rounding alone and counts as exact.
EXACT_WIDTH = 1e-9

# The signed volume of a mesh is a sum of determinants from one of its corners: six products of box
# edges with 9 roundings each, as much again for the sum, divided by six. So the error for each
# triangle is this number of roundoffs of the volume of the box.
VOLUME_ROUNDOFFS = 18


def is_within(limit: float, least: float, greatest: float) -> bool | None:
    """Whether a figure between these bounds is within a limit; None: undecided. Figures are
    rounded, so a figure that equals the limit up to EXACT_WIDTH is within it."""
    if greatest <= limit * (1 + EXACT_WIDTH):
        return True
    return False if least > limit else None


def keeps(clearance: float, least: float, most: float) -> bool | None:
    """Whether a gap between these bounds keeps the clearance; None: undecided. Figures are rounded,
    so a gap that equals the clearance up to EXACT_WIDTH keeps it."""
    if most < clearance:
        return False
    return True if least >= clearance * (1 - EXACT_WIDTH) else None
