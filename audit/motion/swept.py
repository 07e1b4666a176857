"""The world box of a body over its whole motion, for the broad phase."""

from __future__ import annotations

import math

from satcheck.audit.bodies.boxes import Box, corners
from satcheck.audit.motion.track import Piece, Track
from satcheck.audit.motion.turn import applied

# Radians that a body turns between two boxed poses: 15 degrees.
STEP = math.pi / 12
# A motion with more steps gets the box of an endless rotation.
MOST_POSES = 96


def swept_box(bounds: Box, track: Track) -> Box:
    """Contains the body at every t, and as placed. bounds: of the body as placed."""
    boxes = [bounds]
    for piece in track.pieces:
        boxes += _boxes(bounds, piece)
    pad = track.pad(bounds)
    low, high = (
        tuple(pick(box[side][axis] for box in boxes) + way * pad for axis in range(3))
        for side, pick, way in ((0, min, -1.0), (1, max, 1.0))
    )
    return low, high  # type: ignore[return-value]


def _boxes(bounds: Box, piece: Piece) -> list[Box]:
    """Between two poses a point moves along an arc about the moving centre. Its distance from the
    linear interpolation is at most angle squared / 8 of its radius."""
    turned = math.radians(abs(piece.degrees))
    count = min(max(math.ceil(turned / STEP), 1), MOST_POSES)
    length = piece.end - piece.start
    radius = max(math.dist(corner, piece.pivot) for corner in corners(bounds))
    angle = min(turned / count, 4.0)  # radians; the error is never more than twice the radius
    grown = radius * angle * angle / 8.0
    times = [piece.start + length * k / count for k in range(count + 1)]
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
