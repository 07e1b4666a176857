"""The joints of MJCF. A body has several joints, one after another; a body without joints is fixed
to its parent. Bodies without geometry stand between the joints of one body."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from satcheck.core.transform import Transform, compose, placed
from satcheck.plugins.mjcf import messages
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.plain_ids import UniqueNames
from satcheck.scene.robot.kinematics import from_quaternion
from satcheck.scene.robot.model import Joint, JointKind, Limits, Link

_UNTURNED = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


def pose_of(place: messages.Place) -> Transform:
    w, x, y, z = place.turn
    return from_quaternion(place.at, (x, y, z, w))


def rest_poses(bodies: Sequence[messages.Body]) -> list[Transform]:
    """World pose of each body at qpos0."""
    poses = [IDENTITY]
    for body in bodies[1:]:
        poses.append(compose(poses[body.parent], pose_of(body.place)))
    return poses


def joints_of(model: messages.Model) -> tuple[list[Joint], list[Link]]:
    """The joints, each after that of its parent, and the links between joints of one body."""
    of_body: dict[int, list[messages.Joint]] = {}
    for joint in model.joints:
        of_body.setdefault(joint.body, []).append(joint)
    joints: list[Joint] = []
    between: list[Link] = []
    taken = UniqueNames()
    for name in {body.name for body in model.bodies} | {joint.name for joint in model.joints}:
        taken.unique(name)
    for number, body in enumerate(model.bodies[1:], 1):
        parent = model.bodies[body.parent].name
        own = of_body.get(number, [])
        if not own:
            joints.append(_fixed(body.name, parent, pose_of(body.place), taken))
        for k, joint in enumerate(own, 1):
            child = body.name
            if k < len(own):
                child = taken.unique(f"{body.name} after {joint.name}")
                between.append(Link(child, (), unused=False))
            start = pose_of(body.place) if k == 1 else IDENTITY
            joints.append(_joint(joint, parent, child, start))
            parent = child
    return joints, between


def _fixed(body: str, parent: str, origin: Transform, taken: UniqueNames) -> Joint:
    name = taken.unique(f"{body} in {parent}")
    return Joint(name, "fixed", parent, body, origin, (1.0, 0.0, 0.0), None, None)


def _joint(joint: messages.Joint, parent: str, child: str, start: Transform) -> Joint:
    """start: the pose of the body before the joint moves it, in the frame of the parent."""
    kinds: dict[str, JointKind] = {
        "hinge": "revolute" if joint.limits else "continuous",
        "slide": "prismatic",
        "ball": "ball",
        "free": "free",
    }
    x, y, z = joint.at
    # The values of a free joint are the pose in the world.
    origin = IDENTITY if joint.kind == "free" else compose(start, placed(_UNTURNED, (x, y, z)))
    back = IDENTITY if joint.kind == "free" else placed(_UNTURNED, (-x, -y, -z))
    return Joint(
        name=joint.name,
        kind=kinds[joint.kind],
        parent=parent,
        child=child,
        origin=origin,
        axis=joint.axis,
        limits=Limits(*joint.limits) if joint.limits else None,
        mimic=None,
        child_origin=back,
        stands_at_zero=True,
        reference=joint.rest,
    )


def values_of(
    key: messages.Key, joints: Sequence[messages.Joint]
) -> Iterator[tuple[str, tuple[float, ...]]]:
    """The values of the joints in a keyframe; one without values stands for qpos0."""
    for joint in joints:
        values = key.qpos[joint.first : joint.first + len(joint.rest)]
        yield joint.name, values or joint.rest
