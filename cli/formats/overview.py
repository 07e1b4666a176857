"""What is said of many assets together, gathered in one pass over them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from msgspec import Struct, field

from satcheck.audit.summary import tool
from satcheck.cli.formats.beside_baseline import BesideBaseline
from satcheck.cli.formats.config import config_lines
from satcheck.cli.formats.order import asset_rank, worst_of
from satcheck.report.assets import Asset, AssetsReport, AssetVerdict, counted, worst_verdict
from satcheck.report.report import NOTHING_TO_CHECK, Issue

# Passing assets are listed up to this many assets.
LISTED = 60
# So many are named in the summary.
NAMED = 3


class Overview(Struct):
    """counts: of each verdict. named: the first assets with each verdict, one more than are shown.
    unchecked: the number of passing assets whose pairs are all allowed; lone: of those with one
    body or none. config: lines about config
    files. shown: assets for a table, the worst first. issues: about what all assets share; least:
    the verdict that these allow at best.
    """

    counts: Counter[AssetVerdict] = field(default_factory=Counter)
    named: dict[AssetVerdict, list[str]] = field(default_factory=dict)
    unchecked: int = 0
    lone: int = 0
    config: dict[str, None] = field(default_factory=dict)
    beside: BesideBaseline = field(default_factory=BesideBaseline)
    shown: list[Asset] = field(default_factory=list)
    issues: tuple[Issue, ...] = ()
    least: AssetVerdict = "pass"

    @property
    def verdict(self) -> AssetVerdict:
        """The worst."""
        return worst_verdict(self.counts + Counter([self.least]))

    def has(self, verdict: AssetVerdict) -> bool:
        return bool(self.counts[verdict]) or verdict == self.least

    def report(self) -> AssetsReport:
        """Without the assets."""
        return AssetsReport(
            tool=tool(),
            verdict=self.verdict,
            counts=counted(self.counts),
            assets=(),
            issues=self.issues,
        )

    @property
    def listed(self) -> int:
        """The number of assets for a table."""
        return self.total if self.total <= LISTED else self.total - self.counts["pass"]

    @property
    def total(self) -> int:
        return self.counts.total()

    def noting(self, assets: Iterable[Asset]) -> Iterator[Asset]:
        for asset in assets:
            self._note(asset)
            yield asset

    def _note(self, asset: Asset) -> None:
        self.counts[asset.verdict] += 1
        named = self.named.setdefault(asset.verdict, [])
        if len(named) <= NAMED:
            named.append(asset.file)
        codes = {issue.code for issue in asset.report.issues} if asset.verdict == "pass" else set()
        self.unchecked += NOTHING_TO_CHECK in codes
        self.lone += asset.verdict == "pass" and len(asset.report.bodies) < 2
        self.config |= dict.fromkeys(config_lines([asset.report]))
        self.beside.note(asset.report)


def overview(
    assets: Iterable[Asset],
    issues: tuple[Issue, ...] = (),
    *,
    least: AssetVerdict = "pass",
    top: int | None = None,
) -> Overview:
    """top: how many assets are shown at most."""
    made = Overview(issues=issues, least=least)
    worst = worst_of(made.noting(assets), top, asset_rank)
    is_short = made.total <= LISTED
    made.shown = [each for each in worst if is_short or each.verdict != "pass"]
    return made
