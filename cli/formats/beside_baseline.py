"""How the findings of reports compare with a baseline, in words."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from msgspec import Struct, field

from satcheck.cli.formats.words import counted

if TYPE_CHECKING:
    from satcheck.report.baseline import BaselineState
    from satcheck.report.report import Report

_OPEN: tuple[BaselineState, ...] = ("new", "worse", "undecided")
_UNDECIDED = (
    " Undecided findings need figures: add --depth, --clearance or --volume, and update the "
    "baseline from a report that has them."
)


class BesideBaseline(Struct):
    """states: of the findings of reports that were compared with a baseline."""

    judged: int = 0
    absent: int = 0
    states: Counter[BaselineState | None] = field(default_factory=Counter)

    def note(self, report: Report) -> None:
        if report.baseline is not None:
            self.judged += 1
            self.absent += len(report.baseline.absent)
            self.states.update(finding.baseline_state for finding in report.findings)

    def lines(self) -> list[str]:
        """`Baseline: 2 known findings, 1 new, 1 worse; 1 more passes now: satcheck baseline prune.`
        Nothing without a baseline."""
        if not self.judged:
            return []
        parts = [counted(self.states["unchanged"], "known finding")]
        parts += [f"{self.states[s]:,} {s}" for s in _OPEN if self.states[s]]
        verb = "passes" if self.absent == 1 else "pass"
        gone = f"; {self.absent:,} more {verb} now: satcheck baseline prune" if self.absent else ""
        undecided = _UNDECIDED if self.states["undecided"] else ""
        return [f"Baseline: {', '.join(parts)}{gone}.{undecided}"]


def beside_baseline(report: Report) -> list[str]:
    beside = BesideBaseline()
    beside.note(report)
    return beside.lines()
