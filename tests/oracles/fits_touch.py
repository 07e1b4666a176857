"""A fit is not a collision: no overlap is an error while both bodies are closed, neither passes
through the other, and the proven thickness is at most the tolerance. Limits of rules stand apart.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

OVERLAPS = ("penetrating", "contains", "inside", "coincident")
SCHEMA = "satcheck.report/1"
THROUGH = "one body passes through the other"


def collisions_that_fit(report: Mapping[str, Any]) -> list[str]:
    """The pairs of a report, as JSON has it, that contradict that. A thickness is stated of closed
    bodies only."""
    return [f"{f['a']} and {f['b']}" for f in report.get("findings", ()) if _contradicts(f)]


def _contradicts(finding: Mapping[str, Any]) -> bool:
    bounds, tolerance = finding.get("thickness_bounds"), finding.get("tolerance")
    if bounds is None or tolerance is None or finding.get("rule") is not None:
        return False
    relation = finding.get("placed_relation") or finding["relation"]
    is_error = finding["severity"] == "error" and relation in OVERLAPS
    return is_error and bounds[1] <= tolerance and not _passes(finding)


def _passes(finding: Mapping[str, Any]) -> bool:
    """By the components of the overlap, if they are stated, or by the stage that looked for it."""
    listed = (finding.get("components") or {}).get("components", ())
    if any(
        component.get("passes") in ("a-through-b", "b-through-a", "both") for component in listed
    ):
        return True
    return any(
        stage["stage"] == "touch-band" and THROUGH in stage["detail"] for stage in finding["plan"]
    )


def assert_fits_touch(report: Any) -> None:
    if isinstance(report, Mapping) and report.get("schema") == SCHEMA:
        assert collisions_that_fit(report) == []
