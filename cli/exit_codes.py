"""What the process returns, in one place. Scripts rely on these numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

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
    """Return ERROR when an input could not be used, else by the verdict. exit_zero forgives what
    fails, and not what is open."""
    verdict = report.summary.verdict
    if exit_zero and verdict == "fail":
        verdict = "incomplete" if _has_open(report) else "pass"
    return for_verdict(verdict, report.issues)


def for_verdict(verdict: Verdict, issues: Iterable[Issue]) -> int:
    return ERROR if any(issue.severity == "error" for issue in issues) else _BY_VERDICT[verdict]


def _has_open(report: Report | SamplesReport) -> bool:
    from satcheck.audit.messages import left_open
    from satcheck.report.report import Report

    if isinstance(report, Report):
        return bool(left_open(report))
    return any(pair.undecided for pair in report.pairs)


def for_counts(verdicts: Counter[AssetVerdict], *, exit_zero: bool) -> int:
    """By the worst of many verdicts; with exit_zero by the worst that is no finding, as what is not
    checked never passes."""
    from satcheck.report.assets import worst_verdict

    return _BY_VERDICT[worst_verdict({**verdicts, "fail": 0} if exit_zero else verdicts)]
