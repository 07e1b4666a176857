"""Several worlds in one call, each checked as a scene of its own: one report, one exit code."""

from __future__ import annotations

import os
import sys
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import click
from msgspec.structs import asdict

from satcheck.audit.baseline import read_baseline
from satcheck.audit.batch.check_world import unused_rules, without_unused_rules
from satcheck.audit.batch.local import check_locally
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.slot_server import Wanted
from satcheck.audit.batch.stored import INTERRUPTED, Stored, StoredResults, least_of
from satcheck.audit.words import counted
from satcheck.cli import exit_codes
from satcheck.cli.format_option import Target
from satcheck.cli.formats import worst_page
from satcheck.cli.formats.assets import (
    AssetReports,
    Overview,
    next_step,
    overview,
    summary_line,
    tell_issues,
    written,
)
from satcheck.cli.inputs import Inputs
from satcheck.cli.interrupts import write_before_the_end
from satcheck.cli.option import names_of_lengths
from satcheck.cli.output import Document, issue_line, talk
from satcheck.cli.progress import Bar
from satcheck.cli.rendering import Delivery
from satcheck.cli.worst_findings import Illustrated, with_pictures, worst_findings
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import Asset, Result
from satcheck.report.json import read_line
from satcheck.report.report import NOTHING_TO_CHECK, Issue
from satcheck.report.settings import StatedConfig
from satcheck.scene.asset_files import Assets, asset_files
from satcheck.scene.loader import has_only_rules, read_rules

_LIMITS = Limits()
# Of one asset. Each needs address space, which the limit of a process counts.
_MOST_THREADS = 8


STANDARD_INPUT = "-"
_NAMED = 6


class Drawing(NamedTuple):
    """How a gallery shows its worst findings. root: where the paths in the reports start. folder:
    of a PNG of each. top: how many."""

    root: Path = Path()
    folder: Path | None = None
    allow_outside: bool = False
    top: int = 100


def check_worlds(
    worlds: Sequence[World],
    inputs: Inputs,
    options: Mapping[str, Any],
    baseline: Path | None,
    delivery: Delivery,
    config: StatedConfig | None,
    limits: Limits = _LIMITS,
    *,
    complete: bool = True,
    compares: bool = False,
) -> int:
    """The exit code, that of the worst world. inputs: how files are read. options: those of
    `audit.Settings`. config: the options that come from a config file. limits: for each world.
    complete: these are all worlds; a rule that none of them needs is unused. compares: without a
    pair nothing passes. After Ctrl-C the
    report has the worlds that are done, and says how many are not. Raises KeyboardInterrupt if none
    is.
    """
    forms = delivery.forms
    terms = check_options(inputs, options, baseline, config, places=forms != {"table"})
    document = Document()
    jobs = options["jobs"] or os.cpu_count() or 1
    hashed = not forms.isdisjoint(("json", "html"))
    assets = _check(worlds, terms, limits, jobs, hashed=hashed)
    interrupted = _interrupted(len(worlds) - len(assets), len(worlds))
    shared = frozenset(map(str, inputs.rules))
    found = list(assets.values())
    unused = unused_rules(found, shared) if complete and not interrupted else ()
    stored = [
        Stored(world, (), without_unused_rules(each, shared)) for world, each in assets.items()
    ]
    empty = _nothing_compared(found) if compares else ()
    issues = interrupted or (*empty, *unused)
    seen_assets = (each.asset for each in stored)
    seen = overview(seen_assets, issues, least=least_of(issues), top=delivery.top)
    top = Drawing().top if delivery.top is None else delivery.top
    drawing = Drawing(allow_outside=inputs.allow_outside, top=top)
    deliver_assets(document, seen, stored, delivery, drawing)
    if delivery.quiet or all(target != Target("table", None) for target in delivery.targets):
        _tell_errors(stored)
    if not delivery.quiet:
        tell_assets(seen, delivery)
    if interrupted:
        talk(f"satcheck: {interrupted[0].message}")
        return exit_codes.INTERRUPTED
    return exit_codes.for_counts(seen.verdicts, exit_zero=delivery.exit_zero)


def check_options(
    inputs: Inputs,
    options: Mapping[str, Any],
    baseline: Path | None,
    config: StatedConfig | None,
    *,
    places: bool = True,
) -> CheckOptions:
    """options: those of `audit.Settings`. The others: as in CheckOptions. Raises SatcheckError for
    files that all worlds share: what is wrong there is no fault of one of them."""
    if baseline is not None:
        read_baseline(baseline)
    for path in inputs.rules:
        read_rules(str(path))
    return CheckOptions(
        **asdict(inputs.load_options),
        settings={**options, **inputs.limits},
        names=names_of_lengths(options),
        places=places,
        baseline=None if baseline is None else str(baseline),
        config=config,
    )


