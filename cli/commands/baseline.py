"""`satcheck baseline`: the findings that a team accepts for now."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import click
from msgspec.structs import replace

from satcheck.audit.baseline import (
    GONE_ASSETS,
    absent_from,
    asset_key,
    files_of,
    gone_assets,
    known_findings,
    known_undecided,
    of_unknown_depth,
    pruned,
    read_baseline,
    updated,
)
from satcheck.audit.batch.options import named_files
from satcheck.audit.batch.stored import ENDINGS, StoredResults
from satcheck.audit.words import counted
from satcheck.cli import option
from satcheck.cli.click_classes import HELP_NAMES, Group
from satcheck.cli.output import Document, issue_line, talk, write_file
from satcheck.cli.stated_scene import read_stored
from satcheck.core.errors import SatcheckError
from satcheck.report.baseline import Baseline, KnownFinding, KnownUndecided
from satcheck.report.json import document as json_document
from satcheck.report.report import Issue, Report
from satcheck.report.samples import SamplesReport
from satcheck.scene.opening import exists

file_argument = click.argument("file", metavar="BASELINE", type=click.Path(path_type=Path))
acceptance = option.together(
    file_argument,
    option.reports,
    click.option("--reason", default="", metavar="TEXT", help="Why these findings are accepted."),
    click.option(
        "--without-figures",
        is_flag=True,
        help="Accept overlaps of unknown depth, however deep they get.",
    ),
    click.option(
        "--undecided",
        is_flag=True,
        help="Accept pairs too that holes or units leave undecided, for that reason alone.",
    ),
)


@click.group("baseline", cls=Group, context_settings=HELP_NAMES)
def command() -> None:
    """Known findings that do not fail a check.

    REPORT is a JSON report of a check or of `satcheck batch`, or results of that (.jsonl), with the
    options that the check in CI has. `--baseline BASELINE` then fails a check only on findings that
    are new or worse.

    \b
      satcheck batch props -o report.json
      satcheck baseline write baseline.json report.json
      satcheck batch props --baseline baseline.json
    """


@command.command("write", context_settings=HELP_NAMES)
@acceptance
def write(file: Path, reports: Sequence[Path], reason: str, **accepting: bool) -> None:
    """Write a new baseline with the failing findings of reports."""
    if exists(file) and not any(map(exists, reports)):
        raise click.UsageError(f"there is no {reports[0]}: the baseline comes before the reports")
    if exists(file):
        raise click.UsageError(f"{file} exists: `satcheck baseline update` changes it")
    _update(file, Baseline(), reports, reason, **accepting)


@command.command(
    "update", context_settings=HELP_NAMES, short_help="Add findings that are new or worse."
)
@acceptance
def update(file: Path, reports: Sequence[Path], reason: str, **accepting: bool) -> None:
    """Add new findings of reports, and take over figures that are worse or were not known. Other
    findings stay, also those of assets that are gone."""
    _update(file, read_baseline(file), reports, reason, **accepting)


@command.command(
    "prune",
    context_settings=HELP_NAMES,
    short_help="Remove findings that pass now, or whose asset is gone.",
)
@file_argument
@option.reports
def prune(file: Path, reports: Sequence[Path]) -> None:
    """Remove findings of pairs that the reports checked again, and that pass now; and those of
    assets that are gone, and in no report."""
    baseline = read_baseline(file)
    absent, gone = list[KnownFinding](), gone_assets(baseline, file)
    for asset, report in _named_reports(reports, file):
        for name in _names(asset, report, file):
            absent += absent_from(report, baseline, name)
            gone.pop(name, None)
    if gone and gone.keys() == set(baseline.assets):
        message = "all its assets are gone: was it written in another folder?"
        raise click.UsageError(f"{file}: {message}")
    _write(file, baseline, pruned(baseline, absent, gone))


def _update(
    file: Path,
    baseline: Baseline,
    reports: Sequence[Path],
    reason: str,
    *,
    without_figures: bool,
    undecided: bool,
) -> None:
    known: list[KnownFinding] = []
    still_open: list[KnownUndecided] = []
    for asset, report in _named_reports(reports, file):
        found = known_findings(report, asset, reason, unmeasured=without_figures)
        known += _named(found, report, baseline, file)
        still_open += known_undecided(report, asset, reason) if undecided else ()
    after = updated(baseline, known, still_open)
    _refuse_unmeasured(baseline, after)
    _write(file, baseline, after)


def _refuse_unmeasured(before: Baseline, after: Baseline) -> None:
    if new := of_unknown_depth(before, after):
        first = f"{new[0].asset}: " if new[0].asset else ""
        raise click.UsageError(
            f"{counted(len(new), 'overlap')} of unknown depth, first {first}{new[0].a} and "
            f"{new[0].b}: nobody would notice a deeper one. Check again with --depth and write the "
            "baseline from that report, or accept them --without-figures"
        )


def _names(asset: str, report: Report, file: Path) -> set[str]:
    """Return what a baseline may call the input of a report. asset: "" for a plain check."""
    homes = {each.stated_at.file if each.stated_at else each.file for each in report.bodies}
    return {asset, asset_key(homes, file)} if not asset and len(homes) == 1 else {asset}


def _named(
    findings: Sequence[KnownFinding], report: Report, baseline: Baseline, file: Path
) -> Iterator[KnownFinding]:
    """A pair of a plain check under the name of its asset, if the baseline knows that one."""
    known = set(baseline.assets)
    bodies = {body.id: body for body in report.bodies}
    for finding in findings:
        a, b = bodies[finding.a], bodies[finding.b]
        homes = {each.stated_at.file if each.stated_at else each.file for each in (a, b)}
        is_one = len(homes) == 1 and (a.stated_at is not None or a.path != b.path)
        under = replace(finding, asset=asset_key(homes, file))
        yield under if is_one and not finding.asset and under.asset in known else finding


def _entries(baseline: Baseline) -> dict[object, KnownFinding | KnownUndecided]:
    """Return what a baseline holds. A pair may be known to fail, and to be undecided."""
    entries: list[tuple[object, KnownFinding | KnownUndecided]] = []
    entries += [(each.key, each) for each in baseline.findings]
    entries += [(("undecided", each.key), each) for each in baseline.undecided]
    return dict(entries)


def _write(file: Path, before: Baseline, after: Baseline) -> None:
    old, new = _entries(before), _entries(after)
    changed = sum(each != new.get(key, each) for key, each in old.items())
    write_file(file, json_document(after))
    Document().write(
        f"{file}: {counted(len(new), 'finding')}, {len(new.keys() - old):,} added, "
        f"{changed:,} changed, {len(old.keys() - new):,} removed\n"
    )


def _named_reports(paths: Sequence[Path], file: Path) -> Iterator[tuple[str, Report]]:
    """The reports, under the names that a baseline gives to assets."""
    for path in paths:
        if path.suffix.lower() in ENDINGS:
            yield from _of_results(path, file)
            continue
        document = read_stored(path)
        if isinstance(document, Report):
            yield "", document
        elif isinstance(document, SamplesReport):
            reason = "a report of several poses has no findings that a baseline knows"
            raise SatcheckError("bad-report", reason, file=str(path))
        else:
            _tell(document.issues)
            for asset in document.assets:
                yield asset_key(files_of(asset.file), file), asset.report


def _tell(issues: Iterable[Issue]) -> None:
    """Say what lets a whole batch be incomplete: its pairs that were not checked are not known.
    Where the report found assets gone, the baseline may differ by now."""
    for issue in issues:
        if issue.code == GONE_ASSETS:
            continue
        if issue.severity == "error":
            raise SatcheckError(issue.code, issue.message)
        talk(f"satcheck: {issue_line(issue)}")


def _of_results(path: Path, file: Path) -> Iterator[tuple[str, Report]]:
    with StoredResults([path]) as results:
        _tell(results.issues)
        for each in results:
            yield asset_key(named_files(each.files), file), each.asset.report
