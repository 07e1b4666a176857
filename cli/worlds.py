"""Several worlds in one call, each checked as a scene of its own: one report, one exit code."""

from __future__ import annotations

import os
import shlex
import sys
from collections import deque
from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, cast

import click

from satcheck.audit.baseline import about_gone_assets, read_baseline
from satcheck.audit.batch.local import check_locally
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.remote import is_url, local_results
from satcheck.audit.batch.results import PART, ResultsFile
from satcheck.audit.batch.run import Engine, Tally, run
from satcheck.audit.batch.slot_server import Answer, Wanted
from satcheck.audit.batch.stored import INTERRUPTED, NewResults, Stored, StoredResults
from satcheck.audit.words import counted
from satcheck.cli import exit_codes
from satcheck.cli.format_option import Target
from satcheck.cli.inputs import Inputs
from satcheck.cli.interrupts import write_before_the_end
from satcheck.cli.option import origin_of
from satcheck.cli.output import Document, cannot_write, issue_line, talk, tell_issues
from satcheck.cli.progress import Bar
from satcheck.cli.rendering import Delivery
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import ASSET_VERDICTS
from satcheck.report.report import Issue
from satcheck.report.settings import StatedConfig
from satcheck.scene.access import Permitted
from satcheck.scene.asset_files import Assets, asset_files
from satcheck.scene.loader import LoadOptions, has_only_rules, read_rules
from satcheck.scene.opening import STANDARD_INPUT
from satcheck.scene.units import Length
from satcheck.scene.words import listed

if TYPE_CHECKING:
    from satcheck.cli.formats.assets import Overview
    from satcheck.cli.worst_findings import Drawing, Illustrated

_LIMITS = Limits()
# Of one asset. Each needs address space, which the limit of a process counts.
_MOST_THREADS = 8
# What to do where a temporary file of results finds no place.
_ELSEWHERE = "name another folder in TMPDIR, or a file for the results, -o results.jsonl"


def check_worlds(
    worlds: Sequence[World],
    terms: CheckOptions,
    to: Delivery,
    limits: Limits = _LIMITS,
    *,
    complete: bool = True,
    compares: bool = False,
    results: str | None = None,
    resume: bool = False,
    engine: Callable[..., Generator[list[Answer]]] = check_locally,
    scheduler: str | None = None,
) -> int:
    """Check worlds into a file of results, write the documents from it, and return the exit code,
    that of the worst world.

    terms: of `check_options`. limits: for each world. complete: these are all worlds; a rule that
    none of them needs is unused. compares: without a pair nothing passes. results: the file or URL;
    None: a file for this call, whose results have times. resume: keep its results that hold.
    scheduler: of another engine than the local one. After Ctrl-C a file for this call has the
    worlds that are done, and the report says how many are not. Raises KeyboardInterrupt if none is,
    and where the file stays.
    """
    document = Document()
    stays, is_alone = results is not None, not to.targets
    how = {"scheduler": scheduler} if scheduler else _of_slots(terms, len(worlds), kept=stays)
    check = partial(engine, options=terms, limits=limits, **how)
    with _temporary_folder() as folder:
        path = results or os.path.join(folder, "results.jsonl")  # noqa: PTH118  may be a URL
        try:
            tally, seen = _run(
                worlds, terms, limits, check, path, resume=resume, stays=stays, is_alone=is_alone
            )
        except SatcheckError as error:
            if stays or error.code != "cannot-write":
                raise
            raise click.ClickException(f"{error}: {_ELSEWHERE} [{error.code}]") from None
        if results is not None and not to.quiet:
            talk(_summary(tally, seen, results))
        left = len(worlds) - tally.done
        issues = _interrupted(left, len(worlds)) if left else (tally.unused or ()) * complete
        issues += _about_baseline(terms)
        if seen is not None:
            tell_issues(() if to.quiet else issues)
            return seen.exit_code(exit_zero=to.exit_zero)
        new = nullcontext(NewResults(Path(path), tally.done))
        read = StoredResults([Path(path)]) if stays else new
        deliver = partial(_deliver, document, read, issues, to, terms.allow_outside)
        compares, is_broken_off = compares and not left, bool(left)
        try:
            seen = deliver(compares, undrawn=is_broken_off)
        except KeyboardInterrupt:
            if stays or document.is_begun:
                raise
            write_before_the_end()
            seen, is_broken_off = deliver(compares, undrawn=True), True
    if left:
        talk(f"satcheck: {issues[0].message}")
    return exit_codes.INTERRUPTED if is_broken_off else seen.exit_code(exit_zero=to.exit_zero)