def _check(
    worlds: Sequence[World], options: CheckOptions, limits: Limits, jobs: int, *, hashed: bool
) -> dict[World, Asset]:
    """Return the assets in the order of the worlds; after Ctrl-C only those that are done. Raises
    KeyboardInterrupt if none is."""
    threads = max(1, min(jobs // max(1, len(worlds)), _MOST_THREADS))
    wanted = Wanted(kept=False, hashed=hashed, threads=threads)
    assets: dict[World, Asset] = {}
    with Bar("assets") as bar:
        try:
            with closing(check_locally(worlds, options, limits, jobs, wanted)) as answers:
                for each in chain.from_iterable(answers):
                    report = read_line(each.line, Result).report
                    assets[each.world] = Asset(each.world[0], each.verdict, report)
                    if bar is not None:
                        bar(len(assets), len(worlds))
        except KeyboardInterrupt:
            if not assets:
                raise
            write_before_the_end()
    return {world: assets[world] for world in worlds if world in assets}


def _nothing_compared(assets: Sequence[Asset]) -> tuple[Issue, ...]:
    reports = [asset.report for asset in assets]
    if any(report.summary.pairs.asked or report.answers for report in reports):
        return ()
    message = "no pair was checked: each file is a world of its own; --merge puts them into one"
    return (Issue(NOTHING_TO_CHECK, "warning", None, None, message),)


def _interrupted(not_checked: int, total: int) -> tuple[Issue, ...]:
    if not not_checked:
        return ()
    were = "was" if not_checked == 1 else "were"
    message = f"interrupted: {not_checked:,} of {counted(total, 'asset')} {were} not checked"
    return (Issue(INTERRUPTED, "warning", None, None, message),)


def deliver_assets(
    document: Document,
    seen: Overview,
    stored: Collection[Stored] | StoredResults,
    to: Delivery,
    drawing: Drawing,
    *,
    only_shown: bool = False,
) -> None:
    """Deliver documents about assets. only_shown: those that a table shows."""
    assets = AssetReports(lambda: (each.asset for each in stored), len(stored))
    if only_shown:
        assets = AssetReports(lambda: seen.shown, len(seen.shown))
    illustrated: Iterator[Illustrated] = iter(())
    if drawing.folder is not None or "html" in to.forms:
        worst = worst_findings(stored, drawing.top)
        illustrated = with_pictures(
            worst, drawing.folder, drawing.root, allow_outside=drawing.allow_outside
        )
    for form, output in ((target.form, target.output) for target in to.targets):
        # Where no asset changed, stderr says so.
        if output is None and (to.quiet or (form == "table" and not (len(stored) or seen.issues))):
            continue
        if form == "html":
            document.deliver(lambda _: worst_page.render(seen, illustrated), output, utf8=True)
        else:
            text = partial(written, seen, assets, form, timings=to.timings)
            document.deliver(text, output, utf8=form != "table")
    deque(illustrated, maxlen=0)  # what no page has taken


def _tell_errors(stored: Iterable[Stored]) -> None:
    """Say errors on stderr, which a table has in its rows."""
    for asset in (each.asset for each in stored):
        for issue in asset.report.issues:
            if issue.severity == "error":
                line = issue_line(issue)
                talk(f"satcheck: {line if asset.file in line else f'{asset.file}: {line}'}")


def tell_assets(seen: Overview, to: Delivery) -> None:
    """Tell on stderr what no table on standard output says, and where the reports are."""
    files = [str(target.output) for target in to.targets if target.output is not None]
    if files or to.forms != {"table"}:
        tell_issues(seen)
    if files and seen.total:
        talk(" ".join([summary_line(seen), *next_step(seen), f"Report: {', '.join(files)}"]))


def asset_names(inputs: Inputs) -> Assets:
    """Folders and patterns are expanded, and - stands for the names on standard input. A file of
    rules is no asset. click.UsageError if there is none."""
    names: list[str] = []
    for name in inputs.paths:
        names += _standard_input() if name == STANDARD_INPUT else [name]
    assets = asset_files(filter(None, names), inputs.exclude)
    if inputs.exclude:
        talk(f"satcheck: --exclude leaves out {counted(assets.excluded, 'file')}")
    rules = {os.path.realpath(path) for path in inputs.rules}
    files = [
        file
        for file in assets.files
        if os.path.realpath(file) not in rules and not _is_skipped(file)
    ]
    if not files:
        raise click.UsageError("no file is named: give a folder or files")
    return assets._replace(files=files)


def tell_foreign(worlds: Iterable[World]) -> None:
    """`kit: no reader knows 2 files: kit/a.fbx, kit/b.blend`. worlds: of `foreign_worlds`."""
    for folder, *files in worlds:
        named = ", ".join(files[:_NAMED]) + (", ..." if len(files) > _NAMED else "")
        talk(f"satcheck: {folder}: no reader knows {counted(len(files), 'file')}: {named}")


def _is_skipped(file: str) -> bool:
    """Files that only have rules are told, as their rules do not count here."""
    try:
        skipped = has_only_rules(file)
    except SatcheckError:  # the check of this asset says why
        return False
    if skipped:
        talk(f"satcheck: {file} has only rules and is no asset: --rules {file} applies them")
    return skipped


def _standard_input() -> list[str]:
    """A name for each line, or with a NUL behind each. click.UsageError if it is closed."""
    if sys.stdin is None:
        raise click.UsageError("standard input is closed: give a folder or files")
    text = os.fsdecode(sys.stdin.buffer.read()).replace(os.linesep, "\n")
    return text.split("\0" if "\0" in text else "\n")
