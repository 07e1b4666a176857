"""The log of IfcOpenShell: what it could not parse or make, and of which body that is missing.

It goes on after most errors, without the instance at fault. Only its log says so.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Any

import msgspec
from msgspec import Struct

# Messages about faces that are left out. The mesh then has a hole, which the check of its surface
# finds: the body stays.
_LOST_FACES = frozenset(("GEO159", "GEO162", "GEO184", "GEO198"))
_OF_FACES = ("IfcFace", "IfcFaceBound", "IfcLoop")
# From an instance in a message, these lead up to the products that use it.
_ITEMS = ("IfcRepresentationItem", "IfcRepresentation", "IfcRepresentationMap", "IfcProfileDef")
_ABOVE = (*_ITEMS, "IfcProductRepresentation", "IfcObjectPlacement")
_INSTANCE = re.compile(r"#(\d+)=")


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


class Message(Struct, frozen=True):
    """level: "error", "warning" or "notice". code: of the message, such as "GEO192"; "" if it has
    none. product, instance: as in the file, "#12=IfcWall(...)"."""

    level: str
    message: str
    code: str = ""
    product: str = ""
    instance: str = ""

    @property
    def product_number(self) -> int | None:
        return _number(self.product)

    @property
    def instance_number(self) -> int | None:
        return _number(self.instance)

    @property
    def line(self) -> str:
        """The message, and the entity that it is about."""
        entity = self.instance.partition("(")[0].partition("=")
        about = f"{entity[2]} {entity[0]}" if entity[1] else ""
        return " ".join(f"{self.message} {about}".split())


def start_log() -> None:
    """From now on the log is for `logged`, and empty."""
    from ifcopenshell import get_log
    from ifcopenshell.ifcopenshell_wrapper import set_log_format_json

    set_log_format_json()
    get_log()


def logged() -> Iterator[Message]:
    """The messages since the last call that are no notices."""
    from ifcopenshell import get_log

    for line in get_log().splitlines():
        if message := _message(line):
            yield message


def _message(line: str) -> Message | None:
    try:
        message = msgspec.json.decode(line, type=Message)
    except msgspec.DecodeError:  # a line break within a message
        return Message("error", line) if line.strip() else None
    return None if message.level == "notice" else message


def _number(entity: str) -> int | None:
    match = _INSTANCE.match(entity)
    return int(match[1]) if match else None
