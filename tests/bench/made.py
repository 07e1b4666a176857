"""Records of a run that never was: what a pair, its rungs and its stages look like."""

from __future__ import annotations

from typing import Any

from satcheck.audit.tradeoff import RUNGS

Record = dict[str, Any]
LABELS = [name if size is None else f"{name} {size:g}" for name, size in RUNGS]
HEADER = {
    "effort": {"repeat": 3, "rung_seconds": 6.0, "pair_seconds": 12.0, "part_triangles": 3000},
    "environment": {
        "date": "2001-02-03",
        "machine": "an abacus, 2 cores",
        "versions": {"python": "3.11", "satcheck": "0.1.0"},
    },
}


def times(seconds: float) -> dict[str, float]:
    micro = 1e6 * seconds
    return {"median": micro, "low": 0.5 * micro, "high": 2 * micro, "runs": 3}


def row(label: str, **changed: Any) -> Record:
    """A rung that answered rightly after a millisecond, its error 0."""
    name, _, threshold = label.partition(" ")
    made = {
        "rung": name,
        "threshold": float(threshold) if threshold else None,
        "state": "answered",
        "reason": None,
        "overlap": True,
        "proven": True,
        "error": None if name == "boolean" else 0.0,
        "settled_by": None if name == "boolean" else name,
        "cold": times(1e-3),
        "cached": times(1e-4) if name in ("parts", "boolean") else None,
        "cpu": None if name == "boolean" else times(1e-3),
    }
    return made | changed


def silent(label: str, state: str, reason: str) -> Record:
    nothing = dict.fromkeys(("overlap", "error", "settled_by", "cold", "cached", "cpu"))
    return row(label, state=state, reason=reason, proven=False, **nothing)


def record(
    name: str = "pair",
    *,
    relation: str | None = "penetrating",
    bounds: tuple[float, float | None] | None = (-1.0, -0.99),
    picked: str = "exact",
    rows: dict[str, Record] | None = None,
    **stated: Any,
) -> Record:
    """A pair of size 2; rows: instead of those that are right."""
    known = {"overlap": None, "way_out": None, "depth": None, "distance": None} | stated
    overlap = relation not in ("separated", "touching")
    made = {label: row(label, overlap=overlap) for label in LABELS} | (rows or {})
    return {
        "case": {"id": name, "meshes": ["a", "b"], "transforms": None, "stated": known},
        "triangles": [12, 12],
        "size": 2.0,
        "stages": [{"reading": 0.001, "hull": 0.002, "triangles": 0.003, "writing": 0.002}] * 3,
        "process": [{"wall": 0.2, "cpu": 0.1, "megabytes": 25.0}] * 3,
        "pair": {
            "truth": {"relation": relation, "bounds": bounds, "reason": None},
            "default": None if relation is None else picked,
            "rungs": list(made.values()),
        },
        "seconds": 6.0,
    }
