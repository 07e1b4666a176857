"""Converts tables of a scene file into typed structs, and says where one is wrong and what is
allowed there. An error hides others of its table alone: those of all tables are told at once."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, get_args

from msgspec import UNSET, Struct, ValidationError, convert

from satcheck.core.errors import SatcheckError
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import options
from satcheck.scene.planar.outline import Shape
from satcheck.scene.rules import SEVERITIES
from satcheck.scene.words import meant

if TYPE_CHECKING:
    from satcheck.scene.scene_file.lines import Key, Keys
    from satcheck.scene.scene_file.text import Parsed

T = TypeVar("T")

LARGEST = sys.float_info.max  # as a limit of a number, it refuses infinity and NaN
MOST = 20  # problems reported for one file
_MOST_SHOWN = 40  # characters of a text in a message
_WORDS = {
    "object": "a table",
    "array": "a list",
    "str": "a text",
    "float": "a number",
    "bool": "true or false",
}
_SHAPES = get_args(Shape)
# Keys whose value is one of some words.
_CHOICES: dict[str, tuple[str, ...]] = {
    "severity": SEVERITIES,
    "type": tuple(shape.__struct_config__.tag for shape in _SHAPES),
    **{name: option.choices for name, (option, _) in options().items()},
}


class Wrong(ValueError):
    """A value is not what its key requires. keys: the path to it."""

    def __init__(self, message: str, *keys: Key, code: str = "bad-scene") -> None:
        super().__init__(message)
        self.message = message
        self.keys: Keys = keys
        self.code = code


class Table(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One table of a scene file. A key that is left out is unset.

    one_of: exactly one of these keys is required. excludes: keys that may not stand beside a key.
    """

    one_of: ClassVar[tuple[str, ...]] = ()
    excludes: ClassVar[Mapping[str, tuple[str, ...]]] = {}

    def __post_init__(self) -> None:
        for key, others in self.excludes.items():
            if getattr(self, key) is not UNSET:
                for other in others:
                    if getattr(self, other) is not UNSET:
                        raise Wrong(f'remove this key, or "{key}": they exclude each other', other)
        stated = [key for key in self.one_of if getattr(self, key) is not UNSET]
        if self.one_of and len(stated) != 1:
            raise Wrong(f"exactly one of {', '.join(self.one_of)} is required")

    def stated(self) -> dict[str, Any]:
        """The keys that it states, with their values."""
        values = ((name, getattr(self, name)) for name in self.__struct_fields__)
        return {name: value for name, value in values if value is not UNSET}


class Problems:
    """Collects what is wrong in one scene file. It starts with the keys that occur twice."""

    def __init__(self, parsed: Parsed) -> None:
        self._parsed = parsed
        from satcheck.scene.scene_file.lines import repeated_keys

        repeated = repeated_keys(parsed.text) if parsed.has_repeated_keys else ()
        self._found = [Wrong("a second value for this key", *keys) for keys in repeated]

    def __bool__(self) -> bool:
        return bool(self._found)

    def add(self, wrong: Wrong) -> None:
        self._found.append(wrong)

    @contextmanager
    def at(self, *keys: Key) -> Iterator[None]:
        """Collects the error that is raised within. keys: the path to what is read there."""
        try:
            yield
        except SatcheckError as error:
            self.add(Wrong(error.message, *keys, code=error.code))
        except Wrong as error:
            self.add(Wrong(error.message, *keys, *error.keys, code=error.code))

    def raise_any(self) -> None:
        """Raises Refused if there are problems: the first in the file, with the rest as
        `others`."""
        if not self._found:
            return
        path, shown = self._parsed.path, self._found[:MOST]
        lines = self._parsed.lines([wrong.keys for wrong in shown])
        errors = [
            Refused(
                wrong.code,
                f"{dotted(wrong.keys)}: {wrong.message}" if wrong.keys else wrong.message,
                file=path,
                line=line,
            )
            for wrong, line in zip(shown, lines, strict=True)
        ]
        errors.sort(key=lambda error: error.line or 0)
        if left := len(self._found[MOST:]):
            errors.append(Refused("bad-scene", f"{left} more errors", file=path))
        raise Refused.combined(errors)


def dotted(keys: Keys) -> str:
    """`bodies[2].position`, counted from 0."""
    text = ""
    for key in keys:
        if isinstance(key, int):
            text += f"[{key}]"
        else:
            plain = key.replace("_", "").replace("-", "").isalnum()
            text += f".{key if plain else repr(key)}"
    return text.removeprefix(".")


def converted(value: Any, kind: type[T]) -> T:
    """The value as a struct or another type. Raises Wrong."""
    try:
        return convert(value, kind)
    except ValidationError as error:
        raise _explained(error, value, kind) from None


def _explained(error: ValidationError, value: Any, kind: Any) -> Wrong:
    """The error in our words, with the path to its place."""
    what, _, place = str(error).partition(" - at `$")
    parts = re.findall(r"\.([\w$]+)|\[(\d+)\]", place)
    keys: Keys = tuple(name or int(index) for name, index in parts)
    if isinstance(cause := error.__cause__, ValueError):
        return Wrong(str(cause), *keys, *(cause.keys if isinstance(cause, Wrong) else ()))
    for key in keys:
        value = value[key]
    if strange := re.search("unknown field `(.*)`", what):
        known = _keys_of(kind, value, inner=bool(keys))
        hint = "" if strange[1] in known else meant(strange[1], known - value.keys())
        return Wrong(f"unknown key{hint}", *keys, strange[1])
    if missing := re.search("missing required field `(.*)`", what):
        return Wrong(f'"{missing[1]}" is missing', *keys)
    is_number = what.startswith(("Expected `float", "Number out of range"))
    if is_number and isinstance(value, float | int) and not -LARGEST <= value <= LARGEST:
        message = f"a finite number expected, not {shown(value)}"
        return Wrong(message, *keys, code="non-finite")
    choices = _CHOICES.get(next((key for key in reversed(keys) if isinstance(key, str)), ""), ())
    hint = meant(value, choices) if isinstance(value, str) else ""
    return Wrong(f"{_wanted(what, choices)} expected, not {shown(value)}{hint}", *keys)


def _keys_of(kind: type[Struct], table: Mapping[str, Any], *, inner: bool) -> set[str]:
    """The keys that a table may have. inner: it lies somewhere in a table of this kind: those of
    its shape, or else of all tables of this form of scene files."""
    shapes = [each for each in _SHAPES if each.__struct_config__.tag == table.get("type")]
    tables = [each for each in Table.__subclasses__() if each.__module__ == kind.__module__]
    near = (shapes or tables) if inner else [kind]
    return {key for each in near for key in each.__struct_encode_fields__}


def _wanted(what: str, choices: Iterable[str]) -> str:
    """What is allowed, in words. what: as msgspec says it."""
    expected = re.match("Expected `(.*?)`([^,]*)", what)
    if expected is None:
        return f"one of {', '.join(choices)}"
    kinds = " or ".join(_WORDS.get(kind, kind) for kind in expected[1].split(" | "))
    limit = expected[2].replace(".0", "").replace(" > ", " above ").replace("length ", "")
    words = (kinds + limit).replace("of >=", "of at least").replace("of <=", "of at most")
    return words.replace("text of at least 1", "non-empty text")


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
        return "a number as large as that" if abs(value) >= 1e300 else f"{value:.6g}"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    return "keys and values" if isinstance(value, dict) else "a date or a time"
