"""Bodies of robots on a path of joints."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from satcheck.audit.body import PlacedBody
from satcheck.audit.motion.travel import (
    Moments,
    Numbers,
    Rates,
    Travel,
    kept,
    transform_of,
)
from satcheck.audit.pair import Pair
from satcheck.core.transform import within
from satcheck.report.sweep import JointPath as StatedPath
from satcheck.report.sweep import JointWaypoint, Place, StatedMotion
from satcheck.scene import Scene
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.robot import Joint, JointPath
from satcheck.scene.robot.kinematics import (
    inverse,
    link_frames,
    motion,
    plane_axes,
    poses_of,
)

# The rounding of one joint, in roundoffs of the reach of the robot and of its angle: sine and
# cosine 4, the entries of two products of 4x4 matrices 16, a point 16, the value of the joint 4.
JOINT_ROUNDOFFS = 64
# How many numbers of a joint are lengths; the others turn it.
_LENGTHS = {"prismatic": 1, "planar": 2, "floating": 3, "free": 3}


class JointTravel(Travel):
    """The bodies of a scene on a path of its joints. scene: with these bodies."""

    def __init__(self, scene: Scene, path: JointPath, bodies: Sequence[PlacedBody]) -> None:
        self.scene, self.path = scene, path
        self.joints = [
            (number, joint)
            for number, robot in enumerate(scene.robots)
            for joint in robot.robot.joints
            if joint.name in path.moving
        ]
        self.rates = [
            np.diff(path.values[joint.name]) / np.diff(path.times) for _, joint in self.joints
        ]
        self.carried = {
            body.id: (number, body.link, poses_of(body.offset))
            for number, robot in enumerate(scene.robots)
            for body in robot.bodies
        }
        turned = [
            float(np.abs(np.diff(own)).sum())
            for _, joint in self.joints
            for own in path.values[joint.name][_LENGTHS.get(joint.kind, 0) :]
        ]
        super().__init__(bodies, self._chains(bodies), path.times, max(turned, default=0.0))
        moved = [k for k, above in enumerate(self.above) if above]
        self._start = self.at(np.zeros(1))
        self.back = {k: poses_of(inverse(transform_of(self._start.link(k)))) for k in moved}

    def at(self, times: Numbers) -> JointMoments:
        return JointMoments(self, times)

    def moved_reach(self, k: int) -> float:
        """See `Travel`. No chain is longer than all lengths in a robot together."""
        origin = self._start.placement(k)[:, 3, 0]
        arm = float(np.linalg.norm(self._start.centre(k)[0] - origin))
        return self._lengths + 2 * (arm + self.ball(k)[1])

    def roundoffs(self, k: int) -> float:
        robot = self.scene.robots[self.carried[self.bodies[k].id][0]].robot
        turns = (
            own
            for joint in robot.joints
            for own in self.path.values.get(joint.name, ())[_LENGTHS.get(joint.kind, 0) :]
        )
        angle = max((float(np.abs(own).max()) for own in turns), default=0.0)
        return 3 * JOINT_ROUNDOFFS * (len(robot.joints) + 1) * (1 + angle)

    def posed(self, pair: Pair, t: float) -> dict[str, Any]:
        mover = pair.a if self.above[self.place[pair.a.id]] else pair.b
        at, poses = (Place(mover.id, "t", t),), self.path.poses_around(t)
        return {"at": at, "joints": self.path.pose(t), "poses": poses}

    def stated(self) -> tuple[StatedMotion, ...]:
        moving = [body.id for body, above in zip(self.bodies, self.above, strict=True) if above]
        waypoints = (JointWaypoint(float(t), self.path.pose(t)) for t in self.times)
        return (StatedPath(tuple(moving), False, tuple(waypoints)),) if moving else ()

    def _chains(self, bodies: Sequence[PlacedBody]) -> list[list[int]]:
        """Of each body the joints that move it, the nearest first."""
        chains: dict[tuple[int, str], list[int]] = {}
        numbers = {(owner, joint.name): k for k, (owner, joint) in enumerate(self.joints)}
        for number, robot in enumerate(self.scene.robots):
            chains |= {(number, link): [] for link in robot.robot.roots}
            for joint in robot.robot.joints:  # parents first
                own = [numbers[number, joint.name]] if (number, joint.name) in numbers else []
                chains[number, joint.child] = [*own, *chains[number, joint.parent]]
        of_body = {id_: chains[number, link] for id_, (number, link, _) in self.carried.items()}
        return [of_body.get(body.id, []) for body in bodies]

    @cached_property
    def _lengths(self) -> float:
        """Return the sum of all lengths in a robot, of the one where it is largest."""
        lengths = [0.0]
        for robot in self.scene.robots:
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
        return max(lengths)


class JointMoments(Moments):
    """Robots on their path at some times."""

    def __init__(self, travel: JointTravel, times: Numbers) -> None:
        super().__init__(travel)
        self._robots, self._values = travel, travel.path.at(times)
        self._frames = link_frames(travel.scene, self._values)
        at = np.searchsorted(travel.times, times, "right") - 1
        self._pieces = np.clip(at, 0, len(travel.times) - 2)

    @kept
    def joint(self, j: int) -> Rates:
        number, joint = self._robots.joints[j]
        before = within(self._frames[number][joint.parent], poses_of(joint.origin))
        own = within(before, motion(joint, self._values[joint.name]))
        axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
        rate, shift = _steady(joint, self._robots.rates[j][:, self._pieces])
        slide = (before[:, :3] * shift).sum(axis=1).T
        return Rates(np.einsum("ijm,j->mi", own[:, :3], axis), own[:, 3].T, rate, slide)

    def link(self, k: int) -> Numbers:
        """Return the poses of the link of a body, shape (3, 4, moments)."""
        number, link, _ = self._robots.carried[self._robots.bodies[k].id]
        return self._frames[number][link]

    @kept
    def placement(self, k: int) -> Numbers:
        body = self._robots.bodies[k]
        if body.id not in self._robots.carried:
            return poses_of(body.body.transform or IDENTITY)
        return within(self.link(k), self._robots.carried[body.id][2])

    @kept
    def pose(self, k: int) -> Numbers:
        return within(self.link(k), self._robots.back[k])


def _steady(joint: Joint, rates: Numbers) -> tuple[Numbers, Numbers]:
    """How a joint turns, and how it slides in its frame before its own motion, shape (3, moments).
    A planar joint turns about where it has slid."""
    if joint.kind == "prismatic":
        return np.zeros_like(rates[0]), np.array(joint.axis)[:, None] * rates[0]
    if joint.kind == "planar":
        x, y = (np.array(axis)[:, None] for axis in plane_axes(joint.axis))
        return rates[2], x * rates[0] + y * rates[1]
    return rates[0], np.zeros((3, len(rates[0])))