def _about_baseline(terms: CheckOptions) -> tuple[Issue, ...]:
    """Return what no single world tells."""
    if terms.baseline is None:
        return ()
    file = Path(terms.baseline)
    return about_gone_assets(read_baseline(file), file)


def _of_slots(terms: CheckOptions, worlds: int, *, kept: bool) -> dict[str, Any]:
    """Return how many slots check these worlds, and with how many threads."""
    jobs = cast("int", terms.settings["jobs"]) or os.cpu_count() or 1
    threads = max(1, min(jobs // max(1, worlds), _MOST_THREADS))
    return {"slots": jobs, "wanted": Wanted(kept=kept, threads=threads)}


def _deliver(
    document: Document,
    read: AbstractContextManager[StoredResults | NewResults],
    issues: tuple[Issue, ...],
    to: Delivery,
    allow_outside: bool,
    compares: bool,
    *,
    undrawn: bool,
) -> Overview:
    """Write the documents of a file of results. undrawn: after Ctrl-C, as each picture would take
    as long as a check."""
    from satcheck.cli.formats.assets import overview
    from satcheck.cli.worst_findings import Drawing

    with read as stored:
        found = (each.asset for each in stored)
        seen = overview(found, issues, top=to.top, compares=compares)
        drawing = Drawing(
            allow_outside=allow_outside,
            top=to.top or Drawing().top,
            undrawn="interrupted" if undrawn else "",
        )
        deliver_assets(document, seen, stored, to, drawing)
        if to.quiet or Target("table", None) not in to.targets:
            _tell_errors(stored)
    if not to.quiet:
        tell_assets(seen, to)
    return seen


def _temporary_folder() -> TemporaryDirectory[str]:
    try:
        return TemporaryDirectory(prefix="satcheck-", ignore_cleanup_errors=True)
    except OSError as error:
        raise cannot_write("a temporary file", f"{error.strerror}: {_ELSEWHERE}") from None


def _run(
    worlds: Sequence[World],
    terms: CheckOptions,
    limits: Limits,
    engine: Engine,
    output: str,
    *,
    resume: bool,
    stays: bool,
    is_alone: bool,
) -> tuple[Tally, Overview | None]:
    """Check the worlds into the file of results. Return how many have which verdict, and what is
    known of them where no other document shows it. stays: after this call. Of a file that does not,
    Ctrl-C keeps what is done. is_alone: no other document is made of it."""
    local = local_results(output, PART) if is_url(output) else nullcontext(Path(output))
    with local as path, ResultsFile(path, stays=stays) as results, Bar("assets") as bar:
        if not resume and (existing := results.existing()) is not None:
            reason = "has results: --resume keeps those that still hold; or remove the file"
            named = output if is_url(output) else str(existing)
            raise SatcheckError("results-exist", reason, file=named)
        tally = Tally(len(worlds))

        def show(reached: Tally) -> None:
            nonlocal tally
            tally = reached
            if bar is not None:
                bar(tally.done, tally.total, _but_passes(tally))

        try:
            run(worlds, terms, limits, engine, results, show)
        except (KeyboardInterrupt, SatcheckError) as error:
            if is_url(output) or not stays:
                write_before_the_end()
            if not tally.done or (not stays and isinstance(error, SatcheckError)):
                raise
            if stays:
                place = output if is_url(output) else str(results.part)
                talk(f"satcheck: {_recorded(tally, place)}")
                raise
            results.finish()
        seen = None
        if is_alone:
            from satcheck.cli.formats.assets import overview

            new = nullcontext(NewResults(path, tally.done))
            with StoredResults([path]) if tally.kept else new as stored:
                seen = overview(each.asset for each in stored)
    return tally, seen


def _recorded(tally: Tally, place: str) -> str:
    done = f"{tally.done:,} of {counted(tally.total, 'asset')} are recorded in {place}"
    return f"{done}: the same command with --resume checks the others"


def _but_passes(tally: Tally) -> str:
    """Return `1 error, 5 fail`."""
    counts = ((tally.verdicts[verdict], verdict) for verdict in ASSET_VERDICTS)
    return ", ".join(
        f"{count:,} {verdict}" for count, verdict in counts if verdict != "pass" and count
    )


def _summary(tally: Tally, seen: Overview | None, output: str) -> str:
    """Return what a run says of its results. seen: where no other document shows them."""
    kept = f" ({tally.kept:,} kept)" if tally.kept else ""
    if seen is None:
        return f"{counted(tally.total, 'asset')}{kept}. Results: {output}"
    from satcheck.cli.formats.assets import summary_line

    shows = ""
    if seen.listed and not is_url(output):
        line = shlex.join(["satcheck", "view", output, "-o", "gallery.html"])
        shows = f"\nNext: {line} shows the worst findings."
    return f"{summary_line(seen)} Results: {output}{kept}{shows}"


def check_options(
    inputs: Inputs,
    options: Mapping[str, Any],
    baseline: Path | None,
    config: StatedConfig | None,
) -> CheckOptions:
    """options: those of `audit.Settings`. The others: as in CheckOptions. Raises SatcheckError for
    files that all worlds share: what is wrong there is no fault of one of them."""
    if baseline is not None:
        read_baseline(baseline)
    for path in inputs.rules:
        read_rules(path, inputs.permitted)
    return CheckOptions(
        **{name: getattr(inputs, name) for name in LoadOptions.__struct_fields__},
        settings=options,
        names={name: origin_of(name) for name, each in options.items() if isinstance(each, Length)},
        baseline=None if baseline is None else str(baseline),
        config=config,
    )


def _interrupted(not_checked: int, total: int) -> tuple[Issue, ...]:
    were = "was" if not_checked == 1 else "were"
    message = f"interrupted: {not_checked:,} of {counted(total, 'asset')} {were} not checked"
    return (Issue(INTERRUPTED, "warning", None, None, message),)


def deliver_assets(
    document: Document,
    seen: Overview,
    stored: Collection[Stored] | StoredResults | NewResults,
    to: Delivery,
    drawing: Drawing,
    *,
    only_shown: bool = False,
) -> None:
    """Deliver documents about assets. only_shown: those that a table shows."""
    from satcheck.cli.formats import worst_page
    from satcheck.cli.formats.assets import AssetReports, written
    from satcheck.cli.worst_findings import with_pictures, worst_findings

    assets = AssetReports(lambda: (each.asset for each in stored), len(stored))
    if only_shown:
        assets = AssetReports(lambda: seen.shown, len(seen.shown))
    illustrated: Iterator[Illustrated] = iter(())
    if drawing.folder is not None or "html" in to.forms:
        worst = worst_findings(stored, drawing.top)
        illustrated = with_pictures(worst, drawing)
    for form, output in to.targets:
        # Where no asset changed, stderr says so.
        is_blank = form == "table" and not (len(stored) or seen.issues)
        if output is None and (is_blank or not to.shows):
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
    from satcheck.cli.formats.assets import next_step, summary_line

    files = [str(target.output) for target in to.targets if target.output is not None]
    if files or to.forms != {"table"}:
        tell_issues(seen.issues)
    if files and seen.total:
        talk(" ".join([summary_line(seen), *next_step(seen), f"Report: {', '.join(files)}"]))


def asset_names(inputs: Inputs) -> Assets:
    """Folders and patterns are expanded, and - stands for the names on standard input. A file of
    rules is no asset. click.UsageError if there is none."""
    names: list[str] = []
    for name in inputs.paths:
        names += _standard_input() if name == STANDARD_INPUT else [name]
    assets = asset_files(filter(None, names), inputs.exclude, inputs.permitted)
    if inputs.exclude:
        talk(f"satcheck: --exclude leaves out {counted(assets.excluded, 'file')}")
    rules = {os.path.realpath(path) for path in inputs.rules}
    files = [
        file
        for file in assets.files
        if not (rules and os.path.realpath(file) in rules)
        and not _is_skipped(file, inputs.permitted)
    ]
    if not files:
        raise click.UsageError("no file is named: give a folder or files")
    return assets._replace(files=files)


def tell_foreign(worlds: Iterable[World]) -> None:
    """`kit: no reader knows 2 files: kit/a.fbx, kit/b.blend`. worlds: of `foreign_worlds`."""
    for folder, *files in worlds:
        talk(f"satcheck: {folder}: no reader knows {counted(len(files), 'file')}: {listed(files)}")


def _is_skipped(file: str, permitted: Permitted) -> bool:
    """Files that only have rules are told, as their rules do not count here."""
    try:
        skipped = has_only_rules(file, permitted)
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
