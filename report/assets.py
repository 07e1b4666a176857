"""The reports of many assets, each checked as a scene of its own: `satcheck.assets/1`. A line of
the results of a batch: `satcheck.result/1`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, get_args

from satcheck.report.report import Issue, Report
from satcheck.report.values import Count, Sha256, Tool, Value

SCHEMA: Literal["satcheck.assets/1"] = "satcheck.assets/1"
# error: the file or a body in it could not be read.
AssetVerdict = Literal["error", "fail", "incomplete", "pass"]
ASSET_VERDICTS: tuple[AssetVerdict, ...] = get_args(AssetVerdict)


# The codes of issues about a file or a pair that ended the process of its check.
LEFT_OUT = frozenset({"worker-crashed", "worker-timeout", "worker-out-of-memory"})


class Asset(Value, frozen=True):
    """file: as given. report: of its bodies; a single body has no findings."""

    file: str
    verdict: AssetVerdict
    report: Report


def asset(file: str, report: Report) -> Asset:
    return Asset(file, _verdict(report), report)


def _verdict(report: Report) -> AssetVerdict:
    """Nothing is left out of a pass, not even a body whose pairs are all allowed."""
    if any(issue.severity == "error" for issue in report.issues):
        return "error"
    verdict = report.summary.verdict
    left_out = any(issue.code in LEFT_OUT for issue in report.issues)
    return "incomplete" if verdict == "pass" and left_out else verdict


class AssetCounts(Value, frozen=True, kw_only=True):
    """Number of assets with each verdict. total = error + fail + incomplete + passed."""

    total: Count
    error: Count
    fail: Count
    incomplete: Count
    passed: Count


class AssetsReport(Value, frozen=True, kw_only=True):
    """verdict: the worst of the assets, in the order error, fail, incomplete, pass; an issue may
    make it worse. issues: about what all assets share."""

    schema: Literal["satcheck.assets/1"] = SCHEMA
    tool: Tool
    verdict: AssetVerdict
    counts: AssetCounts
    assets: tuple[Asset, ...]
    issues: tuple[Issue, ...] = ()


def worst_verdict(verdicts: Mapping[AssetVerdict, int]) -> AssetVerdict:
    """verdicts: the number of assets with each."""
    return next((verdict for verdict in ASSET_VERDICTS if verdicts.get(verdict)), "pass")


def counted(verdicts: Mapping[AssetVerdict, int]) -> AssetCounts:
    return AssetCounts(
        total=sum(verdicts.values()),
        error=verdicts.get("error", 0),
        fail=verdicts.get("fail", 0),
        incomplete=verdicts.get("incomplete", 0),
        passed=verdicts.get("pass", 0),
    )


class InputFile(Value, frozen=True):
    """A file that the check has read or looked for. sha256: of its bytes; for a
    folder or a file that cannot be read, of words that say so. None: it was not there. A path that
    ends in `/` stands for the names of the folders in this folder."""

    path: str
    sha256: Sha256 | None


class Result(Value, frozen=True, kw_only=True):
    """files: of the world, as given; the first one names it. inputs: every file that the answer
    depends on. key: of the contents of these, the options and the version of satcheck: the same key
    means the same answer. None: the next run checks this world again, because a process of its
    check was lost, or a file changed meanwhile."""

    schema: Literal["satcheck.result/1"] = "satcheck.result/1"
    files: tuple[str, ...]
    key: Sha256 | None
    verdict: AssetVerdict
    inputs: tuple[InputFile, ...]
    report: Report
