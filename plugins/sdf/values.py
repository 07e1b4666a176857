"""Values that SDFormat writes as the text of elements."""

from __future__ import annotations

import re

from satcheck.core.transform import Transform, about_fixed_axes, cos_sin, placed
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot.elements import turned_by
from satcheck.scene.robot.kinematics import from_rpy

_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
# Not as int() reads it, which takes 1_0 and 0b10.
_BITS = re.compile(r"[+-]?(?:0x[0-9a-f]{1,16}|0+|[1-9][0-9]{0,18})", re.ASCII | re.IGNORECASE)
_EULER, _QUATERNION = "euler_rpy", "quat_xyzw"


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
