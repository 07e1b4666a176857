"""Converts tables of a scene file into typed structs, and says where one is wrong and what is
allowed there."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, TypeVar, get_args

from msgspec import Struct, ValidationError, convert

from satcheck.core.errors import SatcheckError
from satcheck.scene.files.readers import options
from satcheck.scene.planar.outline import Shape
from satcheck.scene.rules import SEVERITIES, Selector
from satcheck.scene.scene_file.document import Choices, Rotation, Waypoint
from satcheck.scene.table import LARGEST, Key, Keys, Wrong
from satcheck.scene.units import parse_length
from satcheck.scene.words import meant, quoted

T = TypeVar("T")

_MOST_SHOWN = 40  # characters of a text in a message
_WORDS = {
    "object": "a table",
    "array": "a list",
    "str": "a text",
    "float": "a number",
    "bool": "true or false",
}
_SHAPES = {shape.__struct_config__.tag: shape for shape in get_args(Shape)}
# Keys whose value is one of some words.
_CHOICES: dict[Key, tuple[str, ...]] = {
    "severity": SEVERITIES,
    "type": (*_SHAPES,),
}
_INNER: dict[Key, type[Struct]] = {"rotation": Rotation, "path": Waypoint}  # tables in tables


def converted(value: Any, kind: type[T], units: str | None = None) -> T:
    """The value as a struct or another type. Raises Wrong. units: of the scene."""
    for key in getattr(kind, "lengths", ()) if isinstance(value, dict) else ():
        if isinstance(value.get(key), str):
            value = value | {key: _length(value[key], units, key)}
    try:
        return convert(value, kind, dec_hook=_selectors)
    except ValidationError as error:
        raise _explained(error, value, kind) from None


def _length(text: str, units: str | None, key: str) -> float:
    """A length such as "2mm", in the units of the scene. Raises Wrong."""
    try:
        length = parse_length(text)
    except ValueError as error:
        raise Wrong(str(error), key) from None
    try:
        return length.in_units_of(units)
    except ValueError as error:
        raise Wrong(f"{error}, or declare `units` in this file", key) from None


def _selectors(kind: type, value: Any) -> Any:
    """The selectors of a text, or of a list of texts. Raises Wrong."""
    if kind is not Choices:
        return _selector(value)
    if isinstance(value, str):
        return Choices((_selector(value),))
    if not isinstance(value, list) or not value:
        raise Wrong(f"a selector or a list of selectors expected, not {shown(value)}")
    return Choices(_selector(text, k) for k, text in enumerate(value))


def _selector(text: Any, *keys: Key) -> Selector:
    if not isinstance(text, str):
        raise Wrong(f"a text expected, not {shown(text)}", *keys)
    try:
        return Selector(text)
    except SatcheckError as error:
        raise Wrong(error.message, *keys, code=error.code) from None


def _explained(error: ValidationError, value: Any, kind: Any) -> Wrong:
    """The error in our words, with the path to its place."""
    what, _, place = str(error).partition(" - at `$")
    parts = re.findall(r"\.([\w$]+)|\[(\d+)\]", place)
    keys: Keys = tuple(name or int(index) for name, index in parts)
    if isinstance(cause := error.__cause__, Wrong):
        return Wrong(cause.message, *keys, *cause.keys, code=cause.code)
    if cause is not None:
        return Wrong(str(cause), *keys)
    for key in keys:
        value = value[key]
    name = next((key for key in reversed(keys) if isinstance(key, str)), "")
    if strange := re.search("unknown field `(.*)`", what):
        known = _keys_of(_INNER.get(name, kind), value, of_shape=name == "shape")
        hint = "" if strange[1] in known else meant(strange[1], known - value.keys())
        return Wrong(f"unknown key{hint}", *keys, strange[1])
    if missing := re.search("missing required field `(.*)`", what):
        return Wrong(f'"{missing[1]}" is missing', *keys)
    is_number = what.startswith(("Expected `float", "Number out of range"))
    if is_number and isinstance(value, float | int) and not -LARGEST <= value <= LARGEST:
        message = f"a finite number expected, not {shown(value)}"
        return Wrong(message, *keys, code="non-finite")
    if keys[-1:] and keys[-1] in getattr(kind, "lengths", ()):
        what = what.replace("| null", "| str")
    choices = _CHOICES.get(name, ()) or _choices_of_option(name)
    hint = meant(value, choices) if isinstance(value, str) else ""
    return Wrong(f"{_wanted(what, choices)} expected, not {shown(value)}{hint}", *keys)


def _choices_of_option(name: Key) -> tuple[str, ...]:
    """The words that an option of a reader takes; other packages may have brought it by now."""
    known = options()
    return known[name][0].choices if isinstance(name, str) and name in known else ()


def _keys_of(kind: type[Struct], table: Any, *, of_shape: bool) -> set[str]:
    """The keys that a table may have; those of all shapes for one of an unknown type."""
    shapes = [_SHAPES[table["type"]]] if table.get("type") in _SHAPES else _SHAPES.values()
    kinds: Iterable[type[Struct]] = shapes if of_shape else [kind]
    return {key for each in kinds for key in each.__struct_encode_fields__}


def _wanted(what: str, choices: Iterable[str]) -> str:
    """What is allowed, in words. what: as msgspec says it."""
    expected = re.match("Expected `(.*?)`([^,]*)", what)
    if expected is None:
        return f"one of {', '.join(choices)}"
    kinds = (kind for kind in expected[1].split(" | ") if kind != "null")
    limit = expected[2].replace(".0", "").replace(" > ", " above ").replace("length ", "")
    words = " or ".join(_WORDS.get(kind, kind) for kind in kinds) + limit
    words = words.replace("of >=", "of at least").replace("of <=", "of at most")
    return words.replace("text of at least 1", "non-empty text")


def shown(value: Any) -> str:
    """A short text for the value, for messages."""
    if isinstance(value, str):
        return quoted(value, _MOST_SHOWN)
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None:
        return "null"
    if isinstance(value, int | float):
        return "a number as large as that" if abs(value) >= 1e300 else f"{value:.6g}"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    return "keys and values" if isinstance(value, dict) else "a date or a time"
