"""Converts tables of a scene file into typed structs, and says where one is wrong and what is
allowed there. An error hides others of its table alone: those of all tables are told at once."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from msgspec import UNSET, Struct, ValidationError, convert, inspect

from satcheck.core.errors import SatcheckError
from satcheck.scene.errors import Refused
from satcheck.scene.words import meant

if TYPE_CHECKING:
    from satcheck.scene.format.lines import Key, Keys
    from satcheck.scene.format.text import Parsed

T = TypeVar("T")

LARGEST = sys.float_info.max  # as a limit of a number, it refuses infinity and NaN
MOST = 20  # problems reported for one file
_MOST_SHOWN = 40  # characters of a text in a message
_PLACE = re.compile(r" - at `\$((?:\.[\w$]+|\[\d+\])*)`$")  # at the end of an error of msgspec
_type_info = lru_cache(inspect.type_info)  # takes milliseconds, and many bodies may be wrong
_LISTS = (inspect.TupleType, inspect.VarTupleType)
_WORDS: dict[type[inspect.Type], str] = {
    inspect.StructType: "a table",
    inspect.VarTupleType: "a list of tables",
    inspect.BoolType: "true or false",
    inspect.NoneType: "null",
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
        self._found = [Wrong("a second value for this key", *k) for k in parsed.repeated_keys()]

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
    """The error in our words: msgspec names the place, and the type there says what is allowed."""
    place = _PLACE.search(str(error))
    parts = re.findall(r"\.([\w$]+)|\[(\d+)\]", place[1] if place else "")
    keys: Keys = tuple(name or int(index) for name, index in parts)
    if isinstance(cause := error.__cause__, ValueError):
        return Wrong(str(cause), *keys, *(cause.keys if isinstance(cause, Wrong) else ()))
    kind = _type_info(kind)
    for key in keys:
        kind, value = _inner(_form(kind, value), key), value[key]
    form = _form(kind, value)
    if isinstance(value, dict) and isinstance(form, inspect.UnionType):
        return Wrong('"type" is missing', *keys)
    if isinstance(value, dict) and isinstance(form, inspect.StructType):
        fields = {field.encode_name: field for field in form.fields}
        if strange := [key for key in value if key not in {*fields, form.tag_field}]:
            hint = meant(strange[0], fields.keys() - value.keys())
            return Wrong(f"unknown key{hint}", *keys, strange[0])
        if missing := [key for key in fields if fields[key].required and key not in value]:
            return Wrong(f'"{missing[0]}" is missing', *keys)
    is_number = str(error).startswith(("Expected `float", "Number out of range"))
    if is_number and isinstance(value, float | int) and not -LARGEST <= value <= LARGEST:
        message = f"a finite number expected, not {shown(value)}"
        return Wrong(message, *keys, code="non-finite")
    choices = map(str, form.values) if isinstance(form, inspect.LiteralType) else ()
    hint = meant(value, choices) if isinstance(value, str) else ""
    return Wrong(f"{_wanted(kind)} expected, not {shown(value)}{hint}", *keys)


def _form(kind: inspect.Type, value: Any) -> inspect.Type:
    """The type without its remarks; of a choice, the list or the table that the value should be."""
    while isinstance(kind, inspect.Metadata):
        kind = kind.type
    if isinstance(kind, inspect.UnionType):
        for form in (_form(each, value) for each in kind.types):
            if isinstance(form, inspect.StructType) and isinstance(value, dict):
                if value.get(form.tag_field) == form.tag:
                    return form
            elif isinstance(value, list) and isinstance(form, _LISTS):
                return form
    return kind


def _inner(form: inspect.Type, key: Key) -> inspect.Type:
    """The type of a value in a table or in a list."""
    if isinstance(form, inspect.StructType):
        return next(field.type for field in form.fields if field.encode_name == key)
    if isinstance(form, inspect.UnionType):
        tags = (struct.tag for struct in form.types if isinstance(struct, inspect.StructType))
        return inspect.LiteralType(tuple(map(str, tags)))
    if isinstance(form, inspect.TupleType):
        return form.item_types[int(key)]
    assert isinstance(form, inspect.VarTupleType)
    return form.item_type


def _wanted(kind: inspect.Type) -> str:
    """What is allowed, in words."""
    match kind:
        case inspect.Metadata(extra={"wanted": words}):
            return str(words)
        case inspect.Metadata(type=inner):
            return _wanted(inner)
        case inspect.UnionType(types=kinds):
            return " or ".join(map(_wanted, kinds))
        case inspect.LiteralType(values=values):
            return f"one of {', '.join(map(str, values))}"
        case inspect.FloatType(gt=limit):
            return "a number" if limit is None else f"a number above {limit:g}"
        case inspect.TupleType(item_types=items):
            return f"a list of {len(items)}"
    return _WORDS[type(kind)]


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
