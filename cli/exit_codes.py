"""What the process returns, in one place. Scripts rely on these numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from satcheck.report.assets import AssetVerdict
    from satcheck.report.report import Issue, Report, Verdict
    from satcheck.report.samples import SamplesReport

CLEAN = 0  # everything was checked, and no pair fails
FINDINGS = 1  # bodies overlap more than is allowed, or are closer than their clearance
ERROR = 2  # usage, unreadable input, or a fault of satcheck itself
INCOMPLETE = 3  # no pair is known to fail, but not everything could be checked
INTERRUPTED = 130  # Ctrl-C, the shells' 128 + SIGINT

_BY_VERDICT: dict[AssetVerdict, int] = {
    "pass": CLEAN,
    "fail": FINDINGS,
    "incomplete": INCOMPLETE,
    "error": ERROR,
}


def for_report(report: Report | SamplesReport, *, exit_zero: bool) -> int:
    """Return ERROR when an input could not be used, else by the verdict. exit_zero: as if nothing
    failed."""
    verdict = report.summary.verdict
    if exit_zero and verdict == "fail":
        verdict = without_failures(report)
    return for_verdict(verdict, report.issues)


def for_verdict(verdict: Verdict, issues: Iterable[Issue]) -> int:
    return ERROR if any(issue.severity == "error" for issue in issues) else _BY_VERDICT[verdict]


def without_failures(report: Report | SamplesReport) -> Literal["incomplete", "pass"]:
    """Return the verdict of a report that fails as if nothing failed: what is open stays so."""
    from satcheck.audit.messages import left_open
    from satcheck.report.report import Report

    if isinstance(report, Report):
        return "incomplete" if left_open(report) else "pass"
    return "incomplete" if any(pair.undecided for pair in report.pairs) else "pass"


def for_counts(verdicts: Counter[AssetVerdict]) -> int:
    """By the worst of many verdicts."""
    from satcheck.report.assets import worst_verdict

    return _BY_VERDICT[worst_verdict(verdicts)]
