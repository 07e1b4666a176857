"""Several worlds in one call, each checked as a scene of its own: one report, one exit code."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from contextlib import closing
from itertools import chain
from pathlib import Path
from typing import Any

from msgspec.structs import asdict

from satcheck.audit.assets import unused_rules, without_unused_rules
from satcheck.audit.baseline_file import read_baseline
from satcheck.audit.batch.check_options import CheckOptions, World
from satcheck.audit.batch.limits import Limits
from satcheck.audit.batch.local import check_locally
from satcheck.audit.batch.slot_server import Answer, Wanted
from satcheck.cli import exit_codes
from satcheck.cli.formats.assets import (
    Assets,
    Overview,
    overview,
    summary_line,
    tell_issues,
    written,
)
from satcheck.cli.formats.words import counted, issue_line
from satcheck.cli.inputs import Inputs
from satcheck.cli.interrupts import write_before_the_end
from satcheck.cli.lengths import names_of_lengths
from satcheck.cli.output import Document, talk
from satcheck.cli.progress import Bar
from satcheck.cli.rendering import Delivery
from satcheck.report.assets import Asset, AssetVerdict
from satcheck.report.batch import Result
from satcheck.report.json import read_line
from satcheck.report.report import NOTHING_TO_CHECK, Issue
from satcheck.report.settings import StatedConfig
from satcheck.scene.loader import read_rules

INTERRUPTED = "interrupted"
_LIMITS = Limits()
# Of one asset. Each needs address space, which the limit of a process counts.
_MOST_THREADS = 8


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
    _deliver(document, seen, assets, delivery, timings=options["timings"])
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


def _deliver(
    document: Document,
    seen: Overview,
    assets: Sequence[Asset],
    delivery: Delivery,
    *,
    timings: bool,
) -> None:
    if delivery.output is None and delivery.quiet:
        return
    if delivery.output is None and delivery.form == "table" and not assets:
        return  # no asset changed, and stderr says so
    made = Assets(lambda: assets, len(assets))
    document.deliver(
        lambda page: written(seen, made, delivery.form, page, timings=timings),
        delivery.output,
        utf8=delivery.form != "table",
    )


def _tell(seen: Overview, assets: Sequence[Asset], output: Path | None) -> None:
    """Errors on stderr; with -o also the warnings about all assets, the summary, and where the
    report is."""
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
