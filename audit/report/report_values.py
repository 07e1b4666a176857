"""The report as JSON values, each of its parts by the name it has there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from satcheck.audit.report.report import (
    RELATIONS,
    BodyReport,
    EffectReport,
    Finding,
    Issue,
    PairCounts,
    Stage,
    Summary,
)
from satcheck.scene.rules import Rule


def _number(value: float | None) -> float | None:
    """Finite, and without a negative zero."""
    if value is None:
        return None
    if not math.isfinite(value):
        raise ValueError(f"a report holds finite numbers only, not {value!r}")
    return value + 0.0


def _numbers(values: Sequence[float] | None) -> list[float] | None:
    """The same of each."""
    if values is None:
        return None
    if not all(map(math.isfinite, values)):
        raise ValueError(f"a report holds finite numbers only, not {values!r}")
    return [value + 0.0 for value in values]


def summary(one: Summary) -> dict[str, Any]:
    return {
        "verdict": one.verdict,
        "pairs": pair_counts(one.pairs),
        "by_relation": {name: one.by_relation.get(name, 0) for name in RELATIONS},
        "surfaces_only": one.surfaces_only,
        "limits_undecided": one.limits_undecided,
        **({"sweeps_undecided": undecided} if (undecided := one.sweeps_undecided) else {}),
    }


def pair_counts(one: PairCounts) -> dict[str, int]:
    return {
        "total": one.total,
        "pruned": one.pruned,
        "decided": one.decided,
        "allowed": one.allowed,
        "indeterminate": one.indeterminate,
    }


def effect(one: EffectReport, timings: bool) -> dict[str, Any]:
    plain: dict[str, Any] = {
        "effect": one.effect,
        "asked_by": list(one.asked_by),
        "pairs": one.pairs,
        "not_run": dict(one.not_run),
    }
    return plain | {"microseconds": _number(one.microseconds)} if timings else plain


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


def body(one: BodyReport) -> dict[str, Any]:
    error = one.part_error
    return {
        "id": one.id,
        "name": one.name,
        "file": one.file,
        "sha256": one.sha256,
        "path": one.path,
        "shape": one.shape,
        "transform": _numbers(one.transform),
        "groups": list(one.groups),
        "static": one.static,
        "triangles": one.triangles,
        "health": one.health,
        "resolution": _number(one.resolution),
        "convex": one.convex,
        "parts": one.parts,
        "part_error": error
        and {"outside": _number(error.outside), "missing": _number(error.missing)},
    }


def finding(one: Finding, timings: bool = True) -> dict[str, Any]:
    witness = one.witness
    return {
        "id": one.id,
        "a": one.a,
        "b": one.b,
        "rule": one.rule,
        "severity": one.severity,
        "undecided": one.undecided,
        "relation": one.relation,
        "exact_relation": one.exact_relation,
        "tolerance": _number(one.tolerance),
        "distance": _number(one.distance),
        "depth": _number(one.depth),
        "depth_bounds": _numbers(one.depth_bounds),
        "quality": one.quality,
        "normal": _numbers(one.normal),
        "mtv": _numbers(one.mtv),
        "mtv_moves": one.mtv_moves,
        "mtv_verified": one.mtv_verified,
        "witness": witness and {"a": _numbers(witness.a), "b": _numbers(witness.b)},
        "volume": _number(one.volume),
        "volume_error": _number(one.volume_error),
        "contacts": one.contacts and one.contacts.to_dict(),
        **({} if one.motion is None else {"motion": one.motion.to_dict()}),
        "certificate": one.certificate,
        "reason": one.reason,
        "plan": [_stage(stage, timings) for stage in one.plan],
        "baseline_state": one.baseline_state,
    }


def _stage(stage: Stage, timings: bool) -> dict[str, Any]:
    plain: dict[str, Any] = {"stage": stage.stage, "result": stage.result}
    if timings:
        plain["microseconds"] = _number(stage.microseconds)
    plain["detail"] = stage.detail
    return plain


def issue(one: Issue) -> dict[str, Any]:
    return {
        "code": one.code,
        "severity": one.severity,
        "body": one.body,
        "file": one.file,
        "message": one.message,
    }
