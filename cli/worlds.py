"""Several worlds in one call, each checked as a scene of its own: one report, one exit code."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from msgspec.structs import asdict

from satcheck.audit.assets import unused_rules, without_unused_rules
from satcheck.audit.baseline_file import read_baseline
from satcheck.batch.check_options import CheckOptions, World
from satcheck.batch.check_world import check_world
from satcheck.cli import exit_codes
from satcheck.cli.formats.ci import FORMATS as CI_FORMATS
from satcheck.cli.formats.ci import pieces as pieces_for_ci
from satcheck.cli.formats.overview import Overview, overview
from satcheck.cli.formats.words import issue_line
from satcheck.cli.inputs import Inputs
from satcheck.cli.lengths import names_of_lengths
from satcheck.cli.output import Document, Page, talk
from satcheck.cli.progress import Bar
from satcheck.cli.rendering import Delivery
from satcheck.core import keep_freed_memory
from satcheck.report.assets import Asset
from satcheck.report.json import render_assets
from satcheck.report.settings import StatedConfig
from satcheck.scene.loader import read_rules


def check_worlds(
    worlds: Sequence[World],
    inputs: Inputs,
    options: Mapping[str, Any],
    baseline: Path | None,
    delivery: Delivery,
    config: StatedConfig | None,
    *,
    complete: bool = True,
) -> int:
    """The exit code, that of the worst world. inputs: how files are read. options: those of
    `audit.Settings`. config: the options that come from a config file. complete: these are all
    worlds; a rule that none of them needs is unused.
    """
    terms = check_options(inputs, options, baseline, config, places=delivery.form != "table")
    document = Document()
    assets = _check(worlds, terms, delivery.form)
    shared = frozenset(map(str, inputs.rules))
    unused = unused_rules(assets, shared) if complete else ()
    assets = [without_unused_rules(each, shared) for each in assets]
    seen = overview(assets, unused, top=delivery.top)
    _deliver(document, seen, assets, delivery, timings=options["timings"])
    _tell(seen, assets, None if delivery.quiet else delivery.output)
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


def _check(worlds: Sequence[World], options: CheckOptions, form: str) -> list[Asset]:
    keep_freed_memory()
    assets = []
    with Bar("assets") as bar:
        for number, world in enumerate(worlds):
            assets.append(check_world(world, options, hashed=form == "json"))
            if bar is not None:
                bar(number + 1, len(worlds))
    return assets


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
    document.deliver(
        lambda page: _render(seen, assets, delivery, page, timings=timings),
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
    for issue in seen.issues:
        talk(f"satcheck: {issue_line(issue)}")
    if assets:
        from satcheck.cli.formats.assets import summary_line

        talk(f"{summary_line(seen)} Report: {output}")


def _render(
    seen: Overview, assets: Sequence[Asset], delivery: Delivery, page: Page, *, timings: bool
) -> str | Iterable[str]:
    form = delivery.form
    if form == "json":
        return render_assets(seen.report(), assets, timings=timings)
    if form in CI_FORMATS:
        return pieces_for_ci({asset.file: asset.report for asset in assets}, form)
    if not assets:
        return "PASS: 0 assets.\n"
    from satcheck.cli.formats.assets import render

    return render(seen, page)
