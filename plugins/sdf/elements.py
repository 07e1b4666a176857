"""Reads what SDFormat writes into elements: values as their texts, poses, and the collisions, or
the visuals, of a link."""

from __future__ import annotations

import re
from typing import NamedTuple

from satcheck.core.conventions import Vector
from satcheck.core.transform import Transform, about_fixed_axes, compose, cos_sin, placed
from satcheck.plugins.sdf.frames import Frames, Name, Scope
from satcheck.plugins.sdf.places import SHAPE
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.files.xml_tree import Element, RefusedElement
from satcheck.scene.robot.elements import (
    MESH,
    SHAPES,
    ShapeForm,
    collision_of,
    only_shape,
    refused,
    turned_by,
)
from satcheck.scene.robot.kinematics import from_rpy, inverse
from satcheck.scene.robot.model import Collision, Mask, MeshReference
from satcheck.scene.robot.slips import Slips

ALL_BITS = 0xFFFF
_HULL = "convex_hull"  # the optimization of a mesh
_EMPTY = "empty"
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
# Not as int() reads it, which takes 1_0 and 0b10.
_BITS = re.compile(r"[+-]?(?:0x[0-9a-f]{1,16}|0+|[1-9][0-9]{0,18})", re.ASCII | re.IGNORECASE)
_EULER, _QUATERNION = "euler_rpy", "quat_xyzw"
ANY = Mask(-1, -1, "any collide_bitmask")  # of a collision whose masks are not known


def text_of(element: Element, tag: str) -> str:
    """The text of a required child, which may not be empty."""
    child = element.need(tag)
    return child.text or child.refuse("is empty")


def numbers(
    element: Element, tag: str, count: int, default: tuple[float, ...] | None = None
) -> tuple[float, ...]:
    """Of a child, which is required if there is no default."""
    child = element.only(tag)
    if child is None and default is not None:
        return default
    return (child or element.need(tag)).text_numbers(count)


def number(element: Element, tag: str, default: float) -> float:
    return numbers(element, tag, 1, (default,))[0]


def boolean(element: Element, tag: str, default: bool, instead: Element | None = None) -> bool:
    """Of a child. instead: an element that overrides it."""
    child = instead or element.only(tag)
    return default if child is None else truth(child, child.text)


def truth(element: Element, text: str) -> bool:
    """The Boolean that the text is. element: where it stands."""
    value = _BOOLEANS.get(text.strip().lower())
    return element.refuse(f'"{text}" should be true or false') if value is None else value


def flag(element: Element, attribute: str) -> bool:
    """An attribute that is false if it is missing."""
    return truth(element, element.attributes.get(attribute) or "false")


def bits(element: Element | None, tag: str, default: int) -> int:
    """A mask of bits, such as 0x0f."""
    child = element.only(tag) if element else None
    if child is None:
        return default
    if not _BITS.fullmatch(child.text):
        child.refuse(f'"{child.text}" should be a whole number')
    return int(child.text, 0)


def pose_of(element: Element | None) -> Transform:
    """The pose that a <pose> states, in the frame that it is relative to."""
    if element is None or not element.text:
        return IDENTITY
    form = element.attributes.get("rotation_format") or _EULER
    degrees = flag(element, "degrees")
    if form == _QUATERNION:
        if degrees:
            element.refuse("a quaternion has no degrees")
        x, y, z, *quaternion = element.text_numbers(7)
        return turned_by(element, (x, y, z), quaternion)
    if form != _EULER:
        element.refuse(f"rotation_format {form!r} is none of {_EULER}, {_QUATERNION}")
    x, y, z, *angles = element.text_numbers(6)
    if degrees:
        roll, pitch, yaw = map(cos_sin, angles)
        return placed(about_fixed_axes(roll, pitch, yaw), (x, y, z))
    return from_rpy((x, y, z), (angles[0], angles[1], angles[2]))


class Part(NamedTuple):
    collision: Collision
    mask: Mask


def parts_in(link: Element, path: str, scope: Scope, frames: Frames, slips: Slips) -> list[Part]:
    """path: the frame of the link. scope: in which its poses name frames."""
    parts = []
    for element in link.all(slips.geometry):
        mask = ANY
        try:
            slips.look(element, SHAPE)
            mask = _mask(element)
            shape = _shape(element, slips)
            if shape is None:
                continue
            origin = _origin(element.only("pose"), path, scope, frames)
            part = collision_of(element, shape, origin, slips.geometry, _SHAPES)
        except RefusedElement as error:
            part = refused(element, error)
        parts.append(Part(part, mask))
    return parts


def _shape(element: Element, slips: Slips) -> Element | None:
    """None: it makes no body, and a warning says so unless the file does."""
    shape = only_shape(element.need("geometry"))
    if shape is None:
        slips.note("no-shape", element, f"a <{element.tag}> without geometry: no body")
    elif shape.tag == _EMPTY:
        return None
    elif (how := shape.attributes.get("optimization")) and how != _HULL:
        cause = f"a simulator replaces this mesh ({how}): the mesh itself is checked"
        slips.note("unread", shape, cause)
    return shape


def _mesh(shape: Element, scale: Vector) -> MeshReference:
    if (submesh := shape.only("submesh")) is not None:
        submesh.refuse("a part of a mesh file is not read", "unsupported-feature")
    # Converters of early versions leave a second <uri> with this text.
    uris = [uri for uri in shape.all("uri") if uri.text != "__default__"]
    if not uris:
        shape.refuse("<uri> is missing")
    if len(uris) > 1:
        uris[1].refuse("a second <uri> in one <mesh>")
    uri = uris[0].text or uris[0].refuse("is empty")
    return MeshReference(uri, scale, hull=shape.attributes.get("optimization") == _HULL)


_SHAPES = ShapeForm((MESH, *SHAPES), numbers, _mesh, normal=(0.0, 0.0, 1.0))


def _origin(pose: Element | None, link: str, scope: Scope, frames: Frames) -> Transform:
    """The pose in the frame of the link."""
    name = frame_named(pose, scope)
    if name is None:
        return pose_of(pose)
    frame = compose(inverse(frames.world(link)), frames.world(frames.find(name)))
    return compose(frame, pose_of(pose))


def frame_named(pose: Element | None, scope: Scope) -> Name | None:
    """The frame that a <pose> is relative to; None: it names none."""
    if pose is None:
        return None
    text = pose.attributes.get("relative_to") or pose.attributes.get("frame")  # until SDF 1.6
    return Name(scope, text, pose) if text else None


def _mask(element: Element) -> Mask:
    surface = element.only("surface")
    contact = surface.only("contact") if surface else None
    collide = bits(contact, "collide_bitmask", ALL_BITS)
    category = bits(contact, "category_bitmask", collide)
    name = f"collide_bitmask {collide:#06x}"
    alike = category == collide
    return Mask(category, collide, name if alike else f"{name}, category_bitmask {category:#06x}")
