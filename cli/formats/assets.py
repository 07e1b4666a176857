"""The reports of many assets as a table: a row for each that does not pass, the worst first, and
the count of all."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from glob import escape
from heapq import nsmallest
from itertools import chain
from math import inf
from pathlib import PurePath
from typing import TYPE_CHECKING, TypeVar

import click
from msgspec import Struct, field

from satcheck.audit.baseline import files_of
from satcheck.audit.batch.check_world import beside_assets
from satcheck.audit.batch.remote import is_url
from satcheck.audit.batch.stored import least_of
from satcheck.audit.messages import clause, failing
from satcheck.audit.summary import tool
from satcheck.audit.words import common_root, counted, rank, with_titles
from satcheck.cli import exit_codes
from satcheck.cli.formats.ci.problems import problems
from satcheck.cli.formats.registry import kind_of, pieces
from satcheck.cli.formats.remarks import codes_counted
from satcheck.cli.formats.summary import BesideBaseline, config_lines, issues_to_tell
from satcheck.cli.formats.tables import (
    ROWS,
    VERDICT_STYLES,
    Column,
    all_begin,
    fitted_each,
    hidden,
    joined,
    table,
)
from satcheck.cli.output import issue_line
from satcheck.report.assets import ASSET_VERDICTS, Asset, AssetsReport, AssetVerdict, worst_verdict
from satcheck.report.assets import counted as counts_of
from satcheck.report.json import render_assets
from satcheck.report.report import NOTHING_TO_CHECK, Issue
from satcheck.scene.opening import is_folder

if TYPE_CHECKING:
    from satcheck.cli.formats.ci.problems import Problem
    from satcheck.cli.output import Page
    from satcheck.report.report import Report

# In a batch: a length of the call has a unit, and the asset has none.
_BAD_SETTING = "bad-setting"
# What one asset does, and what several do.
_VERDICTS: dict[AssetVerdict, tuple[str, str]] = {
    "error": ("has errors", "have errors"),
    "fail": ("fails", "fail"),
    "incomplete": ("incomplete", "incomplete"),
    "pass": ("passes", "pass"),
}
_NOTHING_COMPARED = Issue(
    NOTHING_TO_CHECK,
    "warning",
    None,
    None,
    "no pair was checked: each file is a world of its own; --merge puts them into one",
)
# Letters of the summary with names: two rows of 80.
_MOST = 160
# So many are named in the summary.
NAMED = 3


class AssetReports:
    """Assets, also as `Reports`. make: them anew, as there may be more than fit into memory."""

    def __init__(self, make: Callable[[], Iterable[Asset]], count: int) -> None:
        self._make, self._count = make, count

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[Asset]:
        return iter(self._make())

    def items(self) -> Iterator[tuple[str, Report]]:
        return ((asset.file, asset.report) for asset in self)

    def values(self) -> Iterator[Report]:
        return (asset.report for asset in self)


def written(
    seen: Overview, assets: AssetReports, form: str, page: Page, *, timings: bool
) -> str | Iterable[str]:
    """Return the document about these assets in a format that has no pictures."""
    if form == "json":
        return render_assets(seen.report(), assets, timings=timings)
    if kind_of(form) == "reports":
        return pieces(_with_what_is_open(seen.issues, assets), form)
    return render(seen, page)


def _with_what_is_open(issues: Iterable[Issue], assets: AssetReports) -> AssetReports:
    """Return the assets, and one for each issue about all of them that lets nothing pass: a format
    without a place for these would tell passes alone."""
    beside = [beside_assets(issue) for issue in issues if least_of([issue]) != "pass"]
    return AssetReports(lambda: chain(assets, beside), len(assets) + len(beside))


def render(seen: Overview, page: Page) -> str:
    """Return the whole text, final newline included."""
    root = common_root([file for asset in seen.shown for file in files_of(asset.file)])
    said = hidden(seen.listed - len(seen.shown), "asset") + all_begin(root)
    said += [*map(issue_line, seen.issues), *seen.config, *_summary(seen)]
    said += [*next_step(seen), *_steps_of_folders(seen)]
    lines = _table(seen.shown, root, page) if seen.shown else []
    return joined([*lines, *fitted_each(said, page)], page)


def summary_line(seen: Overview) -> str:
    """Return `FAIL: 39 assets: 2 fail (a.glb, b.glb), 37 pass.`"""
    return " ".join(_summary(seen))


def _summary(seen: Overview) -> list[str]:
    line = _counts(seen, names=True)
    line = line if len(line) <= _MOST else _counts(seen, names=False)
    unchecked = counted(seen.unchecked, "passing asset")
    ruled = [f"No pair of {unchecked} was checked: rules allow them all."] if seen.unchecked else []
    return [line, *ruled, *_warnings(seen), *seen.beside.lines()]


def _warnings(seen: Overview) -> list[str]:
    """`Warnings about 2 passing assets (a.glb, b.glb): 3 open meshes. JSON has all.`"""
    if not seen.warned:
        return []
    more = ", ..." if seen.warned > NAMED else ""
    about = f"Warnings about {counted(seen.warned, 'passing asset')}"
    what = f"{codes_counted(seen.warnings)}. JSON has all."
    line = f"{about} ({', '.join(seen.first_warned)}{more}): {what}"
    return [line if len(line) <= _MOST else f"{about}: {what}"]


def _counts(seen: Overview, *, names: bool) -> str:
    counts, total = seen.counts.copy(), counted(seen.total, "asset")
    counts["pass"] -= seen.folders
    nothing = "of one body each: nothing to compare"
    accepted = [f"{counted(seen.accepted, 'issue')} accepted"] if seen.accepted else []
    if seen.verdict == "pass" and seen.lone == seen.total:
        said = f"{total} ({nothing})" if seen.total else total
        return f"PASS: {', '.join([said, *accepted])}."
    parts = [
        f"{counted(counts[verdict], *words)}{_named(seen, verdict) if names else ''}"
        for verdict, words in _VERDICTS.items()
        if counts[verdict]
    ]
    if seen.lone:
        some = "" if seen.lone == counts["pass"] else f"{seen.lone:,} "
        parts[-1] += f" ({some}{nothing})"
    parts += accepted
    return f"{seen.verdict.upper()}: {': '.join([total, *filter(None, [', '.join(parts)])])}."


def next_step(seen: Overview) -> list[str]:
    ctx = click.get_current_context(silent=True)
    verdict: AssetVerdict = "fail" if seen.named.get("fail") else "incomplete"
    files = (f for f in seen.named.get(verdict, []) if not (is_folder(f) or is_url(f)))
    file = next(files, None)  # a check reads neither folders nor URLs
    if file is None:
        return []
    if ctx is not None and ctx.info_name == "view":
        is_written = bool(ctx.params.get("outputs")) or verdict != "fail"
        return [] if is_written else ["Next: -o worst.html shows the worst pairs."]
    says = "lists its pairs" if verdict == "fail" else "says what is open"
    return [f"Next: {_check_of(file)} {says}."]


def _steps_of_folders(seen: Overview) -> list[str]:
    """How to allow what is meant, and to leave out what cannot be read."""
    ctx = click.get_current_context(silent=True)
    paths = () if ctx is None or ctx.info_name != "batch" else ctx.params["paths"]
    if ctx is None or not paths or not all(map(is_folder, paths)):
        return []
    steps = []
    fails = any(failing(asset.report) for asset in seen.shown)  # else none has an overlap
    if fails and not (ctx.params["rules"] or ctx.params["baseline"]):
        from satcheck.cli.slips import call_of

        line = call_of("suggest", paths, ["-o", "rules.toml"])
        steps.append(f"Next: {line} proposes rules for overlaps that are meant.")
    wrong = [a for a in seen.shown if a.verdict == "error"]
    unmeasured = [a for a in wrong if any(i.code == _BAD_SETTING for i in a.report.issues)]
    if unmeasured:
        steps.append("Next: --units states the unit of files that have none.")
    for asset in [each for each in wrong if each not in unmeasured][:1]:
        name = shlex.quote(escape(PurePath(asset.file).name))
        steps.append(f"Next: --exclude {name} leaves out {asset.file} until it is mended.")
    return steps


def _check_of(asset: str) -> str:
    """With the options of this call, if a command renders."""
    files = files_of(asset)
    if click.get_current_context(silent=True) is None:
        return shlex.join(["satcheck", *files])
    from satcheck.cli.commands import DEFAULT_COMMAND
    from satcheck.cli.slips import call_of

    return call_of(DEFAULT_COMMAND, files)


def _named(seen: Overview, verdict: AssetVerdict) -> str:
    """` (a.glb, b.glb, c.glb, ...)`, the worst first; what passes is not named."""
    files = seen.named.get(verdict, []) if verdict != "pass" else []
    more = ", ..." if seen.counts[verdict] > NAMED else ""
    return f" ({', '.join(files[:NAMED])}{more})" if files else ""


def _table(assets: list[Asset], root: str, page: Page) -> list[str]:
    file, verdict, pairs, worst = zip(*map(cells_of, assets), strict=True)
    columns = (
        Column("asset", tuple(_without(root, name) for name in file), named=True),
        Column("verdict", verdict, graded=True),
        Column("fail", pairs, right=True),
        Column("worst", worst, folds=True),
    )
    return table(columns, page, [VERDICT_STYLES[asset.verdict] for asset in assets])


def _without(root: str, asset: str) -> str:
    return ", ".join(file.removeprefix(root) for file in files_of(asset))


def cells_of(asset: Asset) -> tuple[str, str, str, str]:
    """Return the asset, its verdict, how many of its pairs fail, and its worst problem."""
    report = with_titles(asset.report)
    failed, total = failing(report), asset.report.summary.pairs.total
    pairs = f"{len(failed):,} of {total:,}" if total else ""
    if failed and asset.verdict == "fail":
        return asset.file, asset.verdict, pairs, clause(failed[0], report, brief=True)
    listed = _listed(asset)
    more = f" (and {len(listed) - 1:,} more)" if len(listed) > 1 else ""
    return asset.file, asset.verdict, pairs, f"{listed[0].message}{more}" if listed else ""


def _listed(asset: Asset) -> list[Problem]:
    """Return what the row of an asset tells, the worst first: why it does not pass."""
    listed = [p for p in problems({asset.file: asset.report}) if p.level != "note"]
    return [p for p in listed if p.stops or p.level == "error"] or listed


class Overview(Struct):
    """counts: of each verdict; forgiven: of each if nothing failed. named: the worst assets with
    each verdict, of those that a table may show.
    unchecked: the number of passing assets whose pairs are all allowed; lone: of those with one
    body or none; folders: of those that stand for accepted files which no reader knows, and are no
    assets. compared: the number of assets with a question. accepted: the number of accepted issues.
    config: lines about config files. shown: assets for a table, the worst first. issues: about what
    all assets share.
    """

    counts: Counter[AssetVerdict] = field(default_factory=Counter)
    forgiven: Counter[AssetVerdict] = field(default_factory=Counter)
    named: dict[AssetVerdict, list[str]] = field(default_factory=dict)
    unchecked: int = 0
    lone: int = 0
    folders: int = 0
    compared: int = 0
    accepted: int = 0
    warned: int = 0
    first_warned: list[str] = field(default_factory=list)
    warnings: Counter[str] = field(default_factory=Counter)
    config: dict[str, None] = field(default_factory=dict)
    beside: BesideBaseline = field(default_factory=BesideBaseline)
    shown: list[Asset] = field(default_factory=list)
    issues: tuple[Issue, ...] = ()

    def exit_code(self, *, exit_zero: bool) -> int:
        """Return that of the worst asset. exit_zero: as if nothing failed."""
        counts = self.forgiven if exit_zero else self.counts
        return exit_codes.for_counts(counts + Counter([least_of(self.issues)]))

    @property
    def verdict(self) -> AssetVerdict:
        """The worst of the assets, and of what the issues allow at best."""
        return worst_verdict(self.counts + Counter([least_of(self.issues)]))

    def report(self) -> AssetsReport:
        """Without the assets."""
        return AssetsReport(
            tool=tool(),
            verdict=self.verdict,
            counts=counts_of(self.counts),
            assets=(),
            issues=self.issues,
        )

    @property
    def listed(self) -> int:
        """The number of assets for a table."""
        return self.counts.total() - self.counts["pass"]

    @property
    def total(self) -> int:
        return self.counts.total() - self.folders

    def noting(self, asset: Asset) -> Asset:
        self.counts[asset.verdict] += 1
        fails = asset.verdict == "fail"
        self.forgiven[exit_codes.without_failures(asset.report) if fails else asset.verdict] += 1
        self.compared += bool(asset.report.summary.pairs.asked or asset.report.answers)
        self.accepted += sum(issue.state == "accepted" for issue in asset.report.issues)
        if asset.verdict == "pass":
            is_folder = any(_is_of_folder(issue, asset) for issue in asset.report.issues)
            self.folders += is_folder
            self.unchecked += any(i.code == NOTHING_TO_CHECK for i in asset.report.issues)
            self.lone += not is_folder and len(asset.report.bodies) < 2
            self._note_warnings(asset)
        self.config |= dict.fromkeys(config_lines([asset.report]))
        self.beside.note(asset.report)
        return asset

    def _note_warnings(self, asset: Asset) -> None:
        warnings = Counter(
            issue.code
            for issue in issues_to_tell(asset.report)
            if issue.severity == "warning" and issue.state is None
        )
        del warnings[NOTHING_TO_CHECK]  # told as such
        self.warned += bool(warnings)
        if warnings and self.warned <= NAMED:
            self.first_warned.append(asset.file)
        self.warnings += warnings


def _is_of_folder(issue: Issue, asset: Asset) -> bool:
    """Return whether an issue is about a file that no reader knows, in the folder of this name."""
    return issue.code == "unread-file" and issue.file != asset.file and not asset.report.bodies


def overview(
    assets: Iterable[Asset],
    issues: tuple[Issue, ...] = (),
    *,
    top: int | None = None,
    compares: bool = False,
) -> Overview:
    """Return what is known of the assets. issues: about all of them. top: how many are shown at
    most, the worst first. compares: without a pair nothing passes."""
    made = Overview()
    worst = worst_of(map(made.noting, assets), max(top or 0, ROWS), asset_rank)
    for each in worst:
        made.named.setdefault(each.verdict, []).append(each.file)
    made.shown = [each for each in worst[: top or ROWS] if each.verdict != "pass"]
    empty = (_NOTHING_COMPARED,) if compares and not made.compared else ()
    made.issues = (*empty, *issues)
    return made


_T = TypeVar("_T")


def asset_rank(asset: Asset) -> tuple[float, ...]:
    """The lower the worse: by verdict, then by the worst finding."""
    ranks = (rank(finding, asset.report.units) for finding in asset.report.findings)
    worst = min(ranks, default=(inf,))
    return (ASSET_VERDICTS.index(asset.verdict), *worst)


def worst_of(
    things: Iterable[_T], top: int | None, rank: Callable[[_T], tuple[float, ...]]
) -> list[_T]:
    """The worst ones, at most `top`, from things that may be too many for the memory. Equals keep
    their order."""
    return sorted(things, key=rank) if top is None else nsmallest(top, things, key=rank)
