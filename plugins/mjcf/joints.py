"""The joints of MJCF. A body has several joints, one after another; a body without joints is fixed
to its parent. Bodies without geometry stand between the joints of one body."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from satcheck.core.transform import Transform, compose, placed
from satcheck.plugins.mjcf.compiling import Key, numbers
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import UniqueNames
from satcheck.scene.robot.model import FREEDOMS, Joint, JointKind, Limits, Link

_UNTURNED = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
_KINDS: tuple[JointKind, ...] = ("free", "ball", "prismatic", "revolute")  # as MuJoCo numbers them


def rest_poses(m: Any, places: Sequence[Transform]) -> list[Transform]:
    """World pose of each body at qpos0. places: in their parents."""
    poses = [IDENTITY]
    for parent, place in zip(m.body_parentid[1:], places[1:], strict=True):
        poses.append(compose(poses[parent], place))
    return poses


def joints_of(
    m: Any, bodies: Sequence[str], names: Sequence[str], places: Sequence[Transform]
) -> tuple[list[Joint], list[Link]]:
    """The joints, each after that of its parent, and the links between joints of one body.
    names: of the joints."""
    joints: list[Joint] = []
    between: list[Link] = []
    taken = UniqueNames()
    for name in {*bodies, *names}:
        taken.unique(name)
    for number, body in enumerate(bodies[1:], 1):
        parent, start = bodies[m.body_parentid[number]], places[number]
        own = np.flatnonzero(m.jnt_bodyid == number).tolist()
        if not own:
            name = taken.unique(f"{body} in {parent}")
            joints.append(Joint(name, "fixed", parent, body, start))
        for k in own:
            child = body
            if k != own[-1]:
                child = taken.unique(f"{body} after {names[k]}")
                between.append(Link(child, (), unused=False))
            joints.append(_joint(m, k, names[k], parent, child, start))
            parent, start = child, IDENTITY
    return joints, between


def _joint(m: Any, k: int, name: str, parent: str, child: str, start: Transform) -> Joint:
    """start: the pose of the body before the joint moves it, in the frame of the parent."""
    kind = _KINDS[m.jnt_type[k]]
    limits = None
    if m.jnt_limited[k] and kind in ("revolute", "prismatic"):
        limits = Limits(*numbers(m.jnt_range[k]))
    # The values of a free joint are the pose in the world.
    x, y, z = numbers(m.jnt_pos[k])
    origin = IDENTITY if kind == "free" else compose(start, placed(_UNTURNED, (x, y, z)))
    back = IDENTITY if kind == "free" else placed(_UNTURNED, (-x, -y, -z))
    return Joint(
        name=name,
        kind="continuous" if kind == "revolute" and limits is None else kind,
        parent=parent,
        child=child,
        origin=origin,
        axis=numbers(m.jnt_axis[k]),
        limits=limits,
        child_origin=back,
        stands_at_zero=True,
        reference=numbers(_values(m.qpos0, m, k)),
    )


def _values(qpos: Any, m: Any, k: int) -> Any:
    """Those of a joint."""
    first = m.jnt_qposadr[k]
    return qpos[first : first + FREEDOMS.get(_KINDS[m.jnt_type[k]], 1)]


def values_of(key: Key, m: Any, names: Sequence[str]) -> Iterator[tuple[str, tuple[float, ...]]]:
    """The values of the joints in a keyframe; one without values stands for qpos0."""
    for k, name in enumerate(names):
        yield name, numbers(_values(key.qpos or m.qpos0, m, k))
