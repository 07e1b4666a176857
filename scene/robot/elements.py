"""What URDF and SDFormat state alike: shapes, axes, turns, and joints that mimic others."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple

from satcheck.core.conventions import Vector
from satcheck.core.shapes import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    Primitive,
    Sphere,
)
from satcheck.core.transform import Transform, compose, placed, quaternion_matrix
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import Refusal
from satcheck.scene.files.readers import GeometryKind
from satcheck.scene.files.xml_tree import Element, RefusedElement
from satcheck.scene.robot.model import Collision, Geometry, Joint, MeshReference

MESH = "mesh"
_ROUND = {"radius": 1, "length": 1}
# Sizes, and how many numbers each has.
SHAPES: dict[str, tuple[Callable[..., Primitive], dict[str, int]]] = {
    "box": (Box, {"size": 3}),
    "sphere": (Sphere, {"radius": 1}),
    "cylinder": (Cylinder, _ROUND),
    # Not in URDF 1.0; MuJoCo, Drake and URDF 1.2 agree that the caps lie beyond `length`.
    "capsule": (Capsule, _ROUND),
    "cone": (Cone, _ROUND),
    "ellipsoid": (Ellipsoid, {"radii": 3}),
    "plane": (HalfSpace, {}),  # not in URDF 1.0; as in PyBullet
}


def only_shape(geometry: Element) -> Element | None:
    """Return the element of the only shape; None: there is none, and no text either."""
    shapes = geometry.children
    if len(shapes) > 1 or (geometry.text and not shapes):
        geometry.refuse(f"should hold one shape, not {len(shapes)}")
    return shapes[0] if shapes else None


class ShapeForm(NamedTuple):
    """How a format states shapes. tags: those that are read. numbers: takes an element, the name of
    a size, how many numbers it has, and those that it has by default. mesh: takes the element of a
    mesh and its scale. normal: of a plane that states none; None: it has to."""

    tags: Collection[str]
    numbers: Callable[[Element, str, int, Vector | None], Sequence[float]]
    mesh: Callable[[Element, Vector], MeshReference]
    normal: Vector | None = None


def collision_of(
    element: Element, shape: Element, origin: Transform, kind: GeometryKind, form: ShapeForm
) -> Collision:
    """Return the collision, or the visual, of an element. kind: which of them is checked. Raises
    RefusedElement."""
    geometry = _geometry(shape, form)
    if isinstance(geometry, HalfSpace):
        if kind == "visual":
            message = "a plane that is drawn ends at its size: give a mesh or a box"
            shape.refuse(message, "unsupported-feature")
        x, y, z = form.numbers(shape, "normal", 3, form.normal)
        origin = compose(origin, _facing((x, y, z), shape))
    return Collision(_name(element), origin, geometry, element.line, element.file)


def _geometry(shape: Element, form: ShapeForm) -> Geometry:
    if shape.tag not in form.tags:
        known = ", ".join(form.tags)
        shape.refuse(f"no geometry that is read ({known})", "unsupported-feature")
    if shape.tag == MESH:
        x, y, z = form.numbers(shape, "scale", 3, (1.0, 1.0, 1.0))
        if 0.0 in (x, y, z):
            shape.refuse("scale 0 flattens the mesh", "singular-transform")
        return form.mesh(shape, (x, y, z))
    kind, sizes = SHAPES[shape.tag]
    values = [form.numbers(shape, name, count, None) for name, count in sizes.items()]
    try:
        return kind(*(value if len(value) > 1 else value[0] for value in values))
    except ValueError as error:  # a size that is not positive
        shape.refuse(str(error))


def refused(element: Element, error: RefusedElement) -> Collision:
    """Return what stands for a collision in which an element is refused."""
    reason = Refusal(error.code, error.reason)
    return Collision(_name(element), IDENTITY, reason, error.at, element.file)


def _name(element: Element) -> str | None:
    return element.attributes.get("name") or None


def _facing(normal: Vector, plane: Element) -> Transform:
    """The rotation that takes z to a normal of any length; exact for normals along the axes."""
    length = math.hypot(*normal)
    if length == 0.0:
        plane.refuse("a normal of length 0")
    x, y, z = (c / length for c in normal)
    across = math.hypot(x, y)
    # About z to the side of the normal, after a turn from z to it.
    c, s = (x / across, y / across) if across else (1.0, 0.0)
    return placed((c * z, -s, x, s * z, c, y, -across, 0.0, z), (0.0, 0.0, 0.0))


def turned_by(element: Element, xyz: Vector, quaternion: Sequence[float]) -> Transform:
    """Return a pose. quaternion: (x, y, z, w). Raises RefusedElement for one of length 0."""
    x, y, z, w = quaternion
    if math.hypot(x, y, z, w) == 0.0:
        element.refuse("a quaternion of length 0")
    return placed(quaternion_matrix(x, y, z, w), xyz)


def unit_axis(element: Element, axis: Vector) -> Vector:
    """Return the axis, scaled to length 1. An axis of length 1 is not changed."""
    length = math.hypot(*axis)
    if not (length > 0.0 and math.isfinite(length)):
        element.refuse("an axis of length 0" if length == 0.0 else "the axis is too long")
    x, y, z = (c / length for c in axis)
    return x, y, z


def check_mimics(joints: Sequence[tuple[Joint, Element]]) -> None:
    """Raise Refused for a joint that mimics itself or a joint that it cannot mimic."""
    by_name = {joint.name: joint for joint, _ in joints}
    for joint, element in joints:
        chain = [joint]
        while (mimic := chain[-1].mimic) is not None:
            leader = by_name.get(mimic.joint)
            if leader is None:  # it does not move
                break
            if leader.freedoms > 1:
                element.refuse(f"{chain[-1].name!r} mimics {leader.name!r}, a {leader.kind} joint")
            if leader in chain:
                element.refuse(f"joint {joint.name!r} indirectly mimics itself", "reference-cycle")
            chain.append(leader)
