"""Readers of single values. Each converts a value of the document, or raises Wrong."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from satcheck.core.conventions import Vector
from satcheck.core.transform import Quaternion
from satcheck.scene.format.problems import Wrong
from satcheck.scene.units import MICROMETRES, unit_of
from satcheck.scene.words import meant

T = TypeVar("T")
Reader = Callable[[Any], T]

_NUMBERS = {int, float}
_MOST_SHOWN = 40  # characters of a text in a message


def text(value: Any) -> str:
    if not isinstance(value, str) or not value:
        raise Wrong(f"a non-empty text expected, not {shown(value)}")
    return value


def known_unit(value: Any) -> str:
    unit = unit_of(text(value))
    if unit is None:
        raise Wrong(f"one of {', '.join(MICROMETRES)} expected, not {shown(value)}")
    return unit


def boolean(value: Any) -> bool:
    if not isinstance(value, bool):
        raise Wrong(f"true or false expected, not {shown(value)}")
    return value


def number(value: Any) -> float:
    """A finite float64."""
    if type(value) is not float:
        if type(value) is not int:
            raise Wrong(f"a number expected, not {shown(value)}")
        try:
            return float(value)
        except OverflowError:
            raise Wrong("a finite number expected", code="non-finite") from None
    if not math.isfinite(value):
        raise Wrong(f"a finite number expected, not {value}", code="non-finite")
    return value


def triple(value: Any) -> Vector:
    """[x, y, z]"""
    x, y, z = _numbers(value, 3, "three")
    return x, y, z


def quadruple(value: Any) -> Quaternion:
    """Four numbers."""
    a, b, c, d = _numbers(value, 4, "four")
    return a, b, c, d


def _numbers(value: Any, count: int, word: str) -> list[float]:
    if not isinstance(value, list):
        raise Wrong(f"{word} numbers expected, not {shown(value)}")
    if len(value) != count:
        raise Wrong(f"{word} numbers expected, not {len(value)}")
    # A large scene has a million numbers, so they are read one by one only to name the wrong one.
    return numbers(value) or items(value, number)


def numbers(values: list[Any]) -> list[float] | None:
    """Each as a finite float64; None if one is not a finite number."""
    if not _NUMBERS.issuperset(map(type, values)):
        return None
    try:
        converted = list(map(float, values))
    except OverflowError:
        return None
    return converted if all(map(math.isfinite, converted)) else None


def items(values: list[Any], read: Reader[T]) -> list[T]:
    """Reads each item. Wrong names the first one at fault."""
    converted = []
    for index, value in enumerate(values):
        try:
            converted.append(read(value))
        except Wrong as wrong:
            raise Wrong(wrong.message, index, *wrong.keys, code=wrong.code) from None
    return converted


def list_of(what: str, read: Reader[T]) -> Reader[list[T]]:
    """what: the items, for the message: "texts"."""

    def read_list(value: Any) -> list[T]:
        if not isinstance(value, list):
            raise Wrong(f"a list of {what} expected, not {shown(value)}")
        return items(value, read)

    return read_list


def one_of(names: Iterable[str]) -> Reader[str]:
    known = list(names)

    def read(value: Any) -> str:
        if value not in known:
            hint = meant(value, known) if isinstance(value, str) else ""
            raise Wrong(f"one of {', '.join(known)} expected, not {shown(value)}{hint}")
        return str(value)

    return read


def shown(value: Any) -> str:
    """A short text for the value, for messages."""
    if isinstance(value, str):
        short = value if len(value) <= _MOST_SHOWN else value[:_MOST_SHOWN] + "..."
        return repr(short)
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None:
        return "null"
    if isinstance(value, int | float):
        return f"{value:.6g}" if abs(value) < 1e300 else "a number as large as that"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    return "keys and values" if isinstance(value, dict) else "a date or a time"
