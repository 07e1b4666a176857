"""The report as one JSON document: fixed key order, one form for every number, full precision."""

from __future__ import annotations

from json.encoder import encode_basestring
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from satcheck.audit.report import Report

_STEP = "  "


def render(report: Report, *, timings: bool) -> str:
    """The document and a final newline; without timings it is the same bytes every time."""
    return document(report.to_dict(timings))


def document(values: dict[str, Any]) -> str:
    """Any JSON values in that form, and a final newline."""
    return _text(values, "") + "\n"


def _text(value: Any, indent: str) -> str:
    """Objects and lists of objects take a line per member, plain lists (vectors) one line."""
    inner = indent + _STEP
    if isinstance(value, dict):
        members = [f"{_string(key)}: {_text(member, inner)}" for key, member in value.items()]
        return _block("{", members, "}", indent)
    if isinstance(value, list | tuple):
        if any(isinstance(member, dict | list | tuple) for member in value):
            return _block("[", [_text(member, inner) for member in value], "]", indent)
        return f"[{', '.join(_scalar(member) for member in value)}]"
    return _scalar(value)


def _block(opening: str, members: list[str], closing: str, indent: str) -> str:
    if not members:
        return opening + closing
    separator = f",\n{indent}{_STEP}"
    return f"{opening}\n{indent}{_STEP}{separator.join(members)}\n{indent}{closing}"


def _scalar(value: Any) -> str:
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, int | float):
        return repr(value)
    raise TypeError(f"no JSON form for {type(value).__name__}")


def _string(value: str) -> str:
    return encode_basestring(value)
