"""The reports of many assets, each checked as a scene of its own: `satcheck.assets/1`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import Literal, get_args

from satcheck.report.report import Issue, Report
from satcheck.report.values import Count, Tool, Value

SCHEMA: Literal["satcheck.assets/1"] = "satcheck.assets/1"
# error: the file or a body in it could not be read.
AssetVerdict = Literal["error", "fail", "incomplete", "pass"]
ASSET_VERDICTS: tuple[AssetVerdict, ...] = get_args(AssetVerdict)


class Asset(Value, frozen=True):
    """file: as given. report: of its bodies; a single body has no findings."""

    file: str
    verdict: AssetVerdict
    report: Report


def asset(file: str, report: Report) -> Asset:
    failed = any(issue.severity == "error" for issue in report.issues)
    return Asset(file, "error" if failed else report.summary.verdict, report)


class AssetCounts(Value, frozen=True, kw_only=True):
    """Number of assets with each verdict. total = error + fail + incomplete + passed."""

    total: Count
    error: Count
    fail: Count
    incomplete: Count
    passed: Count


class AssetsReport(Value, frozen=True, kw_only=True):
    """verdict: the worst of the assets, in the order error, fail, incomplete, pass. issues: about
    what all assets share."""

    schema: Literal["satcheck.assets/1"] = SCHEMA
    tool: Tool
    verdict: AssetVerdict
    counts: AssetCounts
    assets: tuple[Asset, ...]
    issues: tuple[Issue, ...] = ()


def assets_report(
    tool: Tool, assets: Iterable[Asset], issues: tuple[Issue, ...] = ()
) -> AssetsReport:
    """The report of these assets. Without assets it passes."""
    listed = tuple(assets)
    counts = Counter(each.verdict for each in listed)
    return AssetsReport(
        tool=tool,
        verdict=next((verdict for verdict in ASSET_VERDICTS if counts[verdict]), "pass"),
        counts=AssetCounts(
            total=len(listed),
            error=counts["error"],
            fail=counts["fail"],
            incomplete=counts["incomplete"],
            passed=counts["pass"],
        ),
        assets=listed,
        issues=issues,
    )
