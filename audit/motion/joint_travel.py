"""How far the bodies of robots travel, relative to each other, while their joints move.

The displacement bound of Fabian Schwarzer, Mitul Saha, Jean-Claude Latombe, "Adaptive Dynamic
Collision Checking for Single and Multiple Robots in Complex Environments" (2005): a joint that
turns by an angle moves a point by at most the angle times its distance from the axis. Where we
deviate: the distances are those in the middle of the interval, plus what the joints nearer to the
body add to them. The joints above both bodies move neither relative to the other. Of the way over a
half space that stays, only the part along its normal counts: the gap is the least height.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.core.half_space import plane_of
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.scene import Scene
from satcheck.scene.bodies import is_half_space
from satcheck.scene.robot import Joint, JointPath
from satcheck.scene.robot.kinematics import link_frames, motion, placements, poses_of, within

Numbers = NDArray[np.float64]
Ball = tuple[tuple[float, float, float], float]

# The rounding of one joint, in roundoffs of the reach of the robot and of its angle: sine and
# cosine 4, the entries of two products of 4x4 matrices 16, a point 16, the value of the joint 4.
JOINT_ROUNDOFFS = 64
# The bound itself is a short sum of products.
_ROUNDED_UP = 1 + 1e-12
# The rounding of the angle between a joint and a normal, in roundoffs.
_ANGLE_ROUNDOFFS = 16
# How many numbers of a joint are lengths; the others turn it.
_LENGTHS = {"prismatic": 1, "planar": 2, "floating": 3, "free": 3}


class Interval(Struct, frozen=True):
    """Intervals of t, each between two poses of the path."""

    start: Numbers
    end: Numbers

    @property
    def middle(self) -> Numbers:
        return 0.5 * (self.start + self.end)


class Middle(Struct, frozen=True):
    """The robots in the middle of intervals.

    matrices: shape (intervals, bodies, 12). axes, origins: the axis of each joint that
    moves, and a point on it, shape (joints, intervals, 3). turns, shifts: how far each joint turns
    and slides until the ends of the interval, shape (joints, intervals). centres: of the balls
    around bodies, shape (bodies, intervals, 3). pad: how far rounding moves a point.
    """

    matrices: Numbers
    axes: Numbers
    origins: Numbers
    turns: Numbers
    shifts: Numbers
    centres: Numbers
    pad: float


class Travel:
    """around: of each body of the scene, see `PosedPairs.around`."""

    def __init__(self, scene: Scene, path: JointPath, around: Sequence[Ball]) -> None:
        self._scene, self._path = scene, path
        self._centres = np.array([centre for centre, _ in around]).reshape(-1, 3)
        self._radii = [radius for _, radius in around]
        self._joints = [
            (number, joint)
            for number, robot in enumerate(scene.robots)
            for joint in robot.robot.joints
            if joint.name in path.moving
        ]
        self._above = self._chains()
        self._floors = {
            number: np.array(plane_of(body.transform).unit)
            for number, body in enumerate(scene.bodies)
            if is_half_space(body) and not self._above[number]
        }

    def moves(self, a: int, b: int) -> bool:
        """Whether two bodies move relative to each other, by their numbers in the scene."""
        return set(self._above[a]) != set(self._above[b])

    def moving(self) -> list[str]:
        """The bodies that move."""
        return [b.id for b, above in zip(self._scene.bodies, self._above, strict=True) if above]

    def middle(self, intervals: Interval) -> Middle:
        values = self._path.at(intervals.middle)
        count = len(intervals.start)
        frames = link_frames(self._scene, values)
        matrices = placements(self._scene, frames, count)
        placed = [_moved(joint, frames[number], values) for number, joint in self._joints]
        movers = [joint for _, joint in self._joints]
        axes = [_turned(poses, joint) for poses, joint in zip(placed, movers, strict=True)]
        origins = np.array([poses[:, 3].T for poses in placed])
        turns, shifts = self._steps(intervals)
        linear = matrices.reshape(count, -1, 3, 4)
        centres = np.einsum("nbij,bj->bni", linear[..., :3], self._centres)
        centres += linear[..., 3].transpose(1, 0, 2)
        reach = float(np.abs(matrices[:, :, 3::4]).max(initial=0.0)) + 2 * max(
            self._radii, default=0.0
        )
        reach += float(np.abs(origins).max(initial=0.0))
        return Middle(
            matrices, np.array(axes), origins, turns, shifts, centres, self._pad(values, reach)
        )

    def between(self, at: Middle, a: int, b: int) -> Numbers:
        """An upper bound of how far any point of B moves in the frame of A, or one of A in that of
        B, from the middle of each interval until its ends, rounding included. Over a half space
        that stays: of how much its height changes."""
        for floor, other in ((a, b), (b, a)):
            if floor in self._floors:
                up = self._floors[floor]
                return self._carried(at, other, self._above[other], up) * _ROUNDED_UP + 2 * at.pad
        only_a = [j for j in self._above[a] if j not in self._above[b]]
        only_b = [j for j in self._above[b] if j not in self._above[a]]
        of_b = self._carried(at, b, [*only_b, *reversed(only_a)])
        of_a = self._carried(at, a, [*only_a, *reversed(only_b)])
        return np.minimum(of_a, of_b) * _ROUNDED_UP + 2 * at.pad

    def in_world(self, at: Middle, body: int) -> tuple[Numbers, Numbers]:
        """(lower, upper) corners of a box around a body in all of these intervals."""
        grown = self._radii[body] + self._carried(at, body, self._above[body]) * _ROUNDED_UP
        grown += at.pad
        centres = at.centres[body]
        return (centres - grown[:, None]).min(axis=0), (centres + grown[:, None]).max(axis=0)

    def _carried(
        self, at: Middle, body: int, joints: Sequence[int], up: Numbers | None = None
    ) -> Numbers:
        """joints: those that carry the body, the nearest first. up: a normal, along which alone the
        way counts. Nearer joints move first, so each moves about its axis in the middle."""
        total = np.zeros(len(at.matrices))
        risen = np.zeros(len(at.matrices))
        for j in joints:
            from_origin = at.centres[body] - at.origins[j]
            along = (from_origin * at.axes[j]).sum(axis=1)[:, None] * at.axes[j]
            lever = np.linalg.norm(from_origin - along, axis=1) + self._radii[body]
            lever += total + at.shifts[j]
            turned = np.minimum(at.turns[j], 2.0) * lever
            total += at.shifts[j] + turned
            if up is not None:
                rise = np.abs(at.axes[j] @ up)
                across = np.linalg.norm(np.cross(at.axes[j], up), axis=1)
                slides = self._joints[j][1].kind == "prismatic"
                risen += at.shifts[j] * (rise if slides else across) + turned * across
        return total if up is None else risen + _ANGLE_ROUNDOFFS * UNIT_ROUNDOFF * total

    def _chains(self) -> list[list[int]]:
        """Of each body the joints that move it, the nearest first."""
        chains: dict[str, list[int]] = {}
        for number, robot in enumerate(self._scene.robots):
            of_link: dict[str, list[int]] = {link: [] for link in robot.robot.roots}
            numbers = {j.name: k for k, (owner, j) in enumerate(self._joints) if owner == number}
            for joint in robot.robot.joints:  # parents first
                own = [numbers[joint.name]] if joint.name in numbers else []
                of_link[joint.child] = [*own, *of_link[joint.parent]]
            chains |= {body.id: of_link[body.link] for body in robot.bodies}
        return [chains.get(body.id, []) for body in self._scene.bodies]

    def _steps(self, intervals: Interval) -> tuple[Numbers, Numbers]:
        """(turns, shifts) of `Middle`."""
        starts, ends = self._path.at(intervals.start), self._path.at(intervals.end)
        turns, shifts = [], []
        none = np.zeros(len(intervals.start))
        for _, joint in self._joints:
            steps = [
                0.5 * np.abs(end - start)
                for start, end in zip(starts[joint.name], ends[joint.name], strict=True)
            ]
            if joint.kind == "prismatic":
                turn, shift = none, steps[0] * float(np.linalg.norm(joint.axis))
            elif joint.kind == "planar":
                turn, shift = steps[2], np.hypot(steps[0], steps[1])
            else:
                turn, shift = steps[0], none
            turns.append(turn)
            shifts.append(shift)
        return np.array(turns), np.array(shifts)

    def _pad(self, values: Mapping[str, Numbers], reach: float) -> float:
        angle = length = 0.0
        for robot in self._scene.robots:
            for joint in robot.robot.joints:
                sizes = [float(np.abs(number).max()) for number in values.get(joint.name, ())]
                lengths = _LENGTHS.get(joint.kind, 0)
                length = max([length, *sizes[:lengths]])
                angle = max([angle, *sizes[lengths:]])
        depth = max((len(robot.robot.joints) for robot in self._scene.robots), default=0)
        return JOINT_ROUNDOFFS * UNIT_ROUNDOFF * (depth + 1) * (1 + angle) * (reach + length)


def _moved(joint: Joint, links: Mapping[str, Numbers], values: Mapping[str, Numbers]) -> Numbers:
    """The frame of a joint after its own motion: a planar joint turns about where it has slid."""
    own = motion(joint, values[joint.name])
    return within(within(links[joint.parent], poses_of(joint.origin)), own)


def _turned(poses: Numbers, joint: Joint) -> Numbers:
    """The unit axis of a joint in the world."""
    axis = np.array(joint.axis)
    turned: Numbers = poses.transpose(2, 0, 1)[..., :3] @ (axis / np.linalg.norm(axis))
    return turned
