"""Reads URDF. A mistake that could move, hide or reshape a body is an error, any other a warning.

The format: http://wiki.ros.org/urdf/XML. Only elements that place geometry are read. An error in a
joint or a link refuses the robot, and states the line. An error inside a <collision> refuses only
that body. `urdf_places` says which names are harmless; others block a pass.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import get_args

from satcheck.core.conventions import Vector
from satcheck.core.shapes import Box, Capsule, Cylinder, HalfSpace, Primitive, Sphere
from satcheck.core.transform import Transform, compose
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import Refusal
from satcheck.scene.files.readers import GeometryKind, RobotFile
from satcheck.scene.files.xml_tree import Element, RefusedElement
from satcheck.scene.issue import Issue
from satcheck.scene.robot.joint_tree import in_order
from satcheck.scene.robot.kinematics import facing, from_quaternion, from_rpy
from satcheck.scene.robot.model import (
    DRAWN_PLANE,
    Collision,
    Geometry,
    Joint,
    JointKind,
    Limits,
    Link,
    MeshReference,
    Mimic,
    Robot,
    UrdfJointKind,
)
from satcheck.scene.robot.slips import Slips
from satcheck.scene.robot.urdf_places import JOINT, LINK, ROBOT, SHAPE

_KINDS: tuple[UrdfJointKind, ...] = get_args(UrdfJointKind)
_X: Vector = (1.0, 0.0, 0.0)  # the default axis
_LIMITED = ("revolute", "prismatic")
_UNLIMITED = "treated as unlimited"
_LOOPS = ("loop_joint", "drake:ball_constraint")  # joints stand where the pose says
_SHAPES: dict[str, tuple[Callable[..., Primitive], dict[str, int]]] = {  # size -> numbers
    "box": (Box, {"size": 3}),
    "sphere": (Sphere, {"radius": 1}),
    "cylinder": (Cylinder, {"radius": 1, "length": 1}),
    # Not in URDF 1.0; MuJoCo, Drake and URDF 1.2 agree that the caps lie beyond `length`.
    "capsule": (Capsule, {"radius": 1, "length": 1}),
    "plane": (HalfSpace, {}),  # not in URDF 1.0; as in PyBullet
}


def robot_of(root: Element, file: RobotFile) -> tuple[Robot, tuple[Issue, ...]]:
    """Return the robot, and warnings. Raises Refused with the file, the line and the
    element. root: the outermost element. No mesh is opened."""
    return _Reader(root.file, file.geometry).read(root)


class _Reader:
    def __init__(self, path: str, geometry: GeometryKind) -> None:
        self._path = path
        self._geometry = geometry
        self._slips = Slips(geometry)

    def read(self, root: Element) -> tuple[Robot, tuple[Issue, ...]]:
        self._slips.look(root, ROBOT)
        links: dict[str, Link] = {}
        for element in root.all("link"):
            link = self._link(element)
            if link.name in links:
                element.refuse(f"a second link {link.name!r}", "duplicate-id")
            links[link.name] = link
        if not links:
            root.refuse("a robot without links")
        self._look_for_folders(root, links)
        names = [element.attribute("name") for element in root.all("joint")]
        joints: dict[str, tuple[Joint, Element]] = {}
        for element in root.all("joint"):
            joint = self._joint(element, names)
            if joint.name in joints:
                element.refuse(f"a second joint {joint.name!r}", "duplicate-id")
            joints[joint.name] = joint, element
        for element in (each for tag in _LOOPS for each in root.all(tag)):
            cause = f"<{element.tag}> is not solved: joints stand where the pose says"
            self._slips.note("constraint-not-solved", element, cause)
        base, ordered = in_order(root, links, list(joints.values()))
        name = root.attributes.get("name") or Path(self._path).stem
        robot = Robot(name, self._path, {base: IDENTITY}, links, ordered, geometry=self._geometry)
        return robot, self._slips.issues()

    def _look_for_folders(self, root: Element, links: Mapping[str, Link]) -> None:
        """Note that MuJoCo takes meshes without a package from another folder."""
        shapes = [part.geometry for link in links.values() for part in link.collisions]
        plain = any(isinstance(s, MeshReference) and "://" not in s.uri for s in shapes)
        for compiler in (inner for each in root.all("mujoco") for inner in each.all("compiler")):
            folder = PurePosixPath(compiler.attributes.get("meshdir", ""))
            stripped = compiler.attributes.get("strippath", "false") != "false"
            if plain and (stripped or folder != PurePosixPath()):
                cause = "<compiler>: the folder of meshes that it states is not read"
                self._slips.note("unread", compiler, cause)

    def _link(self, element: Element) -> Link:
        self._slips.look(element, LINK)
        name = element.attribute("name")
        collisions = (self._collision(inner) for inner in element.all(self._geometry))
        return Link(
            name=name,
            collisions=tuple(collision for collision in collisions if collision is not None),
            unused=bool(element.all(self._slips.others)),
        )

    def _collision(self, element: Element) -> Collision | None:
        """None: it has no geometry or size 0, and a warning says so."""
        name = element.attributes.get("name") or None
        try:
            self._slips.look(element, SHAPE)
            shape = _only_shape(element)
            if shape is None:
                self._slips.note(
                    "no-shape", element, f"a <{element.tag}> without geometry: no body"
                )
                return None
            if _is_point(shape):
                self._slips.note("no-shape", shape, f"a <{shape.tag}> of size 0: no body")
                return None
            origin, geometry = _origin(element), _geometry(shape)
            if isinstance(geometry, HalfSpace):
                if self._geometry == "visual":
                    shape.refuse(DRAWN_PLANE, "unsupported-feature")
                origin = compose(origin, facing(_vector(shape, "normal"), shape))
            return Collision(name, origin, geometry, element.line)
        except RefusedElement as error:
            return Collision(name, IDENTITY, Refusal(error.code, error.reason), error.at)

    def _joint(self, element: Element, names: Sequence[str]) -> Joint:
        self._slips.look(element, JOINT)
        name = element.attribute("name")
        given = element.attribute("type")
        kind = next((kind for kind in _KINDS if kind == given), None)
        if kind is None:
            element.refuse(f"type {given!r} is none of {', '.join(_KINDS)}")
        return Joint(
            name=name,
            kind=kind,
            parent=element.need("parent").attribute("link"),
            child=element.need("child").attribute("link"),
            origin=_origin(element),
            axis=_X if kind in ("fixed", "floating") else self._axis(element),
            limits=self._limits(element, kind),
            mimic=None if kind == "fixed" else self._mimic(element, kind, names),
        )

    def _axis(self, joint: Element) -> Vector:
        """The axis, scaled to length 1. An axis of length 1 is not changed."""
        element = joint.only("axis")
        if element is None:
            return _X
        axis = _vector(element, "xyz", _X)
        length = math.hypot(*axis)
        if not (length > 0.0 and math.isfinite(length)):
            element.refuse("an axis of length 0" if length == 0.0 else "the axis is too long")
        x, y, z = (c / length for c in axis)
        return x, y, z

    def _limits(self, element: Element, kind: JointKind) -> Limits | None:
        limit = element.only("limit")
        if kind not in _LIMITED:
            return None
        if limit is None:
            self._slips.note("no-limits", element, f"a {kind} joint without <limit>: {_UNLIMITED}")
            return None
        limits = Limits(limit.number("lower", 0.0), limit.number("upper", 0.0))
        if limits.lower > limits.upper:
            self._slips.note("no-limits", limit, f"lower is above upper: {_UNLIMITED}")
            return None
        return limits

    def _mimic(self, joint: Element, kind: JointKind, names: Sequence[str]) -> Mimic | None:
        element = joint.only("mimic")
        if element is None:
            return None
        if kind in ("planar", "floating"):
            element.refuse(f"a {kind} joint cannot mimic another")
        mimic = Mimic(
            joint=element.attribute("joint"),
            multiplier=element.number("multiplier", 1.0),
            offset=element.number("offset", 0.0),
        )
        if mimic.joint in names:
            return mimic
        missing = f"mimics joint {mimic.joint!r}, which does not exist"
        if mimic.offset:  # its value depends on the missing joint
            element.refuse(missing, "index-out-of-range")
        self._slips.note("no-leader", element, "mimics a missing joint: moves independently")
        return None


def _only_shape(collision: Element) -> Element | None:
    """The geometry of a collision; None if it has no shape, not even a misspelt one."""
    geometry, known = collision.only("geometry"), SHAPE.elements
    if geometry is None and known and not all(known.knows(e.tag) for e in collision.children):
        collision.refuse("<geometry> is missing")
    shapes = geometry.children if geometry else []
    if len(shapes) > 1 or (not shapes and (geometry or collision).text):
        (geometry or collision).refuse(f"should hold one shape, not {len(shapes)}")
    return shapes[0] if shapes else None


def _is_point(shape: Element) -> bool:
    """Whether all sizes are 0, so that the shape cannot collide."""
    _, sizes = _SHAPES.get(shape.tag, (None, {}))
    return (
        bool(sizes)
        and sizes.keys() == shape.attributes.keys()
        and not any(any(shape.numbers(name, count)) for name, count in sizes.items())
    )


def _geometry(shape: Element) -> Geometry:
    if shape.tag == "mesh":
        scale = _vector(shape, "scale", (1.0, 1.0, 1.0))
        if 0.0 in scale:
            shape.refuse("scale 0 flattens the mesh", "singular-transform")
        return MeshReference(shape.attribute("filename"), scale)
    if shape.tag not in _SHAPES:
        known = ", ".join(("mesh", *_SHAPES))
        shape.refuse(f"no geometry that is read ({known})", "unsupported-feature")
    kind, sizes = _SHAPES[shape.tag]
    values = [shape.numbers(name, count) for name, count in sizes.items()]
    try:
        return kind(*(value if len(value) > 1 else value[0] for value in values))
    except ValueError as error:  # a size that is not positive
        shape.refuse(str(error))


def _origin(owner: Element) -> Transform:
    origin = owner.only("origin")
    if origin is None:
        return IDENTITY
    xyz = _vector(origin, "xyz", (0.0, 0.0, 0.0))
    if "quat_xyzw" not in origin.attributes:
        return from_rpy(xyz, _vector(origin, "rpy", (0.0, 0.0, 0.0)))
    if "rpy" in origin.attributes:
        origin.refuse("both rpy and quat_xyzw")
    x, y, z, w = origin.numbers("quat_xyzw", 4)
    if math.hypot(x, y, z, w) == 0.0:
        origin.refuse("a quaternion of length 0")
    return from_quaternion(xyz, (x, y, z, w))


def _vector(element: Element, attribute: str, default: Vector | None = None) -> Vector:
    x, y, z = element.numbers(attribute, 3, default)
    return x, y, z
