"""The world boxes of moving bodies over a part of their motion, for the broad phase.

Two bodies whose boxes over the whole motion overlap are mostly never close at the same time. The
motion is therefore halved, again and again, until the boxes over each part are apart.
"""

from __future__ import annotations

import math

from satcheck import core
from satcheck.audit.bodies.boxes import Box, corners
from satcheck.audit.motion.limits import HALVINGS
from satcheck.audit.motion.track import STANDS, Piece, Track
from satcheck.audit.motion.turn import applied

# Radians that a body turns between two boxed poses: 15 degrees.
STEP = math.pi / 12
# A motion with more steps gets the box of an endless rotation.
MOST_POSES = 96
# The box of a motion beyond float64.
EVERYWHERE: Box = ((-math.inf, -math.inf, -math.inf), (math.inf, math.inf, math.inf))


class SweptBoxes:
    """A body as it moves. bounds: of the body as placed. The boxes are kept, because many pairs
    have the same moving body."""

    def __init__(self, bounds: Box, track: Track = STANDS) -> None:
        self.placed = bounds
        self._track = track
        self._boxes: dict[tuple[float, float], Box] = {}

    def over(self, start: float, end: float) -> Box:
        """Contains the body at every t from start to end."""
        if self._track is STANDS:
            return self.placed
        box = self._boxes.get((start, end))
        if box is None:
            box = self._boxes[start, end] = swept_box(self.placed, self._track, start, end)
        return box


def may_meet(a: SweptBoxes, b: SweptBoxes, limit: float) -> bool:
    """Whether the boxes are as close as the limit, as placed or over some part of the motion."""
    if core.box_gap(a.placed, b.placed) <= limit:
        return True
    parts = [(0.0, 1.0)]
    while parts:
        start, end = parts.pop()
        if core.box_gap(a.over(start, end), b.over(start, end)) > limit:
            continue
        if end - start <= 2.0**-HALVINGS:
            return True
        middle = 0.5 * (start + end)
        parts += [(middle, end), (start, middle)]
    return False


def swept_box(bounds: Box, track: Track, start: float = 0.0, end: float = 1.0) -> Box:
    """Contains the body at every t from start to end. bounds: of the body as placed."""
    boxes = []
    for piece in track.pieces:
        if piece.start < end and start < piece.end:
            boxes += _boxes(bounds, piece, max(start, piece.start), min(end, piece.end))
    pad = track.pad(bounds)
    if not all(math.isfinite(c) for box in boxes for corner in box for c in (*corner, pad)):
        return EVERYWHERE
    low, high = (
        tuple(pick(box[side][axis] for box in boxes) + way * pad for axis in range(3))
        for side, pick, way in ((0, min, -1.0), (1, max, 1.0))
    )
    return low, high  # type: ignore[return-value]


def _boxes(bounds: Box, piece: Piece, start: float, end: float) -> list[Box]:
    """Between two poses a point moves along an arc about the moving centre. Its distance from the
    linear interpolation is at most angle squared / 8 of its radius."""
    length = end - start
    turned = math.radians(abs(piece.degrees)) * (length / (piece.end - piece.start))
    count = min(max(math.ceil(turned / STEP), 1), MOST_POSES)
    radius = max(math.dist(corner, piece.pivot) for corner in corners(bounds))
    angle = min(turned / count, 4.0)  # radians; the error is never more than twice the radius
    grown = radius * angle * angle / 8.0
    times = [start + length * k / count for k in range(count + 1)]
    return [_box(bounds, piece, t, grown) for t in times]


def _box(bounds: Box, piece: Piece, t: float, grown: float) -> Box:
    turn, centre = piece.turn_at(t), piece.centre_at(t)
    points = []
    for corner in corners(bounds):
        x, y, z = (c - p for c, p in zip(corner, piece.pivot, strict=True))
        points.append(applied(turn, (x, y, z)))
    low, high = (
        tuple(
            centre[axis] + pick(point[axis] for point in points) + way * grown for axis in range(3)
        )
        for pick, way in ((min, -1.0), (max, 1.0))
    )
    return low, high  # type: ignore[return-value]
