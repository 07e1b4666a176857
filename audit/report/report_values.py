"""The report as JSON values, each of its parts by the name it has there.

A frozen value is an object: its fields in their order, but for those that only some have
(`SAID_IF_KNOWN` of its class). One with a `to_dict` says itself what it is, mappings are JSON
values already. `satcheck.cli._json` writes text by the same rule.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from satcheck.audit.report.report import RELATIONS, Summary
from satcheck.scene.rules import Rule


def plain(value: Any, without: str | None = None) -> Any:
    """JSON values of what a report holds; numbers are finite, and without a negative zero.

    without: the name of a field that is left out wherever it stands.
    """
    if value is None or isinstance(value, str | int):
        return value
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, Sequence):
        return [plain(member, without) for member in value]
    if hasattr(value, "to_dict"):
        return value.to_dict()
    optional = getattr(value, "SAID_IF_KNOWN", ())
    members = ((name, getattr(value, name)) for name in value.__struct_fields__ if name != without)
    return {
        name: plain(member, without)
        for name, member in members
        if member is not None or name not in optional
    }


def _number(value: float | None) -> float | None:
    if value is None:
        return None
    if not math.isfinite(value):
        raise ValueError(f"a report holds finite numbers only, not {value!r}")
    return value + 0.0


def summary(one: Summary) -> dict[str, Any]:
    return {
        "verdict": one.verdict,
        "pairs": plain(one.pairs),
        "by_relation": {name: one.by_relation.get(name, 0) for name in RELATIONS},
        "surfaces_only": one.surfaces_only,
        "limits_undecided": one.limits_undecided,
        "sweeps_undecided": one.sweeps_undecided,
        "disputed": one.disputed,
    }


def rule(one: Rule) -> dict[str, Any]:
    return {
        "a": one.a.text,
        "b": one.b.text,
        "allowed": one.allowed,
        "max_depth": _number(one.max_depth),
        "max_volume": _number(one.max_volume),
        "clearance": _number(one.clearance),
        "tolerance": _number(one.tolerance),
        "severity": one.severity,
        "reason": one.reason,
        "where": one.where,
    }
