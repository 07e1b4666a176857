"""The result of a check in the formats that were chosen, what stderr says about it, and options
that contradict each other."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from functools import partial
from typing import Any

import click
from msgspec import Struct

from satcheck.audit import Report
from satcheck.audit.words import counted, with_titles
from satcheck.cli.format_option import Target
from satcheck.cli.formats.registry import kind_of, pieces
from satcheck.cli.formats.summary import FACETED, MESHES, closing, issues_to_tell
from satcheck.cli.inputs import Inputs
from satcheck.cli.output import Document, Page, harmless, talk, tell_issues
from satcheck.report.json import document as json_document
from satcheck.report.json import render as render_json
from satcheck.report.report import Issue
from satcheck.report.samples import SamplesReport
from satcheck.scene import Scene

# With -o at most this many warnings are repeated on stderr.
WARNINGS = 5


class Delivery(Struct, frozen=True):
    """What is written, and how the exit code is made. timings: state times. top: how many rows a
    table lists at most. explain: the steps of each pair. parts: a page shows the convex parts of
    bodies. pose: a picture shows this one of several; None: a page all of them, another the worst.
    shows: standard output gets a document.
    """

    targets: tuple[Target, ...]
    quiet: bool
    exit_zero: bool
    timings: bool
    top: int | None
    explain: bool = False
    parts: bool = False
    pose: int | None = None
    shows: bool = True

    @property
    def forms(self) -> set[str]:
        return {target.form for target in self.targets}


def rendered(
    result: Report | SamplesReport, scene: Scene, form: str, to: Delivery, page: Page
) -> str | bytes | Iterable[str]:
    """Return the document. Formats are imported here, as they are needed: a table brings rich."""
    kind = kind_of(form)
    if kind == "picture":
        from satcheck.cli.formats.picture import render as render_picture

        settings = result.settings
        parts = to.parts or settings.parts or settings.accuracy == "parts"
        return render_picture(form, result, scene, split=parts, pose=to.pose)
    if isinstance(result, SamplesReport):
        if form == "json":
            return json_document(result.to_dict(to.timings))
        from satcheck.cli.formats.samples import render as render_samples

        return render_samples(result, page, top=to.top)
    if form == "json":
        return render_json(result, timings=to.timings)
    if kind == "reports":
        return pieces({"satcheck": result}, form)
    from satcheck.cli.formats.table import render as render_table

    return render_table(
        with_titles(result), page, explain=to.explain, timings=to.timings, top=to.top
    )


def deliver(document: Document, result: Report | SamplesReport, scene: Scene, to: Delivery) -> None:
    """Write the documents, and say on stderr what none of them shows. Pictures come last: one that
    cannot be made costs no report."""
    shown = [target for target in to.targets if target.output is not None or to.shows]
    shown.sort(key=lambda target: kind_of(target.form) == "picture")
    for form, output in shown:
        document.deliver(partial(rendered, result, scene, form, to), output, utf8=form != "table")
    files = "" if to.quiet else files_line(result, scene, to)
    is_told = bool(shown) and all(target.output is not None for target in shown)
    tell(result, scene, files, written=is_told and not to.quiet)


def tell(result: Report | SamplesReport, scene: Scene, files: str, *, written: bool) -> None:
    """Errors of the run on stderr, and the files it wrote. written: the report is in a file, so
    also the warnings and the summary."""
    told = {(issue.code, issue.body, issue.message) for issue in scene.issues}
    errors = (issue for issue in result.issues if issue.severity == "error")
    tell_issues(i for i in errors if (i.code, i.body, i.message) not in told)
    if not written:
        if files:
            talk(files)
        return
    if isinstance(result, SamplesReport):
        from satcheck.cli.formats.samples import closing as closing_of_poses

        counts, *others = closing_of_poses(result, written=True)
        issues: Sequence[Issue] = result.issues
    else:
        result = with_titles(result)
        counts, *others = closing(result, written=True)
        issues = issues_to_tell(result)
    warnings = [i for i in issues if i.severity == "warning" or i.code == FACETED]
    warnings.sort(key=lambda issue: issue.code in MESHES)  # the least grave
    tell_issues(warnings[:WARNINGS])
    if len(warnings) > WARNINGS:
        talk(f"satcheck: {counted(len(warnings) - WARNINGS, 'more warning')}: see the report")
    talk(harmless(counts))
    talk(harmless(" ".join([*others, files])))


def files_line(report: Report | SamplesReport, scene: Scene, to: Delivery) -> str:
    """Return `Report: a.json, a.html. Image of box and lid: a.png. Model: a.glb`; nothing without a
    file."""
    files: dict[str, list[str]] = {}
    for target in to.targets:
        if target.output is not None:
            what = _what(target.form, report, scene, to.pose)
            files.setdefault(what, []).append(str(target.output))
    return ". ".join(f"{what}: {', '.join(names)}" for what, names in files.items())


def _what(form: str, report: Report | SamplesReport, scene: Scene, pose: int | None) -> str:
    if form == "glb":
        return "Model"
    if form != "png":
        return "Report"
    if isinstance(report, SamplesReport):
        from satcheck.cli.formats.picture.poses import worst_pose

        if pose is None and (worst := worst_pose(report)):
            pose = worst.number
        return "Image of all bodies" if pose is None else f"Image of pose {pose}"
    from satcheck.cli.formats.picture import drawn_finding

    finding = drawn_finding(report, scene)
    return f"Image of {f'{finding.a} and {finding.b}' if finding else 'all bodies'}"


def refuse_certificate(forms: Collection[str], *, wanted: bool) -> None:
    if wanted and "json" not in forms:
        raise click.UsageError(
            "--certificate needs a JSON report: add -o report.json or --format json"
        )


def refuse_of_poses(forms: Iterable[str], **options: Any) -> None:
    """Of many poses a report has counts and no evidence."""
    for form in (form for form in forms if kind_of(form) == "reports"):
        raise click.UsageError(f"a report as {form} takes one pose, and several are given")
    for name in ("baseline", "certificate", "explain", "cross_check"):
        if options.get(name):
            option = name.replace("_", "-")
            raise click.UsageError(f"--{option} takes one pose, and several are given")


def refuse_of_worlds(forms: Iterable[str], inputs: Inputs, **options: Any) -> None:
    """What is about one world."""
    refused = {f"--format {form}": kind_of(form) == "picture" for form in forms if form != "html"}
    refused |= {"poses": inputs.has_poses}
    refused |= {f"--{name}": bool(options[name]) for name in ("certificate", "explain")}
    for what in (what for what, given in refused.items() if given):
        raise click.UsageError(
            f"each scene is a world of its own, and {what} is about one: give one scene, or --merge"
        )
