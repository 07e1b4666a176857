"""How far and how fast the bodies of robots travel, relative to each other, while their joints
move.

The displacement bound of Fabian Schwarzer, Mitul Saha, Jean-Claude Latombe, "Adaptive Dynamic
Collision Checking for Single and Multiple Robots in Complex Environments" (2005): a joint that
turns by an angle moves a point by at most the angle times its distance from the axis. Where we
deviate: the distances are those at one moment, plus what the joints nearer to the body add to them.
The joints above both bodies move neither relative to the other.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck import core
from satcheck.audit.body import around_both
from satcheck.audit.motion.moving_pair import Posed
from satcheck.audit.motion.track import ORIGIN, POSE_ROUNDOFFS, RATE_ROUNDOFFS, STANDS, Track
from satcheck.audit.pair import Pair
from satcheck.audit.vectors import added
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.core.transform import Transform, compose
from satcheck.report.sweep import JointPath as StatedPath
from satcheck.report.sweep import JointWaypoint, Place, StatedMotion
from satcheck.scene import Scene
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.robot import Joint, JointPath
from satcheck.scene.robot.kinematics import (
    inverse,
    link_frames,
    motion,
    placements,
    plane_axes,
    poses_of,
    within,
)

if TYPE_CHECKING:
    from satcheck.audit.body import Box
    from satcheck.core.conventions import Vector

Numbers = NDArray[np.float64]
Ball = tuple[tuple[float, float, float], float]

# The rounding of one joint, in roundoffs of the reach of the robot and of its angle: sine and
# cosine 4, the entries of two products of 4x4 matrices 16, a point 16, the value of the joint 4.
JOINT_ROUNDOFFS = 64
# The bound itself is a short sum of products.
_ROUNDED_UP = 1 + 1e-12
# How many numbers of a joint are lengths; the others turn it.
_LENGTHS = {"prismatic": 1, "planar": 2, "floating": 3, "free": 3}
# Moments that are kept, because both bodies of a pair ask about them, and threads at a time.
MOMENTS = 64
# Parts of each piece of the path that get a box of their own.
PARTS = 8


class Moments(Struct, frozen=True):
    """The robots at some moments.

    matrices: shape (moments, bodies, 12). frames: of each robot the poses of its links. axes,
    origins: the axis of each joint that moves, and a point on it, shape (joints, moments, 3).
    rates, slides: how it turns about the axis and how it moves, per unit of t, shapes (joints,
    moments) and (joints, moments, 3). centres: of the balls around bodies, shape (bodies, moments,
    3).
    """

    matrices: Numbers
    frames: Sequence[Mapping[str, Numbers]]
    axes: Numbers
    origins: Numbers
    rates: Numbers
    slides: Numbers
    centres: Numbers
    travel: JointTravel

    def placements(self, bodies: Sequence[str]) -> Numbers:
        """Return the placements of these bodies, shape (moments, bodies, 12)."""
        return self.matrices.take([self.travel.place[body] for body in bodies], axis=1)

    def between(self, half: Numbers, a: str, b: str) -> Numbers:
        """Return an upper bound of how far two bodies move towards each other in a time `half`
        before or after each moment, rounding included."""
        travel = self.travel
        only_a, only_b = travel.relative(a, b)
        speed_a, _ = travel.fastest(self, half, travel.place[a], only_a)
        speed_b, _ = travel.fastest(self, half, travel.place[b], only_b)
        return (speed_a + speed_b) * half * _ROUNDED_UP + 2 * travel.pad


class JointTravel:
    """around: a ball around each body of the scene, see `ball_around`. pad: how far rounding moves
    a point. times: of the poses of the path. place: of each body in the scene. steady: see
    `TrackTravel`."""

    steady = False

    def __init__(self, scene: Scene, path: JointPath, around: Sequence[Ball]) -> None:
        self._scene, self.path, self.times = scene, path, path.times
        self.place = {body.id: k for k, body in enumerate(scene.bodies)}
        self._centres = np.array([centre for centre, _ in around]).reshape(-1, 3)
        self._radii = [radius for _, radius in around]
        self._joints = [
            (number, joint)
            for number, robot in enumerate(scene.robots)
            for joint in robot.robot.joints
            if joint.name in path.moving
        ]
        self._rates = [
            np.diff(path.values[joint.name]) / np.diff(path.times) for _, joint in self._joints
        ]
        self._links = {
            body.id: (number, body.link)
            for number, robot in enumerate(scene.robots)
            for body in robot.bodies
        }
        self._above = self._chains()
        self.at_one = lru_cache(MOMENTS)(lambda t: self.at(np.array([t])))
        self.reach = self._reach()
        self.pad = self._pad()
        self._boxes = self._boxes_of_path()

    def moves(self, a: str, b: str) -> bool:
        """Return whether two bodies move relative to each other."""
        return set(self._above[self.place[a]]) != set(self._above[self.place[b]])

    def bounds(self, body: str, placed: Box) -> Box:
        """The world box of a body over the whole path."""
        return around_both(placed, self._boxes.get(body, placed))

    def relative(self, a: str, b: str) -> tuple[list[int], list[int]]:
        """The joints that move two bodies in the frame that the joints above both carry."""
        of_a, of_b = (self._above[self.place[body]] for body in (a, b))
        return [j for j in of_a if j not in of_b], [j for j in of_b if j not in of_a]

    def ways(self, a: str, b: str) -> tuple[Track | JointWay, Track | JointWay]:
        """The motions of two bodies in that frame."""
        only_a, only_b = self.relative(a, b)
        framed = len(only_a) < len(self._above[self.place[a]])
        way_a, way_b = (
            JointWay(self, body, joints, framed) if self._above[body] else STANDS
            for body, joints in ((self.place[a], only_a), (self.place[b], only_b))
        )
        return way_a, way_b

    def posed(self, pair: Pair, t: float) -> Posed:
        """The pose of both bodies at a time, as a report states it."""
        mover = pair.a if self._above[self.place[pair.a.id]] else pair.b
        place = Place(mover.id, "t", t)
        return Posed((place,), self.path.pose(t), self.path.poses_around(t))

    def stated(self) -> tuple[StatedMotion, ...]:
        """The path as a report states it."""
        moving = [b.id for b, above in zip(self._scene.bodies, self._above, strict=True) if above]
        waypoints = (JointWaypoint(float(t), self.path.pose(t)) for t in self.times)
        return (StatedPath(tuple(moving), False, tuple(waypoints)),) if moving else ()

    def link_pose(self, t: float, body: int) -> Transform:
        """The pose of the link of a body that a joint carries."""
        robot, link = self._links[self._scene.bodies[body].id]
        return (*self.at_one(t).frames[robot][link][:, :, 0].ravel().tolist(), 0.0, 0.0, 0.0, 1.0)

    def at(self, times: Numbers) -> Moments:
        values = self.path.at(times)
        count = len(times)
        frames = link_frames(self._scene, values)
        matrices = placements(self._scene, frames, count)
        pieces = np.clip(np.searchsorted(self.path.times, times, "right") - 1, 0, self._pieces - 1)
        axes, origins, slides = (np.empty((len(self._joints), count, 3)) for _ in range(3))
        rates = np.zeros((len(self._joints), count))
        for j, (number, joint) in enumerate(self._joints):
            before = within(frames[number][joint.parent], poses_of(joint.origin))
            own = within(before, motion(joint, values[joint.name]))
            axis = np.array(joint.axis)
            origins[j] = own[:, 3].T
            axes[j] = own.transpose(2, 0, 1)[..., :3] @ (axis / np.linalg.norm(axis))
            rate, shift = _steady(joint, self._rates[j][:, pieces])
            rates[j] = rate
            slides[j] = np.einsum("ikn,kn->ni", before[:, :3] + np.zeros((1, 1, count)), shift)
        linear = matrices.reshape(count, -1, 3, 4)
        centres = np.einsum("nbij,bj->bni", linear[..., :3], self._centres)
        centres += linear[..., 3].transpose(1, 0, 2)
        return Moments(matrices, frames, axes, origins, rates, slides, centres, self)

    def fastest(
        self, at: Moments, half: Numbers, body: int, joints: Sequence[int]
    ) -> tuple[Numbers, Numbers]:
        """Upper bounds of the speed and the acceleration of all points of a body that these joints
        carry, the nearest first, from a time `half` before each moment until as long after it.

        A joint adds its turning rate times the distance from its axis to the speed. Nearer joints
        add to this distance. The joints above it turn the velocity that it adds, and it turns that
        and the velocities of the joints nearer to the body.
        """
        speed, acceleration = np.zeros(len(half)), np.zeros(len(half))
        for j in joints:
            from_origin, rate = at.centres[body] - at.origins[j], np.abs(at.rates[j])
            along = (from_origin * at.axes[j]).sum(axis=1)[:, None] * at.axes[j]
            slide = np.linalg.norm(at.slides[j], axis=1)
            lever = np.linalg.norm(from_origin - along, axis=1) + self._radii[body]
            own = rate * (lever + (speed + slide) * half) + slide
            acceleration += rate * (own + 2.0 * speed)
            speed += own
        return speed * _ROUNDED_UP, acceleration * _ROUNDED_UP

    def _chains(self) -> list[list[int]]:
        """Of each body the joints that move it, the nearest first."""
        chains: dict[tuple[int, str], list[int]] = {}
        numbers = {(owner, joint.name): k for k, (owner, joint) in enumerate(self._joints)}
        for number, robot in enumerate(self._scene.robots):
            chains |= {(number, link): [] for link in robot.robot.roots}
            for joint in robot.robot.joints:  # parents first
                own = [numbers[number, joint.name]] if (number, joint.name) in numbers else []
                chains[number, joint.child] = [*own, *chains[number, joint.parent]]
        of_body = {id_: chains[link] for id_, link in self._links.items()}
        return [of_body.get(body.id, []) for body in self._scene.bodies]

    def _boxes_of_path(self) -> dict[str, Box]:
        """Boxes around the bodies that move, over the whole path."""
        start, end = self.path.times[:-1, None], self.path.times[1:, None]
        shares = (np.arange(PARTS) + 0.5) / PARTS
        at = self.at((start + (end - start) * shares).ravel())
        half = np.repeat((end - start) * (0.5 / PARTS) * _ROUNDED_UP, PARTS)
        boxes: dict[str, Box] = {}
        for k, body in enumerate(self._scene.bodies):
            if not self._above[k]:
                continue
            speed, _ = self.fastest(at, half, k, self._above[k])
            grown = self._radii[k] + speed * half * _ROUNDED_UP + self.pad
            low = (at.centres[k] - grown[:, None]).min(axis=0)
            high = (at.centres[k] + grown[:, None]).max(axis=0)
            boxes[body.id] = tuple(low.tolist()), tuple(high.tolist())
        return boxes

    @property
    def _pieces(self) -> int:
        return len(self.path.times) - 1

    def _reach(self) -> float:
        """A bound of the coordinates of all joints and moving bodies, and of their sum: no chain is
        longer than all lengths in a robot together."""
        lengths = [0.0]
        for robot in self._scene.robots:
            model = robot.robot
            poses = [pose for joint in model.joints for pose in (joint.origin, joint.child_origin)]
            poses += model.roots.values()
            poses += [link.rest for link in model.links.values() if link.rest is not None]
            poses += [body.offset for body in robot.bodies]
            length = sum(float(np.linalg.norm(pose[3:12:4])) for pose in poses)
            for joint in model.joints:
                numbers = self.path.values.get(joint.name, ())[: _LENGTHS.get(joint.kind, 0)]
                stretch = max(float(np.linalg.norm(joint.axis)), 1.0)
                length += stretch * sum(float(np.abs(own).max()) for own in numbers)
            lengths.append(length)
        at = self.at(np.zeros(1))
        arms = np.linalg.norm(at.centres[:, 0] - at.matrices[0, :, 3::4], axis=1)
        carried = [k for k, above in enumerate(self._above) if above]
        return max(lengths) + 2 * max(
            (self._radii[k] + float(arms[k]) for k in carried), default=0.0
        )

    def _pad(self) -> float:
        angle = 0.0
        for robot in self._scene.robots:
            for joint in robot.robot.joints:
                turns = self.path.values.get(joint.name, ())[_LENGTHS.get(joint.kind, 0) :]
                angle = max([angle, *(float(np.abs(own).max()) for own in turns)])
        depth = max((len(robot.robot.joints) for robot in self._scene.robots), default=0)
        return JOINT_ROUNDOFFS * UNIT_ROUNDOFF * (depth + 1) * (1 + angle) * self.reach


def _steady(joint: Joint, rates: Numbers) -> tuple[Numbers, Numbers]:
    """How a joint turns, and how it slides in its frame before its own motion, shape (3, moments).
    A planar joint turns about where it has slid."""
    if joint.kind == "prismatic":
        return np.zeros_like(rates[0]), np.array(joint.axis)[:, None] * rates[0]
    if joint.kind == "planar":
        x, y = (np.array(axis)[:, None] for axis in plane_axes(joint.axis))
        return rates[2], x * rates[0] + y * rates[1]
    return rates[0], np.zeros((3, len(rates[0])))


class JointWay:
    """The motion of a body on a path of joints, as `Track` is one. At every moment its rates are
    those that the frame above both bodies of a pair sees, in the directions of the world.

    joints: those that carry the body in that frame, the nearest first. framed: that frame moves.
    """

    moves = True

    def __init__(self, travel: JointTravel, body: int, joints: Sequence[int], framed: bool) -> None:
        self._travel, self._body, self._joints, self.framed = travel, body, joints, framed
        self._back = inverse(travel.link_pose(0.0, body))
        self.times: list[float] = travel.path.times.tolist()

    def placement(self, t: float, _: Transform | None) -> Transform:
        """The placement of the body at t."""
        return (*self._travel.at_one(t).matrices[0, self._body].tolist(), 0.0, 0.0, 0.0, 1.0)

    def fastest(self, t: float, _: Box) -> float:
        """An upper bound of the speed of any point of the body in the piece of t."""
        piece = min(int(np.searchsorted(self._travel.times, t, "right")), len(self.times) - 1)
        start, end = self.times[piece - 1], self.times[piece]
        at, half = self._travel.at_one(0.5 * (start + end)), 0.5 * (end - start) * _ROUNDED_UP
        return float(self._travel.fastest(at, np.array([half]), self._body, self._joints)[0][0])

    def velocity(self, t: float) -> Vector | None:
        """Of all points, in the piece of t; None: the body turns."""
        at = self._travel.at_one(t)
        if any(at.rates[j, 0] for j in self._joints):
            return None
        return _vector(sum((at.slides[j, 0] for j in self._joints), np.zeros(3)))

    def pad(self, _: Box) -> float:
        """The largest effect of rounding on a point of the body, and on a gap there."""
        return 3 * self._travel.pad + POSE_ROUNDOFFS * UNIT_ROUNDOFF * self._travel.reach

    def slack(self, t: float, bounds: Box) -> float:
        """The largest effect of rounding on the rate at which a gap closes."""
        rates, reach = self._travel.at_one(t).rates, self._travel.reach
        turned = float(np.abs(rates[self._joints, 0]).sum()) * reach
        share = RATE_ROUNDOFFS * UNIT_ROUNDOFF + self._travel.pad / reach
        return share * (self.fastest(t, bounds) + turned)

    def moving_at(
        self, t: float, span: float, offset: Vector = ORIGIN, frame: Transform = IDENTITY
    ) -> core.Moving:
        """The place and the motion of the body at t, moved by `offset`. Its bounds hold for `span`
        before and after t. frame: places it before the motion."""
        at, joints = self._travel.at_one(t), self._joints
        pose = compose(self._travel.link_pose(t, self._body), self._back)
        if frame != IDENTITY:
            pose = compose(pose, frame)
        a, b, c, x, d, e, f, y, g, h, i, z = pose[:12]
        centre = at.origins[joints[0], 0] if joints else np.zeros(3)
        spin, velocity = np.zeros(3), np.zeros(3)
        for j in joints:
            turn = at.rates[j, 0] * at.axes[j, 0]
            spin += turn
            velocity += at.slides[j, 0] + np.cross(turn, centre - at.origins[j, 0])
        # Joints that slide carry the axis of the nearest one along a line.
        unsteady = (0.0, 0.0)
        if any(at.rates[j, 0] for j in joints[1:]):
            half = np.array([span * _ROUNDED_UP])
            speed, acceleration = self._travel.fastest(at, half, self._body, joints)
            unsteady = float(speed[0]), float(acceleration[0])
        turned, shift = ((a, b, c), (d, e, f), (g, h, i)), added((x, y, z), offset)
        about = added(_vector(centre), offset)
        return core.Moving(turned, shift, about, _vector(velocity), _vector(spin), *unsteady)


def _vector(numbers: Numbers) -> Vector:
    x, y, z = numbers.tolist()
    return x, y, z
