"""The moving bodies of a scene, the pairs to sweep, and the boxes around their motions."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from functools import partial

import numpy as np
from msgspec import Struct, convert, to_builtins
from numpy.typing import NDArray

from satcheck import core
from satcheck.audit.bodies import PlacedBodies
from satcheck.audit.body import Box, around_both, corners
from satcheck.audit.close_pairs import ClosePairs
from satcheck.audit.motion.sweep import sweep
from satcheck.audit.motion.track import Track, track_of
from satcheck.audit.pair import Moves
from satcheck.audit.planner import Planner
from satcheck.report.motions import StatedMotion
from satcheck.report.report import Issue
from satcheck.scene.motion import Motion, PosePath, Rotation, Translation

Floats = NDArray[np.float64]
# How a report calls the kinds of paths.
KINDS = {Translation: "translation", Rotation: "rotation", PosePath: "path"}


# A motion is boxed in this many parts, or in more, up to MOST_PARTS, so that no body turns by more
# than STEP radians in one of them.
PARTS = 64
MOST_PARTS = 512
STEP = math.pi / 12


class Movers:
    def __init__(self, motions: Sequence[Motion]) -> None:
        self._motions = tuple(motions)
        self._motion = {body: motion for motion in motions for body in motion.bodies}
        tracks = {id(motion): track_of(motion.path) for motion in motions}
        times = part_times(tracks.values())
        self._parts = {key: parts_of(track, times) for key, track in tracks.items()}

    def moves(self, a: str, b: str) -> Moves | None:
        """None: the bodies do not move relative to each other."""
        motion_a, motion_b = self._motion.get(a), self._motion.get(b)
        if motion_a is motion_b:
            return None
        motions = (motion_a, motion_b)
        path_a, path_b = (None if motion is None else motion.path for motion in motions)
        swept = partial(sweep, path_a=path_a, path_b=path_b)
        return Moves(swept, any(motion and motion.clear for motion in motions))

    def close(self, bodies: PlacedBodies, planner: Planner) -> ClosePairs:
        """The pairs that may be as close as they ask, as placed or at some t."""
        placed, ids = bodies.placed, bodies.ids
        boxes: dict[int, SweptBoxes] = {}  # of bodies in pairs; many pairs have the same one

        def boxes_of(k: int) -> SweptBoxes:
            if k not in boxes:
                boxes[k] = SweptBoxes(placed[k].bounds, self._parts_of(ids[k]))
            return boxes[k]

        def meet(i: int, j: int) -> bool:
            limit = planner.gap_limit(i, j, placed[i].resolution + placed[j].resolution)
            if self._motion.get(ids[i]) is self._motion.get(ids[j]):
                return core.box_gap(placed[i].bounds, placed[j].bounds) <= limit
            return boxes_of(i).may_meet(boxes_of(j), limit)

        return ClosePairs(bodies, planner, self.bounds, meet)

    def bounds(self, body: str, placed: Box) -> Box:
        """The world box of a body over its whole motion, the placement included."""
        return SweptBoxes(placed, self._parts_of(body)).whole

    def _parts_of(self, body: str) -> Parts | None:
        motion = self._motion.get(body)
        return None if motion is None else self._parts[id(motion)]

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
