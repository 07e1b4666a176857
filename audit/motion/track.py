"""Motions of a scene as tracks: pieces of steady motion, as the bounds of the core need it.

On every piece M(t) x = centre(t) + turn(t) (x - pivot): the centre moves with one velocity, and the
body turns about one axis through it with one angular velocity. Every translation, every rotation,
and every leg of a path of poses is one piece.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from msgspec import Struct, convert, to_builtins

from satcheck.audit.body import Box, PlacedBody, corners
from satcheck.audit.motion.travel import ORIGIN, Moments, Numbers, Rates, Travel, kept
from satcheck.audit.pair import Pair
from satcheck.audit.vectors import crossed, dot
from satcheck.core.conventions import Vector
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.core.transform import (
    Quaternion,
    Rotation,
    Transform,
    about,
    compose,
    cos_sin,
    placed,
    quaternion_matrix,
    within,
)
from satcheck.report.sweep import Place, StatedMotion
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.motion import Motion, Path, PosePath, Translation
from satcheck.scene.motion import Rotation as RotatingPath

STILL: Rotation = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
# How a report calls the kinds of paths.
KINDS = {Translation: "translation", RotatingPath: "rotation", PosePath: "path"}


class Piece(Struct, frozen=True):
    """start <= t <= end. centre: at start; velocity: per unit of t. turn: at start. axis, degrees:
    the rotation until the end, about the centre, world. pivot: the point of the body at the
    centre."""

    start: float
    end: float
    pivot: Vector = ORIGIN
    centre: Vector = ORIGIN
    velocity: Vector = ORIGIN
    turn: Rotation = STILL
    axis: Vector = (1.0, 0.0, 0.0)
    degrees: float = 0.0

    def centre_at(self, t: float) -> Vector:
        return tuple(  # type: ignore[return-value]
            c + v * (t - self.start) for c, v in zip(self.centre, self.velocity, strict=True)
        )

    def pose_at(self, t: float) -> Transform:
        """M(t)."""
        x, y, z = self.pivot
        share = (t - self.start) / (self.end - self.start)
        turned = about(self.axis, cos_sin(self.degrees * share)) if self.degrees else STILL
        pose = placed(turned, self.centre_at(t))
        if self.turn != STILL:
            pose = compose(pose, placed(self.turn, ORIGIN))
        return pose if self.pivot == ORIGIN else compose(pose, placed(STILL, (-x, -y, -z)))

    def reach(self, bounds: Box) -> float:
        """A bound of the coordinates of the body, its pivot and its centre, and of their sum, world
        units. bounds: of the body as placed."""
        radius = max(math.dist(corner, self.pivot) for corner in corners(bounds))
        farthest = max(math.hypot(*end) for end in (self.centre, self.centre_at(self.end)))
        return (radius + math.hypot(*self.pivot) + farthest) * (1 + 8 * UNIT_ROUNDOFF)


class Track(Struct, frozen=True):
    """The pieces of a motion, without gaps from t = 0 to t = 1."""

    pieces: tuple[Piece, ...]

    @property
    def times(self) -> list[float]:
        return [piece.start for piece in self.pieces] + [1.0]

    def piece_at(self, t: float) -> Piece:
        """The piece that contains t. If two pieces meet at t, the later one."""
        starts = [piece.start for piece in self.pieces]
        return self.pieces[bisect_right(starts, t) - 1]

    def pose_at(self, t: float) -> Transform:
        """M(t)."""
        return self.piece_at(t).pose_at(t)

    def turned(self, summed: Callable[[Iterable[float]], float]) -> float:
        """Return the sum, or the largest, of the turns of all pieces, radians."""
        return math.radians(summed(abs(piece.degrees) for piece in self.pieces))


class TrackTravel(Travel):
    """Bodies on the motions of a scene: each motion is a joint that carries its bodies alone."""

    def __init__(self, motions: Sequence[Motion], bodies: Sequence[PlacedBody]) -> None:
        self._motions = tuple(motions)
        self.tracks = [track_of(motion.path) for motion in motions]
        number = {body: j for j, motion in enumerate(motions) for body in motion.bodies}
        above = [[number[body.id]] if body.id in number else [] for body in bodies]
        times = np.array(sorted({time for track in self.tracks for time in track.times}))
        super().__init__(bodies, above, times, max(track.turned(sum) for track in self.tracks))

    def at(self, times: Numbers) -> TrackMoments:
        return TrackMoments(self, times)

    def moved_reach(self, k: int) -> float:
        pieces = self.tracks[self.above[k][0]].pieces
        return max(piece.reach(self.bodies[k].bounds) for piece in pieces)

    def roundoffs(self, k: int) -> float:
        return 4 * self.tracks[self.above[k][0]].turned(max)

    def posed(self, pair: Pair, t: float) -> dict[str, Any]:
        both = ((body.id, self.above[self.place[body.id]]) for body in (pair.a, pair.b))
        return {
            "at": tuple(_place(id_, self._motions[j].path, t) for id_, own in both for j in own)
        }

    def stated(self) -> tuple[StatedMotion, ...]:
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


class TrackMoments(Moments):
    """Bodies on their tracks at some times."""

    def __init__(self, travel: TrackTravel, times: Numbers) -> None:
        super().__init__(travel)
        self._above, self._bodies, self._tracks = travel.above, travel.bodies, travel.tracks
        self._times: list[float] = times.tolist()

    @kept
    def joint(self, j: int) -> Rates:
        pieces, times = self._tracks[j].pieces, np.array(self._times)
        at = np.searchsorted([piece.start for piece in pieces], times, "right") - 1
        axes, centres, slides = (
            np.array(own)[at]
            for own in zip(*((p.axis, p.centre, p.velocity) for p in pieces), strict=True)
        )
        starts = np.array([piece.start for piece in pieces])[at]
        rates = np.array([math.radians(p.degrees) / (p.end - p.start) for p in pieces])[at]
        with np.errstate(all="ignore"):  # beyond float64 nothing is proven
            return Rates(axes, centres + slides * (times - starts)[:, None], rates, slides)

    @kept
    def placement(self, k: int) -> Numbers:
        transform = self._bodies[k].body.transform or IDENTITY
        placed = np.array(transform[:12]).reshape(3, 4, 1)
        return within(self.pose(k), placed) if self._above[k] else placed

    def pose(self, k: int) -> Numbers:
        return self._moved(self._above[k][0])

    @kept
    def _moved(self, j: int) -> Numbers:
        rows = [self._tracks[j].pose_at(t)[:12] for t in self._times]
        return np.array(rows).T.reshape(3, 4, -1)


def _place(body: str, path: Path, t: float) -> Place:
    if isinstance(path, RotatingPath):
        return Place(body, "degrees", path.degrees * t)
    if isinstance(path, Translation):
        return Place(body, "length", math.hypot(*path.vector) * t)
    return Place(body, "t", t)


def track_of(path: Path) -> Track:
    if isinstance(path, Translation):
        return Track((Piece(0.0, 1.0, velocity=path.vector),))
    if isinstance(path, RotatingPath):
        x, y, z = unit(path.axis)
        piece = Piece(0.0, 1.0, path.point, path.point, axis=(x, y, z), degrees=path.degrees)
        return Track((piece,))
    pieces = []
    for here, there in pairwise(path.waypoints):
        axis, degrees = between(here.orientation, there.orientation)
        length = there.time - here.time
        steps = (q - p for p, q in zip(here.position, there.position, strict=True))
        x, y, z = (step / length for step in steps)
        turn = quaternion_matrix(*here.orientation)
        pieces.append(
            Piece(
                here.time,
                there.time,
                centre=here.position,
                velocity=(x, y, z),
                turn=turn,
                axis=axis,
                degrees=degrees,
            )
        )
    return Track(tuple(pieces))


def between(start: Quaternion, end: Quaternion) -> tuple[Vector, float]:
    """Unit axis (world) and degrees, 0 to 180, of the shortest turn from one orientation to the
    other; both of any length except 0. For half a turn the signs of the quaternions choose the
    axis."""
    px, py, pz, pw = unit(start)
    qx, qy, qz, qw = unit(end)
    p, q = (px, py, pz), (qx, qy, qz)
    # The Hamilton product of the end and the inverse of the start.
    cosine = pw * qw + dot(p, q)
    sign = -1.0 if cosine < 0.0 else 1.0
    turned = zip(p, q, crossed(p, q), strict=True)
    across = [sign * (pw * b - qw * a + c) for a, b, c in turned]
    if not any(across):
        return (1.0, 0.0, 0.0), 0.0
    x, y, z = unit(across)
    return (x, y, z), math.degrees(2.0 * math.atan2(math.hypot(*across), abs(cosine)))


def unit(v: Sequence[float]) -> tuple[float, ...]:
    """The unit vector along v, which is not zero; safe for very large and very small v."""
    largest = max(map(abs, v))
    small = [c / largest for c in v]
    length = math.hypot(*small)
    return tuple(c / length for c in small)
