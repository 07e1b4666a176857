"""The report as one JSON document: fixed key order, one form for every number, full precision."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache
from json.encoder import encode_basestring
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from satcheck.audit.report import Report

_STEP = "  "


def render(report: Report, *, timings: bool) -> list[str]:
    """The document in pieces, final newline included; without timings the same bytes every time.

    Not as one text: the report of a scene can be larger than the scene in memory.
    """
    pieces = ["{"]
    for number, (key, value) in enumerate(report.members(timings)):
        pieces.append(f"{',' if number else ''}\n{_STEP}{_key(key)}")
        if isinstance(value, Iterator):
            pieces += _list_pieces(value, _STEP)
        else:
            pieces.append(_text(value, _STEP))
    pieces.append("\n}\n")
    return pieces


def _list_pieces(members: Iterator[Any], indent: str) -> Iterator[str]:
    inner = indent + _STEP
    number = -1
    for number, member in enumerate(members):
        yield f"{',' if number else '['}\n{inner}{_text(member, inner)}"
    yield "[]" if number < 0 else f"\n{indent}]"


def document(values: dict[str, Any]) -> str:
    """Any JSON values in that form, and a final newline."""
    return _text(values, "") + "\n"


def _text(value: Any, indent: str) -> str:
    """Objects and lists of objects take a line per member, plain lists (vectors) one line."""
    if isinstance(value, dict):
        inner = indent + _STEP
        members = []
        for key, member in value.items():
            form = _SCALARS.get(type(member))  # nine in ten are scalars
            text = _text(member, inner) if form is None else form(member)
            members.append(_key(key) + text)
        return _block("{", members, "}", indent)
    if isinstance(value, list | tuple):
        forms = [_SCALARS.get(type(member)) for member in value]
        if None not in forms:
            return f"[{', '.join(map(_scalar, value))}]"
        inner = indent + _STEP
        return _block("[", [_text(member, inner) for member in value], "]", indent)
    return _scalar(value)


@lru_cache(maxsize=1024)
def _key(key: str) -> str:
    return encode_basestring(key) + ": "


def _block(opening: str, members: list[str], closing: str, indent: str) -> str:
    if not members:
        return opening + closing
    separator = f",\n{indent}{_STEP}"
    return f"{opening}\n{indent}{_STEP}{separator.join(members)}\n{indent}{closing}"


_SCALARS: dict[type, Callable[[Any], str]] = {
    str: encode_basestring,
    float: repr,
    int: repr,
    bool: lambda value: "true" if value else "false",
    type(None): lambda _: "null",
}


def _scalar(value: Any) -> str:
    form = _SCALARS.get(type(value))
    if form is None:
        raise TypeError(f"no JSON form for {type(value).__name__}")
    return form(value)
