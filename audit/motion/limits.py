"""The budget and the resolution of a sweep, in steps and shares of t, never in seconds."""

from __future__ import annotations

# A step shorter than this share of the motion is no progress: the bodies are in contact, as far as
# can be told from there. The first overlap is searched down to the same share.
SHORTEST_STEP = 2.0**-30
# So many touch bands moved in contact are a contact that went on; less is the way into an overlap.
SLID = 64
# Questions about one pair: how long it stays free, how large its gap is.
STEPS = 4096
# Pairs of boxes and triangles that all these questions may visit: seconds.
VISITS = 10_000_000
# Poses beyond a contact that nothing could be proven about, in which an overlap is looked for.
PROBES = 64
# Narrower than this share of the figure, an interval of the deepest or nearest pose is done.
WORST_WIDTH = 0.01
# Intervals of t that the search for the worst pose may look at, and poses of two bodies that are
# not both convex whose depth it measures, coarsely, and as narrowly as the depth of a pair is.
WORST_INTERVALS = 512
WORST_DEPTHS = 24
WORST_REFINED = 2
# A pose is known to rounding only: so many times that is the least touch band of a sweep.
PADS_IN_BAND = 8
