"""How bodies travel along the motions of a scene."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

import numpy as np
from msgspec import Struct, convert, to_builtins
from numpy.typing import NDArray

from satcheck import core
from satcheck.audit.body import Box, PlacedBody, around_both, corners
from satcheck.audit.motion.moving_pair import Posed, rounding_of
from satcheck.audit.motion.track import STANDS, Track, track_of
from satcheck.audit.pair import Pair
from satcheck.report.sweep import Place, StatedMotion
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.motion import Motion, Path, PosePath, Rotation, Translation

Numbers = NDArray[np.float64]
# How a report calls the kinds of paths.
KINDS = {Translation: "translation", Rotation: "rotation", PosePath: "path"}
# A bound of a way is a short sum of products.
_ROUNDED_UP = 1 + 1e-12
# A motion is boxed in this many parts, or in more, up to MOST_PARTS, so that no body turns by more
# than STEP radians in one of them.
PARTS = 64
MOST_PARTS = 512
STEP = math.pi / 12


class TrackTravel:
    """bodies: all of the scene that can be used, by id. times: the ends of the pieces of all
    motions. steady: bodies move steadily in each piece."""

    steady = True

    def __init__(self, motions: Sequence[Motion], bodies: Sequence[PlacedBody]) -> None:
        self._motions = tuple(motions)
        self._motion = {body: motion for motion in motions for body in motion.bodies}
        self._tracks = {id(motion): track_of(motion.path) for motion in motions}
        self.bodies = {body.id: body for body in bodies}
        tracks = self._tracks.values()
        self.times = np.array(sorted({time for track in tracks for time in track.times}))
        times = part_times(tracks)
        self._parts = {key: parts_of(track, times) for key, track in self._tracks.items()}
        self._boxes: dict[str, SweptBoxes] = {}  # of bodies in pairs; many pairs have the same one

    def moves(self, a: str, b: str) -> bool:
        """Return whether two bodies move relative to each other."""
        return self._motion.get(a) is not self._motion.get(b)

    def bounds(self, body: str, placed: Box) -> Box:
        """The world box of a body over its whole motion, the placement included."""
        return self._swept(body, placed).whole

    def may_meet(self, a: PlacedBody, b: PlacedBody, limit: float) -> bool:
        """Return whether two bodies may be as close as the limit, as placed or at some t."""
        if not self.moves(a.id, b.id):
            return core.box_gap(a.bounds, b.bounds) <= limit
        for body in (a, b):
            if body.id not in self._boxes:
                self._boxes[body.id] = self._swept(body.id, body.bounds)
        return self._boxes[a.id].may_meet(self._boxes[b.id], limit)

    def _swept(self, body: str, placed: Box) -> SweptBoxes:
        motion = self._motion.get(body)
        return SweptBoxes(placed, None if motion is None else self._parts[id(motion)])

    def at(self, times: Numbers) -> TrackMoments:
        return TrackMoments(self, times)

    def ways(self, a: str, b: str) -> tuple[Track, Track]:
        return self.track(a), self.track(b)

    def posed(self, pair: Pair, t: float) -> Posed:
        """The pose of both bodies at a time, as a report states it."""
        motions = ((body.id, self._motion.get(body.id)) for body in (pair.a, pair.b))
        return Posed(tuple(_place(id_, m.path, t) for id_, m in motions if m is not None))

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

    def track(self, body: str) -> Track:
        motion = self._motion.get(body)
        return STANDS if motion is None else self._tracks[id(motion)]


class TrackMoments(Struct, frozen=True):
    """Bodies on their tracks at some times."""

    travel: TrackTravel
    times: Numbers

    def placements(self, bodies: Sequence[str]) -> Numbers:
        """Return the placements of these bodies, shape (times, bodies, 12)."""
        travel, times = self.travel, self.times
        matrices = np.empty((len(times), len(bodies), 3, 4))
        for k, body in enumerate(bodies):
            placed = np.array(travel.bodies[body].body.transform or IDENTITY).reshape(4, 4)
            rows = [travel.track(body).pose_at(t)[:12] for t in times.tolist()]
            matrices[:, k] = np.array(rows).reshape(-1, 3, 4) @ placed
        return matrices.reshape(len(times), len(bodies), 12)

    def between(self, half: Numbers, a: str, b: str) -> Numbers:
        """Return an upper bound of how far two bodies move towards each other in a time `half`
        before or after each of these times, rounding included."""
        travel, times = self.travel, self.times
        way = np.zeros(len(times))
        for body, track in ((travel.bodies[id_], travel.track(id_)) for id_ in (a, b)):
            speeds = np.array([piece.speed(body.bounds) for piece in track.pieces])
            with np.errstate(all="ignore"):  # beyond float64 nothing is proven
                way += speeds[np.searchsorted(track.times, times, "right") - 1] * half * _ROUNDED_UP
            way += 2 * rounding_of(body, track)
        return way


class Parts(Struct, frozen=True):
    """A motion between some times. poses: at the times, (n, 3, 4).
    pivots: of each part, (n - 1, 3). bends: how far a point gets from the line between its places
    at both ends of a part, as a share of its distance from the pivot, (n - 1)."""

    track: Track
    poses: Numbers
    pivots: Numbers
    bends: Numbers


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


def _place(body: str, path: Path, t: float) -> Place:
    if isinstance(path, Rotation):
        return Place(body, "degrees", path.degrees * t)
    if isinstance(path, Translation):
        return Place(body, "length", math.hypot(*path.vector) * t)
    return Place(body, "t", t)
