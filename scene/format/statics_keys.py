"""The table `statics`, and a table of `rules` with the key `bodies`."""

from __future__ import annotations

from typing import Any

from satcheck.core.conventions import Vector
from satcheck.core.errors import SatcheckError
from satcheck.scene.format.problems import Wrong
from satcheck.scene.format.rule_keys import length_in, not_negative, selector
from satcheck.scene.format.table import Table
from satcheck.scene.format.values import boolean, number, one_of, shown, text, triple
from satcheck.scene.rules import SEVERITIES
from satcheck.scene.statics import KEYS, BodyRule, StaticsTerms

_TERMS = frozenset(("gravity", "friction", "tolerance"))
_KNOWN = frozenset(("bodies", "reason", *KEYS))
_severity = one_of(SEVERITIES)


def read_statics(table: Table, units: str | None) -> StaticsTerms:
    """The terms; errors are collected by the table."""
    table.only(_TERMS)
    return StaticsTerms(
        gravity=table.read("gravity", _direction, None),
        friction=table.read("friction", _friction, None),
        tolerance=table.read("tolerance", length_in(units), None),
    )


def read_body_rule(table: Table, file: str, line: int) -> BodyRule | None:
    """Reads one rule; None if it has errors, which the table collects. file, line: its place."""
    found_before = table.problem_count
    table.only(_KNOWN)
    values: dict[str, Any] = {
        key: table.read(key, boolean, None) for key in ("supported", "stable", "mounted", "region")
    }
    values |= {
        "bodies": table.required("bodies", selector, None),
        "inside": table.read("inside", text, None),
        "density": table.read("density", number, None),
        "mass": table.read("mass", number, None),
        "friction": table.read("friction", _friction, None),
        "severity": table.read("severity", _severity, None),
        "reason": table.read("reason", text, ""),
    }
    if table.problem_count > found_before:
        return None
    try:
        return BodyRule(**values, where=f"{file}:{line}", file=file, line=line)
    except SatcheckError as error:
        table.wrong(error.message, code=error.code)
        return None


def _direction(value: Any) -> Vector:
    direction = triple(value)
    if not any(direction):
        raise Wrong(f"a direction other than 0 expected, not {shown(value)}")
    return direction


def _friction(value: Any) -> float:
    return not_negative(value, "friction")
