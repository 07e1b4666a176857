"""Fits the blocks of half spaces to their scene, so that each is the same to every body there as
the half space (`core.shapes.HalfSpace`).

Half spaces need no other size, and each query on meshes answers for them. Where we deviate from a
half space: the corners of a block that is turned are rounded as those of any mesh.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.core import largest_stretch
from satcheck.core.shapes import HalfSpace
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, Body, Scene, is_half_space
from satcheck.scene.inspect import shape_file
from satcheck.scene.motion import Motion, PosePath, Rotation

if TYPE_CHECKING:
    from satcheck.core.conventions import Vector
    from satcheck.scene.robot import Joint, SceneRobot

Box = tuple["Vector", "Vector"]  # the least and the greatest corner

# Two points of the scene are apart by twice its radius at most, and bodies lie within 3/8 of the
# reach.
_ROOM = 6.0
_LARGEST = 2.0**146  # a placed body reaches no farther than 2e44


def with_reach(scene: Scene, room: float = 1.0) -> Scene:
    """The scene with blocks that reach beyond its bodies: as they are placed, in all poses that the
    limits of their joints allow, and on their ways. Blocks that do so already stay. room: how many
    times as far they reach."""
    floors = [body for body in scene.bodies if is_half_space(body)]
    radius = room * _radius_of(scene)
    fitted = {body.id: _fitted(body, radius) for body in floors}
    if all(fitted[body.id] is body for body in floors):
        return scene
    return replace(scene, bodies=tuple(fitted.get(body.id, body) for body in scene.bodies))


def holds(floor: Body, box: Box) -> bool:
    """Return whether the block of a half space is the same as the half space to a body in this box,
    world units."""
    origin, reach = reach_in_world(floor)
    return farthest(origin, box) <= reach


def reach_in_world(floor: Body) -> tuple[Vector, float]:
    """The origin of a half space, and how far from it other bodies may be, world units."""
    assert isinstance(floor.shape, HalfSpace)
    return _origin(floor), floor.shape.reaches * _least_stretch(floor)


def farthest(origin: Vector, box: Box) -> float:
    """The distance of the farthest corner of a box."""
    low, high = box
    return math.hypot(
        *(max(abs(a - o), abs(b - o)) for o, a, b in zip(origin, low, high, strict=True))
    )


def _fitted(floor: Body, radius: float) -> Body:
    """radius: no point of the scene is farther from the origin of the world."""
    assert isinstance(floor.shape, HalfSpace)
    stretch = _least_stretch(floor)
    needed = _ROOM * radius / stretch if stretch else math.inf
    if floor.shape.reach >= min(needed, _LARGEST):
        return floor
    # A power of two, so that turning it about an axis of the frame is exact.
    shape = HalfSpace(min(2.0 ** (math.frexp(needed)[1]), _LARGEST))
    file = replace(shape_file(shape, floor.file.path), units=floor.file.units)
    return replace(floor, shape=shape, file=file)


def _radius_of(scene: Scene) -> float:
    """An upper bound of the distance of the points of all bodies from the origin of the world."""
    radii = {body.id: _placed_radius(body) for body in scene.bodies}
    for robot in scene.robots:
        for id_, radius in _carried_radii(robot, scene).items():
            radii[id_] = max(radii.get(id_, 0.0), radius)
    for motion in scene.motions:
        for id_ in motion.bodies:
            if id_ in radii:
                radii[id_] = max(radii[id_], _moved_radius(motion, radii[id_]))
    return max(radii.values(), default=0.0)


def _origin(body: Body) -> Vector:
    x, y, z = (body.transform or IDENTITY)[3:12:4]
    return x, y, z


def _placed_radius(body: Body) -> float:
    origin = math.hypot(*_origin(body))
    if is_half_space(body):
        return origin
    return origin + _own_radius(body.file.mesh.bounds, body.transform or IDENTITY)


def _own_radius(bounds: Box, transform: Transform) -> float:
    """Return how far the points in the box of a file are from the image of its origin. The mesh of
    a curved shape reaches its bounds along each axis, and the shape lies within them."""
    return largest_stretch(transform) * farthest((0.0, 0.0, 0.0), bounds)


def _least_stretch(body: Body) -> float:
    """A lower bound of how much the placement stretches a length."""
    if body.transform is None:
        return 1.0
    import numpy as np

    matrix = np.array(body.transform).reshape(4, 4)[:3, :3]
    return float(np.linalg.svd(matrix, compute_uv=False)[-1]) * (1 - 2.0**-40)


def _moved_radius(motion: Motion, radius: float) -> float:
    """The bound for a body with this bound where it is placed."""
    match motion.path:
        case PosePath(waypoints):
            return radius + max(math.hypot(*waypoint.position) for waypoint in waypoints)
        case Rotation(point):
            return radius + 2 * math.hypot(*point)
        case path:
            return radius + math.hypot(*path.vector)


def _carried_radii(robot: SceneRobot, scene: Scene) -> dict[str, float]:
    """The bounds of the bodies of a robot, over the values that its joints may take: those of the
    scene, those of its path, and those within the limits."""
    radii = {link: math.hypot(*pose[3:12:4]) for link, pose in robot.robot.roots.items()}
    for joint in robot.robot.joints:
        way = sum(math.hypot(*pose[3:12:4]) for pose in (joint.origin, joint.child_origin))
        radius = radii[joint.parent] + way + _slide(joint, scene)
        rest = robot.robot.links[joint.child].rest
        radii[joint.child] = max(radius, math.hypot(*rest[3:12:4]) if rest else 0.0)
    bodies = {body.id: body for body in scene.bodies}
    bounds = {}
    for part in robot.bodies:
        if (body := bodies.get(part.id)) is not None:
            own = 0.0 if is_half_space(body) else _own_radius(body.file.mesh.bounds, part.offset)
            bounds[part.id] = radii[part.link] + math.hypot(*part.offset[3:12:4]) + own
    return bounds


def _slide(joint: Joint, scene: Scene) -> float:
    """Return how far the joint shifts its child at most."""
    count = {"prismatic": 1, "planar": 2, "floating": 3, "free": 3}.get(joint.kind, 0)
    start = joint.reference[0] if joint.kind == "prismatic" and joint.reference else 0.0
    limits = (joint.limits.lower, joint.limits.upper) if joint.limits and count == 1 else ()
    far = [abs(value - start) for value in limits if math.isfinite(value)]
    for values in _values(joint.name, scene):
        far.append(sum(abs(value - start) for value in values[:count]))
    return max(far, default=0.0)


def _values(joint: str, scene: Scene) -> Iterator[Sequence[float]]:
    if scene.posture is not None and joint in scene.posture.joints:
        yield scene.posture.joints[joint]
    if scene.joint_path is not None and joint in scene.joint_path.values:
        yield from scene.joint_path.values[joint].T.tolist()
