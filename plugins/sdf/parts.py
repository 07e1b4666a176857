"""Reads the collisions, or the visuals, of a link of SDFormat."""

from __future__ import annotations

from typing import NamedTuple

from satcheck.core.conventions import Vector
from satcheck.core.transform import Transform, compose
from satcheck.plugins.sdf.frames import Frames, Name, Scope
from satcheck.plugins.sdf.places import SHAPE
from satcheck.plugins.sdf.values import bits, numbers, pose_of
from satcheck.scene.files.xml_tree import Element, RefusedElement
from satcheck.scene.robot.elements import (
    MESH,
    SHAPES,
    ShapeForm,
    collision_of,
    only_shape,
    refused,
)
from satcheck.scene.robot.kinematics import inverse
from satcheck.scene.robot.model import Collision, Mask, MeshReference
from satcheck.scene.robot.slips import Slips

ALL_BITS = 0xFFFF
_HULL = "convex_hull"  # the optimization of a mesh
_EMPTY = "empty"


ANY = Mask(-1, -1, "any collide_bitmask")  # of a collision whose masks are not known


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
