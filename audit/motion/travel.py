"""How far and how fast bodies travel, relative to each other, on tracks and on joints alike.

A joint turns steadily about an axis, whose origin slides steadily. A track is a joint that carries
bodies alone. The displacement bound of Fabian Schwarzer, Mitul Saha, Jean-Claude Latombe, "Adaptive
Dynamic Collision Checking for Single and Multiple Robots in Complex Environments" (2005): a joint
that turns by an angle moves a point by at most the angle times its distance from the axis. Where we
deviate: the distances are those at one moment, plus what the joints nearer to the body add to them.
The joints above both bodies move neither relative to the other.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache, wraps
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from msgspec import Struct
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck import core
from satcheck.audit.body import Box, PlacedBody, around_both, corners
from satcheck.audit.vectors import added
from satcheck.core.conventions import Vector
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.core.transform import Transform, compose
from satcheck.scene.bodies import IDENTITY

if TYPE_CHECKING:
    from satcheck.audit.pair import Pair
    from satcheck.report.sweep import StatedMotion

Numbers = NDArray[np.float64]
Kept = TypeVar("Kept")
Side = tuple[int, Sequence[int]]  # the place of a body, and joints that move it
ORIGIN: Vector = (0.0, 0.0, 0.0)

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
# The least touch band of a sweep, in units of the rounding of a pose.
PADS_IN_BAND = 8
# The bound itself is a short sum of products.
_ROUNDED_UP = 1 + 1e-12
# Moments that are kept, because both bodies of a pair ask about them, and threads at a time.
MOMENTS = 64
# A motion is boxed in this many parts, or in more, up to MOST_PARTS, so that no joint turns by more
# than STEP radians in one of them.
PARTS = 64
MOST_PARTS = 512
STEP = math.pi / 12


class Rates(Struct, frozen=True):
    """How a joint moves at some moments. origin: a point on its axis, shape (moments, 3), like the
    unit axis, and slide, the velocity of the origin. rate: radians per unit of t, right-handed,
    shape (moments,). All in the directions of the world, as the frame that carries the joint sees
    it."""

    axis: Numbers
    origin: Numbers
    rate: Numbers
    slide: Numbers


def kept(make: Callable[[Any, int], Kept]) -> Callable[[Any, int], Kept]:
    """Keep what a method returns for a number as long as its object."""

    @wraps(make)
    def get(self: Any, number: int) -> Kept:
        results = self.__dict__.setdefault(f"_kept_{make.__name__}", {})
        if number not in results:
            results[number] = make(self, number)
        found: Kept = results[number]
        return found

    return get


class Moments(ABC):
    """The bodies of a scene at some moments."""

    def __init__(self, travel: Travel) -> None:
        self._travel = travel

    @abstractmethod
    def joint(self, j: int) -> Rates: ...

    @abstractmethod
    def placement(self, k: int) -> Numbers:
        """Return the placements of a body, shape (3, 4, moments), or (3, 4, 1)."""

    @abstractmethod
    def pose(self, k: int) -> Numbers:
        """Return what takes a body that moves from where the scene places it to where it is, shape
        (3, 4, moments)."""

    @kept
    def centre(self, k: int) -> Numbers:
        """Return the centre of the ball around a body, shape (moments, 3)."""
        pose, (centre, _) = self.pose(k), self._travel.ball(k)
        at: Numbers = np.einsum("ijm,j->mi", pose[:, :3], centre) + pose[:, 3].T
        return at

    def placements(self, ids: Sequence[str], count: int) -> Numbers:
        """Return the placements of these bodies at so many moments, shape (moments, bodies, 12)."""
        matrices = np.empty((count, len(ids), 12))
        for column, id_ in enumerate(ids):
            matrices[:, column] = self.placement(self._travel.place[id_]).reshape(12, -1).T
        return matrices


class Travel(ABC):
    """bodies: all of the scene that can be used; place: their places there. above: of each body the
    joints that move it, the nearest first. times: the ends of the pieces in which all joints move
    steadily. turned: by how many radians a joint turns in all, the one that turns most."""

    def __init__(
        self,
        bodies: Sequence[PlacedBody],
        above: Sequence[Sequence[int]],
        times: Numbers,
        turned: float,
    ) -> None:
        self.bodies, self.above, self.times = bodies, above, times
        self.place = {body.id: k for k, body in enumerate(bodies)}
        self.at_one = lru_cache(MOMENTS)(lambda t: self.at(np.array([t])))
        count = min(max(math.ceil(turned / STEP), PARTS), MOST_PARTS)
        self.part_times = np.union1d(times, np.arange(count + 1) / count)

    @abstractmethod
    def at(self, times: Numbers) -> Moments: ...

    @abstractmethod
    def moved_reach(self, k: int) -> float:
        """Return the reach of a body that moves: a bound of its coordinates, of those of all joints
        above it, and of their sum, world units."""

    @abstractmethod
    def roundoffs(self, k: int) -> float:
        """Return how far rounding moves a point of a body that moves, in roundoffs of its reach,
        beside POSE_ROUNDOFFS."""

    @abstractmethod
    def posed(self, pair: Pair, t: float) -> dict[str, Any]:
        """Return the pose of both bodies at a time, as fields of a `Sweep`: at, joints, poses."""

    @abstractmethod
    def stated(self) -> tuple[StatedMotion, ...]:
        """Return the motions as a report states them."""

    def moves(self, a: str, b: str) -> bool:
        """Return whether two bodies move relative to each other."""
        return set(self.above[self.place[a]]) != set(self.above[self.place[b]])

    def sides(self, pair: Pair) -> tuple[Side, Side]:
        """Return the places of both bodies, each with the joints that move it in the frame that the
        joints above both carry, the nearest first."""
        a, b = self.place[pair.a.id], self.place[pair.b.id]
        of_a, of_b = self.above[a], self.above[b]
        return (a, [j for j in of_a if j not in of_b]), (b, [j for j in of_b if j not in of_a])

    def bounds(self, body: str) -> Box:
        """Return the world box of a body over its whole motion, and as placed."""
        return self.swept(self.place[body]).whole

    def may_meet(self, a: str, b: str, limit: float) -> bool:
        """Return whether two bodies may be as close as the limit, as placed or at some t."""
        one, other = self.swept(self.place[a]), self.swept(self.place[b])
        if not self.moves(a, b):
            return core.box_gap(one.placed, other.placed) <= limit
        return one.may_meet(other, limit)

    def fastest(
        self, at: Moments, half: Numbers, k: int, joints: Sequence[int]
    ) -> tuple[Numbers, Numbers]:
        """Return upper bounds of the speed and the acceleration of all points of a body that these
        joints carry, the nearest first, from a time `half` before each moment until as long after.

        A joint adds its turning rate times the distance from its axis to the speed. Nearer joints
        add to this distance. The joints above it turn the velocity that it adds, and it turns the
        velocities of the joints nearer to the body.
        """
        speed, acceleration = np.zeros(len(half)), np.zeros(len(half))
        for j in joints:
            own = at.joint(j)
            from_origin, rate = at.centre(k) - own.origin, np.abs(own.rate)
            along = (from_origin * own.axis).sum(axis=1)[:, None] * own.axis
            lever = np.linalg.norm(from_origin - along, axis=1) + self.ball(k)[1] + speed * half
            turning = np.where(rate > 0.0, rate * lever, 0.0)
            acceleration += rate * (turning + 2.0 * speed)
            speed += turning + np.linalg.norm(own.slide, axis=1)
        return speed * _ROUNDED_UP, acceleration * _ROUNDED_UP

    def in_piece(self, side: Side, start: float, end: float) -> tuple[float, float]:
        """Return an upper bound of the speed of all points of a body in a piece, and the largest
        effect of rounding on the rate at which a gap closes there."""
        k, joints = side
        at, half = self.at_one(0.5 * (start + end)), 0.5 * (end - start) * _ROUNDED_UP
        with np.errstate(all="ignore"):
            speed = float(self.fastest(at, np.array([half]), k, joints)[0][0])
        reach = self.reach(k)
        if not joints or not reach:
            return speed, 0.0
        turned = sum(abs(float(at.joint(j).rate[0])) for j in joints) * reach
        share = RATE_ROUNDOFFS * UNIT_ROUNDOFF + self.pad(k) / reach
        leg = LEG_ROUNDOFFS * UNIT_ROUNDOFF * reach / (end - start)
        return speed, share * (speed + turned) + leg

    def moved(self, k: int, t: float) -> PlacedBody:
        """Return a body at t. Raises ValueError or OverflowError if it cannot be placed there."""
        body = self.bodies[k]
        if not self.above[k]:
            return body
        transform = transform_of(self.at_one(t).placement(k))
        return PlacedBody(replace(body.body, transform=transform), body.shared)

    def moving(
        self, side: Side, t: float, span: float, offset: Vector, frame: Transform
    ) -> core.Moving:
        """Return the place and the motion of a body at t, moved by `offset`. Its bounds hold for
        `span` before and after t. frame: places it before the motion."""
        (k, joints), at = side, self.at_one(t)
        pose = transform_of(at.pose(k)) if self.above[k] else IDENTITY
        if frame != IDENTITY:
            pose = compose(pose, frame)
        a, b, c, x, d, e, f, y, g, h, i, z = pose[:12]
        rates = [at.joint(j) for j in joints]
        centre = rates[0].origin[0] if rates else np.zeros(3)
        spin, velocity = np.zeros(3), np.zeros(3)
        for own in rates:
            turn = own.rate[0] * own.axis[0]
            spin += turn
            velocity += own.slide[0]
            if own is not rates[0]:
                velocity += np.cross(turn, centre - own.origin[0])
        # Joints that slide carry the axis of the nearest one along a line.
        unsteady = (0.0, 0.0)
        if any(own.rate[0] for own in rates[1:]):
            speed, acceleration = self.fastest(at, np.array([span * _ROUNDED_UP]), k, joints)
            unsteady = float(speed[0]), float(acceleration[0])
        turned, shift = ((a, b, c), (d, e, f), (g, h, i)), added((x, y, z), offset)
        about = added(_vector(centre), offset)
        return core.Moving(turned, shift, about, _vector(velocity), _vector(spin), *unsteady)

    def between(self, at: Moments, half: Numbers, pair: Pair) -> Numbers:
        """Return an upper bound of how far two bodies move towards each other in a time `half`
        before or after each moment, rounding included."""
        way = np.zeros(len(half))
        with np.errstate(all="ignore"):  # beyond float64 nothing is proven
            for k, joints in self.sides(pair):
                way += self.fastest(at, half, k, joints)[0] * half * _ROUNDED_UP
                way += 2 * self.pad(k)
        return way

    @kept
    def reach(self, k: int) -> float:
        """See `moved_reach`."""
        if self.above[k]:
            return self.moved_reach(k)
        farthest = max(math.hypot(*corner) for corner in corners(self.bodies[k].bounds))
        return farthest * (1 + 8 * UNIT_ROUNDOFF)

    @kept
    def pad(self, k: int) -> float:
        """Return the largest effect of rounding on a point of a body, and on a gap there."""
        body, moves = self.bodies[k], bool(self.above[k])
        share = (POSE_ROUNDOFFS + (self.roundoffs(k) if moves else 0.0)) * UNIT_ROUNDOFF
        curve = 0.0 if body.curved is None else body.curved.slack
        return share * self.reach(k) + curve + (_placing(body) if moves else 0.0)

    def band(self, pair: Pair) -> float:
        """Return the touch band of a sweep: half its width, at least the rounding of poses."""
        pads = sum(self.pad(self.place[body.id]) for body in (pair.a, pair.b))
        return max(pair.tolerance, PADS_IN_BAND * pads)

    @kept
    def ball(self, k: int) -> tuple[Numbers, float]:
        """Return a ball around a body as placed: its centre and its radius."""
        low, high = np.array(self.bodies[k].bounds)
        return 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low)) * _ROUNDED_UP

    @cached_property
    def _at_ends(self) -> Moments:
        return self.at(self.part_times)

    @kept
    def swept(self, k: int) -> SweptBoxes:
        """Return the boxes of a body over the parts of its motion."""
        placed = self.bodies[k].bounds
        if not self.above[k]:
            return SweptBoxes(placed, *(np.array([corner]) for corner in placed))
        length = np.append(np.diff(self.part_times), 0.0) * _ROUNDED_UP  # of the part that begins
        with np.errstate(all="ignore"):
            pose = self._at_ends.pose(k)
            ends = np.einsum("ijm,cj->mci", pose[:, :3], np.array(corners(placed)))
            ends += pose[:, 3].T[:, None]
            low, high = ends.min(axis=1), ends.max(axis=1)
            speed, acceleration = self.fastest(self._at_ends, length, k, self.above[k])
            # How far a point gets from the line between its places at both ends.
            bend = np.minimum(acceleration * length / 8.0, speed / 2.0) * length
            grown = (bend[:-1] + self.pad(k))[:, None]
            low = np.minimum(low[:-1], low[1:]) - grown
            high = np.maximum(high[:-1], high[1:]) + grown
        beyond = ~(np.isfinite(low) & np.isfinite(high)).all(axis=1)
        low[beyond], high[beyond] = -math.inf, math.inf
        return SweptBoxes(placed, low, high)


class SweptBoxes(Struct):
    """The world boxes of a body over the parts of its motion. low, high: shape (parts, 3), or
    (1, 3) of a body that stands. placed: its box as placed."""

    placed: Box
    low: Numbers
    high: Numbers

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


def _placing(body: PlacedBody) -> float:
    """Return how far the rounding of a placement matrix may move a point of the body, world units.
    It depends on the coordinates in the file, which may be far larger than those in the world."""
    transform = body.body.transform
    if transform is None:
        return 0.0
    reach = 3 * body.largest_stretch * body.shared.largest + math.hypot(*transform[3:12:4])
    return PLACING_ROUNDOFFS * UNIT_ROUNDOFF * reach


def transform_of(pose: Numbers) -> Transform:
    """Return the only one of some poses."""
    return (*pose.ravel().tolist(), 0.0, 0.0, 0.0, 1.0)


def _vector(numbers: Numbers) -> Vector:
    x, y, z = numbers.tolist()
    return x, y, z
