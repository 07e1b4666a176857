"""What the kernel could not make, and of which body it is missing."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from msgspec import Struct

from satcheck.plugins.ifc.kernel_log import Message

# Messages about faces that are left out. The mesh then has a hole, which the check of its surface
# finds: the body stays.
_LOST_FACES = frozenset(("GEO159", "GEO162", "GEO184", "GEO198"))
_OF_FACES = ("IfcFace", "IfcFaceBound", "IfcLoop")
# From an instance in a message, these lead up to the products that use it.
_ABOVE = (
    "IfcRepresentationItem",
    "IfcRepresentation",
    "IfcRepresentationMap",
    "IfcProductRepresentation",
    "IfcProfileDef",
    "IfcObjectPlacement",
)


class Failures(Struct, frozen=True):
    """Number of a body -> the first message about something that its shape lacks. faces: number of
    a body -> the number of messages about faces that it lacks."""

    fatal: Mapping[int, Message]
    faces: Mapping[int, int]


def failures_in(model: Any, messages: Iterable[Message], bodies: Collection[int]) -> Failures:
    """bodies: their numbers."""
    fatal: dict[int, Message] = {}
    faces: dict[int, int] = {}
    for message in messages:
        is_error = message.level == "error"
        if message.code in _LOST_FACES or (is_error and _is_of_face(model, message)):
            for number in _concerned(model, message, bodies):
                faces[number] = faces.get(number, 0) + 1
        elif is_error:
            for number in _concerned(model, message, bodies):
                fatal.setdefault(number, message)
    return Failures(fatal, faces)


def _is_of_face(model: Any, message: Message) -> bool:
    number = message.instance_number
    return number is not None and any(map(model.by_id(number).is_a, _OF_FACES))


def _concerned(model: Any, message: Message, bodies: Collection[int]) -> Collection[int]:
    """The bodies that the message is about; all, if it names none."""
    if message.product_number is not None:
        return {message.product_number} & set(bodies)
    if message.instance_number is None:
        return bodies
    return _users(model, message.instance_number) & set(bodies)


def _users(model: Any, number: int) -> set[int]:
    """The products whose shape or place depends on the instance."""
    users, seen, waiting = set(), {number}, [model.by_id(number)]
    while waiting:
        instance = waiting.pop()
        if instance.is_a("IfcProduct"):
            users.add(instance.id())
        elif any(map(instance.is_a, _ABOVE)):
            above = [each for each in model.get_inverse(instance) if each.id() not in seen]
            seen.update(each.id() for each in above)
            waiting += above
    return users
