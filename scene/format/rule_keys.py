"""A table of `rules` -> Rule."""

from __future__ import annotations

from typing import Any

from satcheck.core.errors import SatcheckError
from satcheck.scene.format.problems import Wrong
from satcheck.scene.format.table import Table
from satcheck.scene.format.values import Reader, boolean, number, one_of, shown, text
from satcheck.scene.rules import KEYS, LENGTHS, SEVERITIES, Rule, Selector
from satcheck.scene.units import parse_length

_KNOWN = frozenset(("a", "b", "reason", *KEYS))
_severity = one_of(SEVERITIES)


def read_rule(table: Table, units: str | None, file: str, line: int) -> Rule | None:
    """Reads one rule; None if it has errors, which the table collects. file, line: its place."""
    found_before = table.problem_count
    table.only(_KNOWN)
    length = length_in(units)
    values: dict[str, Any] = {key: table.read(key, length, None) for key in LENGTHS}
    values |= {
        "a": table.required("a", selector, None),
        "b": table.required("b", selector, None),
        "allowed": table.read("allowed", boolean, None),
        "max_volume": table.read("max_volume", _volume, None),
        "severity": table.read("severity", _severity, None),
        "reason": table.read("reason", text, ""),
    }
    if values["allowed"] and "reason" not in table:
        table.wrong('"reason" is missing: why may these pairs overlap?')
    if table.problem_count > found_before:
        return None
    try:
        return Rule(**values, where=f"{file}:{line}", file=file, line=line)
    except SatcheckError as error:
        table.wrong(error.message, code=error.code)
        return None


def selector(value: Any) -> Selector:
    if not isinstance(value, str):
        raise Wrong(f"a selector expected, not {shown(value)}")
    try:
        return Selector(value)
    except SatcheckError as error:
        raise Wrong(error.message, code=error.code) from None


def length_in(units: str | None) -> Reader[float]:
    """Reads a length such as 0.5; also "2mm" if the scene declares units."""

    def read(value: Any) -> float:
        if not isinstance(value, str):
            return not_negative(value, "length")
        try:
            length = parse_length(value)
        except ValueError as error:
            raise Wrong(str(error)) from None
        try:
            return length.in_units_of(units)
        except ValueError as error:
            raise Wrong(f"{error}, or declare `units` in this file") from None

    return read


def _volume(value: Any) -> float:
    return not_negative(value, "volume")


def not_negative(value: Any, what: str) -> float:
    """A number >= 0. what: its name in the message."""
    limit = number(value)
    if limit < 0:
        raise Wrong(f"a {what} >= 0 expected, not {shown(value)}")
    return limit
