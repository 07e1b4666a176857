"""What the process returns, in one place. Scripts rely on these numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from satcheck.report.assets import AssetVerdict
    from satcheck.report.report import Issue, Verdict

CLEAN = 0  # everything was checked, and no pair fails
FINDINGS = 1  # bodies overlap beyond what rules allow, or are closer than their clearance
ERROR = 2  # usage, unreadable input, or a fault of satcheck itself
INCOMPLETE = 3  # no pair is known to fail, but not everything could be checked
INTERRUPTED = 130  # Ctrl-C, the shells' 128 + SIGINT

_BY_VERDICT: dict[AssetVerdict, int] = {
    "pass": CLEAN,
    "fail": FINDINGS,
    "incomplete": INCOMPLETE,
    "error": ERROR,
}


def for_verdict(verdict: Verdict, issues: Iterable[Issue], *, exit_zero: bool) -> int:
    """ERROR when an input could not be used, else by verdict; exit_zero forgives findings only."""
    if any(issue.severity == "error" for issue in issues):
        return ERROR
    return for_assets(verdict, exit_zero=exit_zero)


def for_assets(verdict: AssetVerdict, *, exit_zero: bool) -> int:
    """By the worst verdict; exit_zero forgives findings only."""
    code = _BY_VERDICT[verdict]
    return CLEAN if exit_zero and code == FINDINGS else code


def for_counts(verdicts: Counter[AssetVerdict], *, exit_zero: bool) -> int:
    """By the worst of many verdicts; with exit_zero by the worst that is no finding, as what is not
    checked never passes."""
    from satcheck.report.assets import worst_verdict

    return _BY_VERDICT[worst_verdict({**verdicts, "fail": 0} if exit_zero else verdicts)]
