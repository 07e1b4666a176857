"""URDF -> Robot, strictly: what would move a body, or make it vanish, is refused with its line.

The format: http://wiki.ros.org/urdf/XML. Only what places geometry is read. Elements that cannot
change where it lies (inertial, transmission, gazebo, ...) are passed over; one that is unknown
inside a link or a joint is a warning, for it may be a misspelt one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from difflib import get_close_matches
from pathlib import Path
from typing import get_args

from satcheck.scene.bodies import IDENTITY
from satcheck.scene.issue import Issue, issue
from satcheck.scene.primitives import Box, Capsule, Cylinder, Sphere
from satcheck.scene.robot.joint_tree import in_order
from satcheck.scene.robot.kinematics import from_quaternion, from_rpy
from satcheck.scene.robot.model import (
    Collision,
    Geometry,
    Joint,
    JointKind,
    Limits,
    Link,
    MeshReference,
    Mimic,
    Robot,
    UnknownShape,
    Vector,
)
from satcheck.scene.robot.xml_tree import Element, read_tree

_KINDS: tuple[JointKind, ...] = get_args(JointKind)
_X: Vector = (1.0, 0.0, 0.0)  # the axis where none is given
_LIMITED = ("revolute", "prismatic")
_LINK_PARTS = frozenset(("collision", "visual", "inertial"))
_JOINT_PARTS = frozenset(
    ("origin", "parent", "child", "axis", "limit", "mimic", "dynamics", "calibration")
) | {"safety_controller"}
_COLLISION_PARTS = frozenset(("origin", "geometry"))
# What simulators add to links, joints and collisions, and what places nothing.
_EXTENSIONS = frozenset(("contact", "material", "sensor", "verbose", "hardwareInterface", "limits"))


def read_urdf(path: str, location: Path) -> tuple[Robot, tuple[Issue, ...]]:
    """The robot, and warnings. Raises SceneFileError with the file, the line and the element.

    path: of the file, for messages; location: where it lies. No mesh is opened.
    """
    return _Reader(path).read(read_tree(path, location, "robot"))


class _Reader:
    def __init__(self, path: str) -> None:
        self._path = path
        self._unknown: dict[str, list[tuple[Element, str]]] = {}

    def read(self, root: Element) -> tuple[Robot, tuple[Issue, ...]]:
        links: dict[str, Link] = {}
        for element in root.all("link"):
            link = self._link(element)
            if link.name in links:
                element.refuse(f"a second link {link.name!r}", "duplicate-id")
            links[link.name] = link
        if not links:
            root.refuse("a robot without links")
        joints: dict[str, tuple[Joint, Element]] = {}
        for element in root.all("joint"):
            joint = self._joint(element)
            if joint.name in joints:
                element.refuse(f"a second joint {joint.name!r}", "duplicate-id")
            joints[joint.name] = joint, element
        base, ordered = in_order(root, links, list(joints.values()))
        name = root.attributes.get("name") or Path(self._path).stem
        return Robot(name, self._path, base, links, ordered), self._unknown_elements()

    def _link(self, element: Element) -> Link:
        name = element.text("name")
        self._note_unknown(element, _LINK_PARTS)
        return Link(
            name=name,
            collisions=tuple(self._collision(one) for one in element.all("collision")),
            visual=bool(element.all("visual")),
        )

    def _collision(self, element: Element) -> Collision:
        self._note_unknown(element, _COLLISION_PARTS)
        geometry = element.need("geometry")
        shapes = geometry.children
        if len(shapes) != 1:
            geometry.refuse(f"should hold one shape, not {len(shapes)}")
        return Collision(
            name=element.attributes.get("name") or None,
            origin=_origin(element),
            geometry=_geometry(shapes[0]),
            line=element.line,
        )

    def _joint(self, element: Element) -> Joint:
        name = element.text("name")
        self._note_unknown(element, _JOINT_PARTS)
        given = element.text("type")
        kind = next((kind for kind in _KINDS if kind == given), None)
        if kind is None:
            element.refuse(f"type {given!r} is none of {', '.join(_KINDS)}")
        mimic = element.only("mimic") if kind != "fixed" else None
        if mimic is not None and kind in ("planar", "floating"):
            mimic.refuse(f"a {kind} joint cannot mimic another")
        return Joint(
            name=name,
            kind=kind,
            parent=element.need("parent").text("link"),
            child=element.need("child").text("link"),
            origin=_origin(element),
            axis=_X if kind in ("fixed", "floating") else _axis(element.only("axis")),
            limits=self._limits(element, kind),
            mimic=None if mimic is None else _mimic(mimic),
        )

    def _limits(self, element: Element, kind: JointKind) -> Limits | None:
        limit = element.only("limit")
        if kind not in _LIMITED:
            return None
        if limit is None:
            element.refuse(f"a {kind} joint without <limit>: how far it goes has to be said")
        limit.knows(("lower", "upper"), others=True)
        limits = Limits(limit.number("lower", 0.0), limit.number("upper", 0.0))
        if limits.lower > limits.upper:
            limit.refuse(f"lower {limits.lower:g} is above upper {limits.upper:g}")
        return limits

    def _note_unknown(self, element: Element, known: frozenset[str]) -> None:
        for child in element.children:
            if child.tag not in known and child.tag not in _EXTENSIONS and ":" not in child.tag:
                close = get_close_matches(child.tag, sorted(known), n=1)
                hint = f" (did you mean <{close[0]}>?)" if close else ""
                found = self._unknown.setdefault(child.tag, [])
                found.append((child, f"in <{element.tag}>{hint}"))

    def _unknown_elements(self) -> tuple[Issue, ...]:
        """A warning for each name."""
        issues = []
        for tag, found in self._unknown.items():
            first, where = found[0]
            more = f", and {len(found) - 1} more" if len(found) > 1 else ""
            message = f"line {first.line}: unknown <{tag}> {where}{more}: ignored"
            issues.append(issue("unknown-element", message, file=self._path))
        return tuple(issues)


def _geometry(shape: Element) -> Geometry:
    try:
        return _SHAPES[shape.tag](shape) if shape.tag in _SHAPES else _unknown(shape)
    except ValueError as error:  # a size that is not positive
        shape.refuse(str(error))


def _unknown(shape: Element) -> UnknownShape:
    known = ", ".join(_SHAPES)
    return UnknownShape(f"line {shape.line}: <{shape.tag}> is no geometry that is read ({known})")


def _mesh(shape: Element) -> MeshReference:
    shape.knows(("filename", "scale"))
    scale = _vector(shape, "scale", (1.0, 1.0, 1.0))
    if 0.0 in scale:
        shape.refuse("scale 0 flattens the mesh", "singular-transform")
    return MeshReference(shape.text("filename"), scale)


def _box(shape: Element) -> Box:
    shape.knows(("size",))
    return Box(_vector(shape, "size"))


def _sphere(shape: Element) -> Sphere:
    shape.knows(("radius",))
    return Sphere(shape.number("radius"))


def _cylinder(shape: Element) -> Cylinder:
    shape.knows(("radius", "length"))
    return Cylinder(shape.number("radius"), shape.number("length"))


def _capsule(shape: Element) -> Capsule:
    """Not in URDF 1.0; MuJoCo, Drake and URDF 1.2 agree that the caps lie beyond `length`."""
    shape.knows(("radius", "length"))
    return Capsule(shape.number("radius"), shape.number("length"))


_SHAPES: dict[str, Callable[[Element], Geometry]] = {
    "mesh": _mesh,
    "box": _box,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "capsule": _capsule,
}


def _origin(owner: Element) -> tuple[float, ...]:
    origin = owner.only("origin")
    if origin is None:
        return IDENTITY
    origin.knows(("xyz", "rpy", "quat_xyzw"))
    xyz = _vector(origin, "xyz", (0.0, 0.0, 0.0))
    if "quat_xyzw" not in origin.attributes:
        return from_rpy(xyz, _vector(origin, "rpy", (0.0, 0.0, 0.0)))
    if "rpy" in origin.attributes:
        origin.refuse("both rpy and quat_xyzw")
    x, y, z, w = origin.numbers("quat_xyzw", 4)
    if math.hypot(x, y, z, w) == 0.0:
        origin.refuse("a quaternion of length 0")
    return from_quaternion(xyz, (x, y, z, w))


def _axis(element: Element | None) -> Vector:
    """Of length 1; one that has it already stays as it is, to the bit."""
    if element is None:
        return _X
    element.knows(("xyz",))
    axis = _vector(element, "xyz", _X)
    length = math.hypot(*axis)
    if not (length > 0.0 and math.isfinite(length)):
        element.refuse("an axis of length 0" if length == 0.0 else "the axis is too long")
    x, y, z = (c / length for c in axis)
    return x, y, z


def _mimic(element: Element) -> Mimic:
    element.knows(("joint", "multiplier", "offset"))
    return Mimic(
        joint=element.text("joint"),
        multiplier=element.number("multiplier", 1.0),
        offset=element.number("offset", 0.0),
    )


def _vector(element: Element, attribute: str, default: Vector | None = None) -> Vector:
    x, y, z = element.numbers(attribute, 3, default)
    return x, y, z
