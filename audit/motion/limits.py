"""The budget and the resolution of a sweep, in steps and shares of t, never in seconds."""

from __future__ import annotations

# If a step is shorter than this share of the motion, the bodies count as in contact. The first
# overlap is searched down to the same share.
SHORTEST_STEP = 2.0**-30
# If no step of at least this share keeps the bodies farther apart than a length, the scan no longer
# tries to prove that they stay so far apart.
SHORTEST_WIDE_STEP = 2.0**-12
# A contact that lasts for more touch bands of motion than this is a contact of its own; a shorter
# one is the start of an overlap.
SLID = 64
# Queries about one pair: how long it stays free, how large its gap is.
STEPS = 4096
# Pairs of boxes and triangles that all these queries may visit: a few seconds.
VISITS = 10_000_000
# The broad phase halves the motion so often: after 6 halvings a part is 1/64 of it.
HALVINGS = 6
# Poses after an unproven contact in which an overlap is searched.
PROBES = 64
# The search for the worst pose ends when the interval is narrower than this share of the figure.
WORST_WIDTH = 0.01
# For the worst pose: the most intervals of t. For bodies that are not both convex, the most poses
# whose depth is measured coarsely, and the most measured as narrowly as the depth of a pair.
WORST_INTERVALS = 512
WORST_DEPTHS = 24
WORST_REFINED = 2
# The least touch band of a sweep, in units of the rounding of a pose.
PADS_IN_BAND = 8
# The hull that a sliding body sweeps is tried over the rest of a piece of the motion, and over so
# many parts of it, each half as long as the one before.
SLIDES = 8


def is_step(step: float, t: float, end: float) -> bool:
    """Whether a step from t on is long enough to be one, or reaches the end."""
    return step >= SHORTEST_STEP or t + step >= end
