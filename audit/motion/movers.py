"""The moving bodies of a scene, the pairs to sweep, and the boxes around their motions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce

from msgspec import convert, to_builtins

from satcheck import core
from satcheck.audit.bodies import PlacedBodies
from satcheck.audit.body import Box, around_both, corners
from satcheck.audit.motion.limits import HALVINGS
from satcheck.audit.motion.track import STANDS, Piece, Track, track_of
from satcheck.audit.pair import Paths
from satcheck.audit.planner import IndexPair, Planner, close_pairs
from satcheck.core.transform import Transform
from satcheck.report.motions import StatedMotion
from satcheck.report.report import Issue
from satcheck.scene.motion import Motion, PosePath, Rotation, Translation

# How a report calls the kinds of paths.
KINDS = {Translation: "translation", Rotation: "rotation", PosePath: "path"}


# Radians that a body turns between two boxed poses: 15 degrees.
STEP = math.pi / 12
# A motion with more steps gets the box of an endless rotation.
MOST_POSES = 96
# The box of a motion beyond float64.
EVERYWHERE: Box = ((-math.inf, -math.inf, -math.inf), (math.inf, math.inf, math.inf))


class Movers:
    def __init__(self, motions: Sequence[Motion]) -> None:
        self._motions = tuple(motions)
        self._motion = {body: motion for motion in motions for body in motion.bodies}
        self._tracks = {id(motion): track_of(motion.path) for motion in motions}
        self._boxes: dict[str, SweptBoxes] = {}

    def paths(self, a: str, b: str) -> Paths | None:
        """The paths of a pair; None: the bodies do not move relative to each other."""
        motion_a, motion_b = self._motion.get(a), self._motion.get(b)
        if motion_a is motion_b:
            return None
        motions = (motion_a, motion_b)
        path_a, path_b = (None if motion is None else motion.path for motion in motions)
        return Paths(path_a, path_b, any(motion and motion.clear for motion in motions))

    def close(self, bodies: PlacedBodies, planner: Planner) -> list[IndexPair]:
        """The pairs that may be as close as they ask, as placed or at some t."""
        placed, ids = bodies.placed, bodies.ids

        def meet(i: int, j: int) -> bool:
            limit = planner.gap_limit(i, j, placed[i].resolution + placed[j].resolution)
            if self._motion.get(ids[i]) is self._motion.get(ids[j]):
                return core.box_gap(placed[i].bounds, placed[j].bounds) <= limit
            swept = [self._swept(ids[k], placed[k].bounds) for k in (i, j)]
            return may_meet(swept[0], swept[1], limit)

        return [pair for pair in close_pairs(bodies, planner, self.bounds) if meet(*pair)]

    def bounds(self, body: str, placed: Box) -> Box:
        """The world box of a body over its whole motion, the placement included."""
        return around_both(placed, self._swept(body, placed).over(0.0, 1.0))

    def _swept(self, body: str, placed: Box) -> SweptBoxes:
        if body not in self._boxes:
            motion = self._motion.get(body)
            track = STANDS if motion is None else self._tracks[id(motion)]
            self._boxes[body] = SweptBoxes(placed, track)
        return self._boxes[body]

    def stated(self) -> tuple[StatedMotion, ...]:
        """The motions as a report states them."""
        return tuple(
            convert(
                {
                    "kind": KINDS[type(motion.path)],
                    "bodies": motion.bodies,
                    "clear": motion.clear,
                    **to_builtins(motion.path),
                },
                StatedMotion,
            )
            for motion in self._motions
        )

    def issues(self, bodies: Sequence[str]) -> list[Issue]:
        """Warnings about motions of bodies that do not exist."""
        lost = self._motion.keys() - set(bodies)
        return [
            Issue(
                "unknown-body",
                "warning",
                None,
                None,
                f"a motion names {body!r}, and no body has this id",
            )
            for body in sorted(lost)
        ]


class SweptBoxes:
    """The world boxes of a body over parts of its motion. bounds: of the body as placed. The boxes
    are kept, because many pairs have the same moving body."""

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
    """Return whether the boxes are as close as the limit, at rest or over some part of the motion.

    Two bodies whose boxes over the whole motion overlap are mostly never close at the same time. So
    the motion is halved, again and again, until the boxes over each part are apart.
    """
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
    pad, boxes = track.pad(bounds), []
    for piece in track.pieces:
        if piece.start < end and start < piece.end:
            boxes += _boxes(bounds, piece, max(start, piece.start), min(end, piece.end), pad)
    if not all(math.isfinite(c) for box in boxes for corner in box for c in corner):
        return EVERYWHERE
    return reduce(around_both, boxes)


def _boxes(bounds: Box, piece: Piece, start: float, end: float, pad: float) -> list[Box]:
    """Between two poses a point moves along an arc about the moving centre. Its distance from the
    linear interpolation is at most angle squared / 8 of its radius."""
    length = end - start
    turned = math.radians(abs(piece.degrees)) * (length / (piece.end - piece.start))
    count = min(max(math.ceil(turned / STEP), 1), MOST_POSES)
    radius = max(math.dist(corner, piece.pivot) for corner in corners(bounds))
    angle = min(turned / count, 4.0)  # radians; the error is never more than twice the radius
    grown = radius * angle * angle / 8.0 + pad
    poses = [piece.pose_at(start + length * k / count) for k in range(count + 1)]
    return [_box(bounds, pose, grown) for pose in poses]


def _box(bounds: Box, pose: Transform, grown: float) -> Box:
    low, high = [], []
    for p, q, r, shift in (pose[0:4], pose[4:8], pose[8:12]):
        along = [p * x + q * y + r * z + shift for x, y, z in corners(bounds)]
        low.append(min(along) - grown)
        high.append(max(along) + grown)
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])
