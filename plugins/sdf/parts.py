"""Reads the collisions, or the visuals, of a link of SDFormat."""

from __future__ import annotations

from typing import NamedTuple

from satcheck.core.transform import Transform, compose
from satcheck.plugins.sdf.frames import Frames, Name, Scope
from satcheck.plugins.sdf.geometry import HULL, PLANE, facing, geometry_of, shape_in
from satcheck.plugins.sdf.places import SHAPE
from satcheck.plugins.sdf.values import bits, pose_of
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import Refusal
from satcheck.scene.files.readers import GeometryKind
from satcheck.scene.files.xml_tree import Element, RefusedElement
from satcheck.scene.robot.kinematics import inverse
from satcheck.scene.robot.model import DRAWN_PLANE, Collision
from satcheck.scene.robot.slips import Slips

ALL_BITS = 0xFFFF


class Mask(NamedTuple):
    """Two collisions are checked if the category of one and the mask of the other share a bit."""

    category: int = ALL_BITS
    collide: int = ALL_BITS

    def meets(self, other: Mask) -> bool:
        return bool(self.category & other.collide or other.category & self.collide)


ANY = Mask(-1, -1)  # all bits: of a collision whose masks are not known


class Part(NamedTuple):
    collision: Collision
    mask: Mask


def parts_in(
    link: Element,
    path: str,
    scope: Scope,
    frames: Frames,
    slips: Slips,
    tag: GeometryKind,
) -> list[Part]:
    """path: the frame of the link. scope: in which its poses name frames."""
    parts = []
    for element in link.all(tag):
        name = element.attributes.get("name") or None
        mask = ANY
        try:
            slips.look(element, SHAPE)
            mask = _mask(element)
            shape = _shape(element, slips)
            if shape is None:
                continue
            origin = _origin(element.only("pose"), path, scope, frames)
            geometry = geometry_of(shape)
            if shape.tag == PLANE:
                if tag == "visual":
                    shape.refuse(DRAWN_PLANE, "unsupported-feature")
                origin = compose(origin, facing(shape))
        except RefusedElement as error:
            refused = Refusal(error.code, error.reason)
            part = Collision(name, IDENTITY, refused, error.at, element.file)
            parts.append(Part(part, mask))
        else:
            part = Collision(name, origin, geometry, element.line, element.file)
            parts.append(Part(part, mask))
    return parts


def _shape(element: Element, slips: Slips) -> Element | None:
    """None: it makes no body, and a warning says so unless the file does."""
    shape = shape_in(element)
    if shape is None:
        if not element.need("geometry").all("empty"):
            slips.note("no-shape", element, f"a <{element.tag}> without geometry: no body")
    elif (how := shape.attributes.get("optimization")) and how != HULL:
        cause = f"a simulator replaces this mesh ({how}): the mesh itself is checked"
        slips.note("unread", shape, cause)
    return shape


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
    if contact is None:
        return Mask()
    collide = bits(contact, "collide_bitmask")
    category = bits(contact, "category_bitmask")
    collide = ALL_BITS if collide is None else collide
    return Mask(collide if category is None else category, collide)
