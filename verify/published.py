"""The published schema of a report, and where a document departs from it."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

# Read where it lies, without the import of the room that it belongs to.
SCHEMA_FILE = Path(__file__).parents[1] / "cli" / "report" / "report.schema.json"
LONGEST_MESSAGE = 200

Path_ = tuple[str | int, ...]


@dataclass(frozen=True, slots=True)
class Departure:
    """path: keys and indices, from the document to the value."""

    path: Path_
    message: str

    @property
    def finding(self) -> int | None:
        """The index of the finding that it lies in; None: elsewhere."""
        inside = len(self.path) > 1 and self.path[0] == "findings"
        return int(self.path[1]) if inside else None

    def __str__(self) -> str:
        return f"{_written(self.path) or 'the document'}: {self.message}"


def departures(document: Any) -> Iterator[Departure]:
    """Values of a wrong type, unknown keys and words, missing keys, numbers that are not finite."""
    for error in _validator().iter_errors(document):
        message = str(error.message)
        if len(message) > LONGEST_MESSAGE:
            message = f"{message[: LONGEST_MESSAGE // 2]} ... {message[-LONGEST_MESSAGE // 2 :]}"
        yield Departure(tuple(error.absolute_path), message)
    yield from _numbers_out_of_range(document, ())


@cache
def schema() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(SCHEMA_FILE.read_text("utf-8"))
    return found


@cache
def _validator() -> Any:
    from jsonschema import Draft202012Validator

    return Draft202012Validator(schema())


def _numbers_out_of_range(value: Any, path: Path_) -> Iterator[Departure]:
    """An integer of JSON has any length; a document made in memory may hold infinity."""
    if isinstance(value, float) and not math.isfinite(value):
        yield Departure(path, "not a finite number")
    elif isinstance(value, int) and abs(value) > sys.float_info.max:
        yield Departure(path, "a number out of range")
    elif isinstance(value, dict):
        for key, member in value.items():
            yield from _numbers_out_of_range(member, (*path, key))
    elif isinstance(value, list):
        for number, member in enumerate(value):
            yield from _numbers_out_of_range(member, (*path, number))


def _written(path: Path_) -> str:
    return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in path).lstrip(".")
