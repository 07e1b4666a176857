"""The result of a check in the format that was chosen, and what stderr says about it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from msgspec import Struct

from satcheck.audit import Report
from satcheck.audit.words import counted, with_titles
from satcheck.cli.formats.registry import kind_of, pieces
from satcheck.cli.formats.summary import counts_line, next_step
from satcheck.cli.formats.words import in_one_line_each, issue_line
from satcheck.cli.output import Page, talk
from satcheck.report.json import document as json_document
from satcheck.report.json import render as render_json
from satcheck.report.samples import SamplesReport
from satcheck.scene import Scene

# With -o at most this many warnings are repeated on stderr.
WARNINGS = 5


class Delivery(Struct, frozen=True):
    """Where the report goes, in which form, and how the exit code is made. timings: state times.
    top: how many rows a table lists at most. explain: the steps of each pair. cache: a picture may
    read and write the cache of convex parts."""

    form: str
    output: Path | None
    quiet: bool
    exit_zero: bool
    timings: bool
    top: int | None
    explain: bool = False
    cache: bool = True


def rendered(
    result: Report | SamplesReport, scene: Scene, to: Delivery, page: Page
) -> str | bytes | Iterable[str]:
    """Return the document. Formats are imported here, as they are needed: a table brings rich."""
    if isinstance(result, SamplesReport):
        if to.form == "json":
            return json_document(result.to_dict(to.timings))
        from satcheck.cli.formats.samples import render as render_samples

        return render_samples(result, page, top=to.top)
    if to.form == "json":
        return render_json(result, timings=to.timings)
    kind = kind_of(to.form)
    if kind == "reports":
        return pieces({"satcheck": result}, to.form)
    if kind == "picture":
        from satcheck.cli.formats.picture import render as render_picture

        parts = result.settings.accuracy == "parts"
        return render_picture(to.form, result, scene, split=parts, cache=to.cache)
    from satcheck.cli.formats.table import render as render_table

    shown = in_one_line_each(with_titles(result))
    return render_table(shown, page, explain=to.explain, timings=to.timings, top=to.top)


def tell(result: Report | SamplesReport, scene: Scene, files: str, *, written: bool) -> None:
    """Errors of the run on stderr, and the files it wrote. written: the report is in a file, so
    also the warnings and the summary."""
    told = {(issue.code, issue.body, issue.message) for issue in scene.issues}
    for issue in result.issues:
        if issue.severity == "error" and (issue.code, issue.body, issue.message) not in told:
            talk(f"satcheck: {issue_line(issue)}")
    if not written:
        if files:
            talk(files)
        return
    if isinstance(result, SamplesReport):
        from satcheck.cli.formats.samples import samples_counts, samples_verdict

        talk(samples_counts(result))
        summary = samples_verdict(result)
    else:
        result = in_one_line_each(with_titles(result))
        summary = " ".join([result.message, *next_step(result, written=True)])
        warnings = [issue for issue in result.issues if issue.severity == "warning"]
        for issue in warnings[:WARNINGS]:
            talk(f"satcheck: {issue_line(issue)}")
        if len(warnings) > WARNINGS:
            talk(f"satcheck: {counted(len(warnings) - WARNINGS, 'more warning')}: see the report")
        talk(counts_line(result))
    talk(f"{summary} {files}")
