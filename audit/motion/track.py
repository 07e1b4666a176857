"""A motion as pieces of steady motion, as the bounds of the core need it.

On every piece M(t) x = centre(t) + turn(t) (x - pivot): the centre moves with one velocity, and the
body turns about one axis through it with one angular velocity. Every translation, every rotation,
and every leg of a path of poses is one piece.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from itertools import pairwise
from typing import ClassVar

from msgspec import Struct

from satcheck import core
from satcheck.audit.body import Box, corners
from satcheck.audit.vectors import added, crossed, dot
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
)
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.motion import Path, Translation
from satcheck.scene.motion import Rotation as RotatingPath

ORIGIN: Vector = (0.0, 0.0, 0.0)
STILL: Rotation = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)

# Rounding errors, in roundoffs of the reach of a body. The reach is the sum of three distances: of
# its farthest point from the pivot, of the pivot from the origin, and of the centre from the
# origin. A pose: the sine and cosine have an error of 4, the axis 4, each of the nine products of a
# rotation 8 (twice on a leg of a path), the centre 8, the product with a point 16: below 128 in
# sum. The relative error 4 of the angle is also an error of the rotation. The arithmetic of a gap
# along an axis, on three coordinates, adds less than 128.
POSE_ROUNDOFFS = 256
# A pose and a placement, multiplied into one matrix. Each entry is a rounded sum of up to four
# rounded products: its error is below 8 roundoffs of the lengths in it. Applied to the three
# coordinates of a point of the file, the error is below 16 roundoffs of the terms that the
# placement adds up.
PLACING_ROUNDOFFS = 16
# The rate at which a gap closes: the axis has an error of 4, the angular velocity 8, products and
# sums of three coordinates 16 each. The change of the rate by rotation adds as much again.
# A body at rest may be seen as turning, relative to the other body (core/native/motion/moving.hpp,
# Views). Its rate then has an error of 8 roundoffs of spin times reach, and its own speed is 0 and
# adds nothing to the slack. The pads cover this error. With bend = spin * steady, a gap is at least
# gap - rate s - bend s^2 / 2, and at least gap - steady s. The first bound is greater only if
# bend s / 2 < steady - rate <= 2 steady, within 4 radians. The error is then below 32 roundoffs of
# the reach, and a body without a pose has 128 to spare. The second bound has no difference of large
# terms: its error is some roundoffs of the decrease of the gap.
RATE_ROUNDOFFS = 128
# The error of the rotation between two orientations, in roundoffs; also for small rotations.
LEG_ROUNDOFFS = 16


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

    @property
    def spin(self) -> Vector:
        rate = math.radians(self.degrees) / (self.end - self.start)
        return self.axis[0] * rate, self.axis[1] * rate, self.axis[2] * rate

    def radius(self, bounds: Box) -> float:
        """The distance of the farthest corner from the pivot, rounded."""
        return max(math.dist(corner, self.pivot) for corner in corners(bounds))

    def reach(self, bounds: Box) -> float:
        """A bound of the coordinates of the body, its pivot and its centre, and of their sum, world
        units. bounds: of the body as placed."""
        farthest = max(math.hypot(*end) for end in (self.centre, self.centre_at(self.end)))
        return (self.radius(bounds) + math.hypot(*self.pivot) + farthest) * (1 + 8 * UNIT_ROUNDOFF)

    def speed(self, bounds: Box) -> float:
        """An upper bound of the speed of any point of the body, world units per unit of t."""
        return math.hypot(*self.velocity) + math.hypot(*self.spin) * self.radius(bounds)

    def fastest(self, bounds: Box) -> float:
        """One that also bounds what rounds with the coordinates."""
        return math.hypot(*self.velocity) + math.hypot(*self.spin) * self.reach(bounds)

    def slack(self, bounds: Box) -> float:
        """The largest effect of rounding on the rate at which a gap closes, world units per unit of
        t."""
        leg = LEG_ROUNDOFFS * self.reach(bounds) / (self.end - self.start)
        return (RATE_ROUNDOFFS * self.fastest(bounds) + leg) * UNIT_ROUNDOFF


class Track(Struct, frozen=True):
    """The pieces of a motion, without gaps from t = 0 to t = 1."""

    pieces: tuple[Piece, ...]
    framed: ClassVar[bool] = False  # the world is the frame of its rates

    @property
    def moves(self) -> bool:
        return self != STANDS

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

    def placement(self, t: float, transform: Transform | None) -> Transform:
        """The placement at t of a body with this one before the motion."""
        return compose(self.pose_at(t), transform or IDENTITY)

    def fastest(self, t: float, bounds: Box) -> float:
        """An upper bound of the speed of any point of the body in the piece of t."""
        return self.piece_at(t).fastest(bounds)

    def slack(self, t: float, bounds: Box) -> float:
        """The largest effect of rounding on the rate at which a gap closes."""
        return self.piece_at(t).slack(bounds)

    def velocity(self, t: float) -> Vector | None:
        """Of all points, in the piece of t; None: the body turns."""
        piece = self.piece_at(t)
        return None if piece.degrees else piece.velocity

    def moving_at(
        self, t: float, _: float = 0.0, offset: Vector = ORIGIN, frame: Transform = IDENTITY
    ) -> core.Moving:
        """The place and the motion of the body at t, moved by `offset`. frame: places it before the
        motion."""
        piece = self.piece_at(t)
        pose = piece.pose_at(t)
        if frame != IDENTITY:
            pose = compose(pose, frame)
        a, b, c, x, d, e, f, y, g, h, i, z = pose[:12]
        turn, shift = ((a, b, c), (d, e, f), (g, h, i)), added((x, y, z), offset)
        centre = added(piece.centre_at(t), offset)
        return core.Moving(turn, shift, centre, piece.velocity, piece.spin)

    def pad(self, bounds: Box) -> float:
        """The largest effect of rounding on a point of the body, and on a gap there, world units.
        bounds: of the body as placed."""
        turned = math.radians(max(abs(piece.degrees) for piece in self.pieces))
        reach = max(piece.reach(bounds) for piece in self.pieces)
        return (POSE_ROUNDOFFS + 4 * turned) * UNIT_ROUNDOFF * reach


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


STANDS = Track((Piece(0.0, 1.0),))
