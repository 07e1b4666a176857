"""How bodies travel along the motions of a scene."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from msgspec import convert, to_builtins
from numpy.typing import NDArray

from satcheck import core
from satcheck.audit.body import Box, PlacedBody
from satcheck.audit.motion.moving_pair import Posed, rounding_of
from satcheck.audit.motion.swept_boxes import SweptBoxes, part_times, parts_of
from satcheck.audit.motion.track import STANDS, Track, track_of
from satcheck.audit.pair import Pair
from satcheck.report.motions import StatedMotion
from satcheck.report.sweep import Place
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.motion import Motion, Path, PosePath, Rotation, Translation

Numbers = NDArray[np.float64]
# How a report calls the kinds of paths.
KINDS = {Translation: "translation", Rotation: "rotation", PosePath: "path"}
# A bound of a way is a short sum of products.
_ROUNDED_UP = 1 + 1e-12


class TrackTravel:
    """bodies: all of the scene that can be used. times: the ends of the pieces of all motions.
    steady: bodies move steadily in each piece."""

    steady = True

    def __init__(self, motions: Sequence[Motion], bodies: Sequence[PlacedBody]) -> None:
        self._motions = tuple(motions)
        self._motion = {body: motion for motion in motions for body in motion.bodies}
        self._tracks = {id(motion): track_of(motion.path) for motion in motions}
        self._bodies = {body.id: body for body in bodies}
        tracks = self._tracks.values()
        self.times = np.array(sorted({time for track in tracks for time in track.times}))
        times = part_times(tracks)
        self._parts = {key: parts_of(track, times) for key, track in self._tracks.items()}
        self._speeds: dict[str, tuple[Numbers, float]] = {}
        self._boxes: dict[str, SweptBoxes] = {}  # of bodies in pairs; many pairs have the same one

    def moves(self, a: str, b: str) -> bool:
        """Return whether two bodies move relative to each other."""
        return self._motion.get(a) is not self._motion.get(b)

    def is_clear(self, a: str, b: str) -> bool:
        """Return whether the way of one of them must be free of touches."""
        motions = self._motion.get(a), self._motion.get(b)
        return any(motion is not None and motion.clear for motion in motions)

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

    def at(self, times: Numbers) -> Numbers:
        """What the two following functions need of these times."""
        return times

    def matrices(self, at: Numbers, bodies: Sequence[str]) -> Numbers:
        """The placements of these bodies, shape (times, bodies, 12)."""
        poses: dict[int, Numbers] = {}
        matrices = np.empty((len(at), len(bodies), 3, 4))
        for k, body in enumerate(bodies):
            placed = np.array(self._bodies[body].body.transform or IDENTITY).reshape(4, 4)
            motion = self._motion.get(body)
            if motion is None:
                matrices[:, k] = placed[:3]
                continue
            if id(motion) not in poses:
                rows = [self._track(body).pose_at(t)[:12] for t in at.tolist()]
                poses[id(motion)] = np.array(rows).reshape(-1, 3, 4)
            matrices[:, k] = poses[id(motion)] @ placed
        return matrices.reshape(len(at), len(bodies), 12)

    def between(self, at: Numbers, half: Numbers, a: str, b: str) -> Numbers:
        """An upper bound of how far two bodies move towards each other in a time `half` before or
        after each of these times."""
        way = np.zeros(len(at))
        for body in (a, b):
            pieces = np.searchsorted(self._track(body).times, at, "right") - 1
            with np.errstate(all="ignore"):  # beyond float64 nothing is proven
                way += self._bounded(body)[0][pieces] * half
        return way * _ROUNDED_UP

    def rounding(self, a: str, b: str) -> float:
        """How far rounding moves a point of one body towards the other."""
        return self._bounded(a)[1] + self._bounded(b)[1]

    def _bounded(self, id_: str) -> tuple[Numbers, float]:
        """The speed of a body in each piece of its motion, and how far rounding moves a point."""
        if id_ not in self._speeds:
            body, track = self._bodies[id_], self._track(id_)
            speeds = np.array([piece.speed(body.bounds) for piece in track.pieces])
            self._speeds[id_] = speeds, rounding_of(body, track)
        return self._speeds[id_]

    def ways(self, a: str, b: str) -> tuple[Track, Track]:
        return self._track(a), self._track(b)

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

    def _track(self, body: str) -> Track:
        motion = self._motion.get(body)
        return STANDS if motion is None else self._tracks[id(motion)]


def _place(body: str, path: Path, t: float) -> Place:
    if isinstance(path, Rotation):
        return Place(body, "degrees", path.degrees * t)
    if isinstance(path, Translation):
        return Place(body, "length", math.hypot(*path.vector) * t)
    return Place(body, "t", t)
