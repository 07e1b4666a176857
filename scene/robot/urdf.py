"""Reads URDF. A mistake that could move, hide or reshape a body is an error, any other a warning.

The format: http://wiki.ros.org/urdf/XML. Only elements that place geometry are read. An error in a
joint or a link refuses the robot, and states the line. An error inside a <collision> refuses only
that body. `urdf_places` says which names are harmless; others block a pass.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import get_args

from satcheck.core.conventions import Vector
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.files.readers import File
from satcheck.scene.files.xml_tree import Element, RefusedElement
from satcheck.scene.robot.elements import (
    MESH,
    SHAPES,
    ShapeForm,
    check_mimics,
    collision_of,
    only_shape,
    refused,
    turned_by,
    unit_axis,
)
from satcheck.scene.robot.kinematics import from_rpy
from satcheck.scene.robot.model import (
    Collision,
    Joint,
    JointKind,
    Limits,
    Link,
    MeshReference,
    Mimic,
    Robot,
    RobotDocument,
)
from satcheck.scene.robot.reading import read_tree
from satcheck.scene.robot.slips import Slips
from satcheck.scene.robot.urdf_places import JOINT, LINK, ROBOT, SHAPE
from satcheck.scene.words import listed, meant

# The others are those of MJCF.
_KINDS = tuple(kind for kind in get_args(JointKind) if kind not in ("ball", "free"))
_X: Vector = (1.0, 0.0, 0.0)  # the default axis
_LIMITED = ("revolute", "prismatic")
_UNLIMITED = "treated as unlimited"
_LOOPS = ("loop_joint", "drake:ball_constraint")  # joints stand where the pose says
_SHAPES = ShapeForm(
    (MESH, "box", "sphere", "cylinder", "capsule", "plane"),
    Element.numbers,
    lambda shape, scale: MeshReference(shape.attribute("filename"), scale),
)
_Joints = Sequence[tuple[Joint, Element]]


def read_urdf(file: File) -> RobotDocument:
    """Return the robot, and warnings. Raises Refused with the file, the line and the element. No
    mesh is opened."""
    root = read_tree(file.path, file.permitted)
    slips = Slips(file.options["geometry"])
    slips.look(root, ROBOT)
    links: dict[str, Link] = {}
    for element in root.all("link"):
        link = _link(element, slips)
        if link.name in links:
            element.refuse(f"a second link {link.name!r}", "duplicate-id")
        links[link.name] = link
    if not links:
        root.refuse("a robot without links")
    _look_for_folders(root, links.values(), slips)
    names = [element.attribute("name") for element in root.all("joint")]
    joints: dict[str, tuple[Joint, Element]] = {}
    for element in root.all("joint"):
        joint = _joint(element, names, slips)
        if joint.name in joints:
            element.refuse(f"a second joint {joint.name!r}", "duplicate-id")
        joints[joint.name] = joint, element
    for element in (each for tag in _LOOPS for each in root.all(tag)):
        cause = f"<{element.tag}> is not solved: joints stand where the pose says"
        slips.note("constraint-not-solved", element, cause)
    base, ordered = _in_order(root, links, list(joints.values()))
    name = root.attributes.get("name") or Path(root.file).stem
    robot = Robot(name, root.file, {base: IDENTITY}, links, ordered)
    return RobotDocument(robot=robot, issues=slips.issues())


def _look_for_folders(root: Element, links: Iterable[Link], slips: Slips) -> None:
    """Note that MuJoCo takes meshes without a package from another folder."""
    shapes = [part.geometry for link in links for part in link.collisions]
    plain = any(isinstance(s, MeshReference) and "://" not in s.uri for s in shapes)
    for compiler in (inner for each in root.all("mujoco") for inner in each.all("compiler")):
        folder = PurePosixPath(compiler.attributes.get("meshdir", ""))
        stripped = compiler.attributes.get("strippath", "false") != "false"
        if plain and (stripped or folder != PurePosixPath()):
            cause = "<compiler>: the folder of meshes that it states is not read"
            slips.note("unread", compiler, cause)


def _link(element: Element, slips: Slips) -> Link:
    slips.look(element, LINK)
    collisions = (_collision(inner, slips) for inner in element.all(slips.geometry))
    return Link(
        name=element.attribute("name"),
        collisions=tuple(collision for collision in collisions if collision is not None),
        unused=bool(element.all(slips.others)),
    )


def _collision(element: Element, slips: Slips) -> Collision | None:
    """None: it has no geometry or size 0, and a warning says so."""
    try:
        slips.look(element, SHAPE)
        shape = _only_shape(element)
        if shape is None or _is_point(shape):
            at, what = (element, "without geometry") if shape is None else (shape, "of size 0")
            slips.note("no-shape", at, f"a <{at.tag}> {what}: no body")
            return None
        return collision_of(element, shape, _origin(element), slips.geometry, _SHAPES)
    except RefusedElement as error:
        return refused(element, error)


def _only_shape(collision: Element) -> Element | None:
    """The geometry of a collision; None if it has no shape, not even a misspelt one."""
    geometry, known = collision.only("geometry"), SHAPE.elements
    if geometry is not None:
        return only_shape(geometry)
    if known and not all(known.knows(e.tag) for e in collision.children):
        collision.refuse("<geometry> is missing")
    if collision.text:
        collision.refuse("should hold one shape, not 0")
    return None


def _is_point(shape: Element) -> bool:
    """Whether all sizes are 0, so that the shape cannot collide."""
    _, sizes = SHAPES.get(shape.tag, (None, {}))
    return (
        bool(sizes)
        and sizes.keys() == shape.attributes.keys()
        and not any(any(shape.numbers(name, count)) for name, count in sizes.items())
    )


def _origin(owner: Element) -> Transform:
    origin = owner.only("origin")
    if origin is None:
        return IDENTITY
    xyz = _vector(origin, "xyz", (0.0, 0.0, 0.0))
    if "quat_xyzw" not in origin.attributes:
        return from_rpy(xyz, _vector(origin, "rpy", (0.0, 0.0, 0.0)))
    if "rpy" in origin.attributes:
        origin.refuse("both rpy and quat_xyzw")
    return turned_by(origin, xyz, origin.numbers("quat_xyzw", 4))


def _vector(element: Element, attribute: str, default: Vector) -> Vector:
    x, y, z = element.numbers(attribute, 3, default)
    return x, y, z


def _joint(element: Element, names: Sequence[str], slips: Slips) -> Joint:
    slips.look(element, JOINT)
    name, given = element.attribute("name"), element.attribute("type")
    kind = next((kind for kind in _KINDS if kind == given), None)
    if kind is None:
        element.refuse(f"type {given!r} is none of {', '.join(_KINDS)}")
    axis = None if kind in ("fixed", "floating") else element.only("axis")
    return Joint(
        name=name,
        kind=kind,
        parent=element.need("parent").attribute("link"),
        child=element.need("child").attribute("link"),
        origin=_origin(element),
        axis=_X if axis is None else unit_axis(axis, _vector(axis, "xyz", _X)),
        limits=_limits(element, kind, slips),
        mimic=None if kind == "fixed" else _mimic(element, kind, names, slips),
    )


def _limits(element: Element, kind: JointKind, slips: Slips) -> Limits | None:
    limit = element.only("limit")
    if kind not in _LIMITED:
        return None
    if limit is None:
        slips.note("no-limits", element, f"a {kind} joint without <limit>: {_UNLIMITED}")
        return None
    limits = Limits(limit.number("lower", 0.0), limit.number("upper", 0.0))
    if limits.lower > limits.upper:
        slips.note("no-limits", limit, f"lower is above upper: {_UNLIMITED}")
        return None
    return limits


def _mimic(joint: Element, kind: JointKind, names: Sequence[str], slips: Slips) -> Mimic | None:
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
    slips.note("no-leader", element, "mimics a missing joint: moves independently")
    return None


def _in_order(
    robot: Element, links: Mapping[str, Link], joints: _Joints
) -> tuple[str, tuple[Joint, ...]]:
    """(the root link, the joints, each after the joint of its parent link).

    Raises Refused for missing links, two parents, a cycle, several roots, and for a joint
    that mimics itself or a joint that it cannot mimic.
    """
    carriers: dict[str, Joint] = {}
    for joint, element in joints:
        for role, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in links:
                hint = meant(link, links)
                element.need(role).refuse(
                    f"joint {joint.name!r} names link {link!r}, which does not exist{hint}",
                    "index-out-of-range",
                )
        if joint.child in carriers:
            other = carriers[joint.child].name
            element.refuse(
                f"link {joint.child!r} has two parents: joints {other!r} and {joint.name!r}"
            )
        carriers[joint.child] = joint
    roots = [name for name in links if name not in carriers]
    if len(roots) > 1:
        names = listed([repr(root) for root in roots])
        robot.refuse(f"{len(roots)} links are the child of no joint, only the root may be: {names}")
    carried: dict[str, list[Joint]] = {}
    for joint, _ in joints:
        carried.setdefault(joint.parent, []).append(joint)
    ordered, waiting = [], list(roots)
    while waiting:
        for joint in carried.get(waiting.pop(), ()):
            ordered.append(joint)
            waiting.append(joint.child)
    if len(ordered) < len(joints):
        reached = {*roots, *(joint.child for joint in ordered)}
        circle = _circle(next(name for name in links if name not in reached), carriers)
        robot.refuse(f"joints form a cycle: {circle}", "reference-cycle")
    check_mimics(joints)
    return roots[0], tuple(ordered)


def _circle(link: str, carriers: Mapping[str, Joint]) -> str:
    """A cycle of links as text, `a -> b -> a`. link: one whose chain of parents never ends."""
    seen: list[str] = []
    while link not in seen:
        seen.append(link)
        link = carriers[link].parent
    round_trip = [link, *reversed(seen[seen.index(link) :])]
    return " -> ".join(map(repr, round_trip))
