"""How the findings of reports compare with a baseline, in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

from satcheck.cli.report.words import counted

if TYPE_CHECKING:
    from satcheck.report.report import Report

_UNDECIDED = (
    " Undecided findings need figures: add --depth, --clearance or --volume, and update the "
    "baseline from a report that has them."
)


def beside_baseline(reports: Iterable[Report]) -> list[str]:
    """`Baseline: 2 known findings, 1 new, 1 worse; 1 more passes now: satcheck baseline prune.`
    Nothing without a baseline."""
    judged = [report for report in reports if report.baseline is not None]
    if not judged:
        return []
    states = Counter(finding.baseline_state for report in judged for finding in report.findings)
    absent = sum(len(report.baseline.absent) for report in judged if report.baseline)
    parts = [counted(states["unchanged"], "known finding")]
    parts += [
        f"{count:,} {state}" for state in ("new", "worse", "undecided") if (count := states[state])
    ]
    verb = "passes" if absent == 1 else "pass"
    gone = f"; {absent:,} more {verb} now: satcheck baseline prune" if absent else ""
    return [f"Baseline: {', '.join(parts)}{gone}.{_UNDECIDED if states['undecided'] else ''}"]
