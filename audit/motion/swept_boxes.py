"""Boxes around the motion of a body, part by part."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck import core
from satcheck.audit.body import Box, around_both, corners
from satcheck.audit.motion.track import Track

Floats = NDArray[np.float64]

# A motion is boxed in this many parts, or in more, up to MOST_PARTS, so that no body turns by more
# than STEP radians in one of them.
PARTS = 64
MOST_PARTS = 512
STEP = math.pi / 12


class Parts(Struct, frozen=True):
    """A motion between some times. poses: at the times, (n, 3, 4).
    pivots: of each part, (n - 1, 3). bends: how far a point gets from the line between its places
    at both ends of a part, as a share of its distance from the pivot, (n - 1)."""

    track: Track
    poses: Floats
    pivots: Floats
    bends: Floats


def parts_of(track: Track, times: Sequence[float]) -> Parts:
    """Return a motion between these times, which include those of its track."""
    poses = np.array([track.pose_at(t)[:12] for t in times]).reshape(-1, 3, 4)
    pieces = [track.piece_at(t) for t in times[:-1]]
    turned = np.array([math.hypot(*piece.spin) for piece in pieces]) * np.diff(times)
    # A point moves along an arc about the moving centre, never more than twice the radius away.
    bends = np.minimum(turned, 4.0) ** 2 / 8.0
    return Parts(track, poses, np.array([piece.pivot for piece in pieces]), bends)


class SweptBoxes:
    """The world boxes of a body over the parts of its motion. low, high: shape (parts, 3). placed:
    its box as placed."""

    def __init__(self, placed: Box, parts: Parts | None) -> None:
        """parts: None: the body stands."""
        self.placed = placed
        if parts is None:
            self.low, self.high = (np.array([corner]) for corner in placed)
            return
        ends = np.array(corners(placed))
        with np.errstate(all="ignore"):
            radius = np.linalg.norm(ends - parts.pivots[:, None], axis=2).max(axis=1)
            grown = (radius * parts.bends + parts.track.pad(placed))[:, None]
            at = parts.poses[:, :, :3] @ ends.T + parts.poses[:, :, 3:]
            low, high = at.min(axis=2), at.max(axis=2)
            self.low = np.minimum(low[:-1], low[1:]) - grown
            self.high = np.maximum(high[:-1], high[1:]) + grown
        beyond = ~(np.isfinite(self.low) & np.isfinite(self.high)).all(axis=1)
        self.low[beyond], self.high[beyond] = -math.inf, math.inf

    @property
    def whole(self) -> Box:
        """The box of the body as placed and over the whole motion."""
        low, high = (tuple(c.tolist()) for c in (self.low.min(axis=0), self.high.max(axis=0)))
        return around_both(self.placed, (low, high))

    def may_meet(self, other: SweptBoxes, limit: float) -> bool:
        """Return whether the boxes are as close as the limit, as placed or over some part of the
        motion. Boxes over the whole motion may overlap of bodies that are never close at the same
        time."""
        gaps = np.maximum(self.low - other.high, other.low - self.high).clip(min=0.0)
        near = bool((np.linalg.norm(gaps, axis=1) <= limit).any())
        return near or core.box_gap(self.placed, other.placed) <= limit


def part_times(tracks: Collection[Track]) -> list[float]:
    """The times between which a motion gets a box of its own: even parts, in which no body turns by
    more than STEP if that makes few enough of them, and the ends of all pieces."""
    turned = [sum(abs(piece.degrees) for piece in track.pieces) for track in tracks]
    steps = math.ceil(math.radians(max(turned, default=0.0)) / STEP)
    count = min(max(steps, PARTS), MOST_PARTS)
    ends = {time for track in tracks for time in track.times}
    return sorted(ends | {k / count for k in range(count + 1)})
