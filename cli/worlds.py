"""Several worlds in one call, each checked as a scene of its own: one report, one exit code."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from contextlib import closing
from itertools import chain
from pathlib import Path
from typing import Any

import click
from msgspec.structs import asdict

from satcheck.audit.baseline import read_baseline
from satcheck.audit.batch.check_world import unused_rules, without_unused_rules
from satcheck.audit.batch.local import check_locally
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.slot_server import Answer, Wanted
from satcheck.audit.words import counted
from satcheck.cli import exit_codes
from satcheck.cli.formats.assets import (
    AssetReports,
    Overview,
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
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import Asset, AssetVerdict, Result
from satcheck.report.json import read_line
from satcheck.report.report import NOTHING_TO_CHECK, Issue
from satcheck.report.settings import StatedConfig
from satcheck.scene.asset_files import Assets, asset_files
from satcheck.scene.loader import has_only_rules, read_rules

INTERRUPTED = "interrupted"
_LIMITS = Limits()
# Of one asset. Each needs address space, which the limit of a process counts.
_MOST_THREADS = 8


STANDARD_INPUT = "-"
_NAMED = 6


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
    terms = check_options(inputs, options, baseline, config, places=delivery.form != "table")
    document = Document()
    jobs = options["jobs"] or os.cpu_count() or 1
    assets = _check(worlds, terms, limits, jobs, hashed=delivery.form == "json")
    interrupted = _interrupted(len(worlds) - len(assets), len(worlds))
    shared = frozenset(map(str, inputs.rules))
    unused = unused_rules(assets, shared) if complete and not interrupted else ()
    assets = [without_unused_rules(each, shared) for each in assets]
    empty = _nothing_compared(assets) if compares else ()
    least: AssetVerdict = "incomplete" if interrupted or empty else "pass"
    seen = overview(assets, interrupted or (*empty, *unused), least=least, top=delivery.top)
    _deliver(document, seen, assets, delivery)
    if delivery.form != "table" or delivery.output is not None or delivery.quiet:
        _tell(seen, assets, None if delivery.quiet else delivery.output)
    if interrupted:
        talk(f"satcheck: {interrupted[0].message}")
        return exit_codes.INTERRUPTED
    return exit_codes.for_assets(seen.verdict, exit_zero=delivery.exit_zero)


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
) -> list[Asset]:
    """Return the assets in the order of the worlds; after Ctrl-C only those that are done. Raises
    KeyboardInterrupt if none is."""
    threads = max(1, min(jobs // max(1, len(worlds)), _MOST_THREADS))
    wanted = Wanted(kept=False, hashed=hashed, threads=threads)
    assets: dict[World, Asset] = {}
    with Bar("assets") as bar:
        try:
            with closing(check_locally(worlds, options, limits, jobs, wanted)) as answers:
                for each in chain.from_iterable(answers):
                    assets[each.world] = _asset(each)
                    if bar is not None:
                        bar(len(assets), len(worlds))
        except KeyboardInterrupt:
            if not assets:
                raise
            write_before_the_end()
    return [assets[world] for world in worlds if world in assets]


def _asset(answer: Answer) -> Asset:
    report = read_line(answer.line, Result).report
    return Asset(answer.world[0], answer.verdict, report)


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


def _deliver(document: Document, seen: Overview, assets: Sequence[Asset], to: Delivery) -> None:
    if to.output is None and to.quiet:
        return
    if to.output is None and to.form == "table" and not assets:
        return  # no asset changed, and stderr says so
    made = AssetReports(lambda: assets, len(assets))
    document.deliver(
        lambda page: written(seen, made, to.form, page, timings=to.timings),
        to.output,
        utf8=to.form != "table",
    )


def _tell(seen: Overview, assets: Sequence[Asset], output: Path | None) -> None:
    """Say errors on stderr, which a table has in its rows; with -o also the warnings about all
    assets, the summary, and where the report is."""
    for each in assets:
        for issue in each.report.issues:
            if issue.severity == "error":
                line = issue_line(issue)
                talk(f"satcheck: {line}" if each.file in line else f"satcheck: {each.file}: {line}")
    if output is None:
        return
    tell_issues(seen)
    if assets:
        talk(f"{summary_line(seen)} Report: {output}")


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
