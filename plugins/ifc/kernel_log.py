"""What IfcOpenShell says while it parses a file and makes shapes.

It goes on after most errors, without the instance at fault. Only its log says so.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import msgspec
from msgspec import Struct

_INSTANCE = re.compile(r"#(\d+)=")


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
