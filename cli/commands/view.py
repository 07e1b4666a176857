"""`satcheck view REPORT`: what was stored earlier, in any format, with pictures from its meshes."""

from __future__ import annotations

import os
import sys
import webbrowser
from collections import Counter
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from tempfile import mkdtemp
from typing import NamedTuple, cast

import click
from msgspec.structs import replace

from satcheck.audit.batch.manifest import read_manifest
from satcheck.audit.batch.stored import ENDINGS, Stored, StoredResults, least_of
from satcheck.audit.words import is_listed
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import FormatChoice, Target, format_option, targets_of
from satcheck.cli.formats.assets import asset_rank, overview
from satcheck.cli.formats.registry import ALL, Format, kind_of
from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.output import Document, talk, tell_issues, write_file
from satcheck.cli.rendering import (
    Delivery,
    files_line,
    refuse_of_poses,
    rendered,
)
from satcheck.cli.stated_scene import read_stored, stated_scene
from satcheck.cli.worlds import deliver_assets, tell_assets
from satcheck.cli.worst_findings import Drawing
from satcheck.report.assets import Asset, AssetsReport
from satcheck.report.report import Issue, Report
from satcheck.report.samples import SamplesReport
from satcheck.scene import Scene
from satcheck.scene.words import meant

# Assets that a table lists without --top, and findings with a picture.
TOP = 100
_PAGE = Format(
    "html", (".html", ".htm"), about="a 3-D view, of several assets a gallery of the worst"
)
_FORMATS = FormatChoice(ALL, {"html": _PAGE})


@click.command("view", cls=Command, context_settings=HELP_NAMES)
@option.reports
@format_option(_FORMATS, "as the file of -o ends, otherwise a page in the browser")
@option.outputs(
    "Write to FILE, in the format that its name ends with; - is standard output. Repeatable."
)
@click.option(
    "--asset",
    metavar="FILE",
    help="Show this asset alone.  [default: in 3-D the worst, otherwise all]",
)
@click.option(
    "--top",
    type=option.Whole(min=1),
    metavar="N",
    help="Report the N worst assets, the worst first; in a gallery and for --pictures their worst "
    f"findings. The summary and the exit code count all.  [default: {TOP} in a table and a "
    "gallery, otherwise all]",
)
@click.option(
    "--pictures",
    "folder",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="DIR",
    help="Also write images of the worst findings into DIR, as PNG.",
)
@click.option(
    "--pose",
    type=option.Whole(1),
    metavar="NUMBER",
    help="The pose to show, if a report has several.  [default: all on a page, else the worst]",
)
@click.option(
    "--parts",
    is_flag=True,
    help="Split the bodies with findings, so that the page shows their convex parts. A report of "
    "--parts or --accuracy parts has them anyway.",
)
@click.option(
    "--manifest",
    metavar="FILE",
    help="Expect a result for each asset that FILE names, one per line, as satcheck batch does.",
)
@option.root
@scene_option.outside
@option.exit_zero
@option.common
def command(
    reports: tuple[Path, ...],
    form: str | None,
    outputs: tuple[Path, ...],
    asset: str | None,
    top: int | None,
    folder: Path | None,
    pose: int | None,
    parts: bool,
    manifest: str | None,
    root: Path,
    allow_outside: bool,
    exit_zero: bool,
) -> int:
    """Show a stored report in 3-D, or in any other format.

    REPORT is a JSON report of a check or of many assets, or results that satcheck batch wrote
    (.jsonl); those of several shards are one report. Without -o and --format its worst asset opens
    in the browser. For pictures the mesh files are read again: a file that has changed since the
    check is named, and a gallery says so in place of the picture.

    The exit code is that of the check, also of a batch that did not finish: that is never a pass.
    Of a 3-D view alone it is 0, or 3 if a file is missing or has changed, or results are missing.
    """
    inputs = Inputs(paths=tuple(map(str, (*reports, *filter(None, [manifest])))))
    is_opened = form is None and not outputs and folder is None
    refuse_early(inputs, outputs)
    targets = () if is_opened else targets_of(form, outputs, _FORMATS)
    to = Delivery(targets, False, exit_zero, timings=True, top=top, parts=parts, pose=pose)
    view = _View(Document(), to, Drawing(root, folder, allow_outside, top or TOP))
    if any(path.suffix.lower() in ENDINGS for path in reports):
        expected = () if manifest is None else read_manifest(manifest)
        with StoredResults(reports, expected) as results:
            return view.assets(results, results.issues, asset)
    if len(reports) > 1 or manifest is not None:
        raise click.UsageError("several files are results of satcheck batch, which end in .jsonl")
    stored = read_stored(reports[0])
    if isinstance(stored, AssetsReport):
        each = [Stored((asset.file,), (), asset) for asset in stored.assets]
        return view.assets(each, stored.issues, asset)
    if asset is not None:
        raise click.UsageError(f"--asset: {reports[0]} is the report of one check")
    if folder is not None:
        raise click.UsageError(
            f"--pictures: {reports[0]} is the report of one check: -o picture.png draws it"
        )
    return view.report(stored)


class _View(NamedTuple):
    """How a stored report is shown. to: without a target a page opens in the browser."""

    document: Document
    to: Delivery
    drawing: Drawing

    def assets(
        self,
        stored: Sequence[Stored] | StoredResults,
        issues: tuple[Issue, ...],
        name: str | None,
    ) -> int:
        """Show many assets, or one of them: the named one, or in 3-D the worst."""
        if name is not None:
            return self.report(_named(stored, name))
        alone = [target for target in self.to.targets if _is_scene(target)]
        others = tuple(target for target in self.to.targets if not _is_scene(target))
        is_page = not self.to.targets and self.drawing.folder is None
        code = exit_codes.CLEAN
        if alone or is_page:
            code = self._replace(to=replace(self.to, targets=tuple(alone)))._worst(stored)
        if is_page or not others:
            tell_issues(issues)
            of_issues = exit_codes.for_counts(Counter([least_of(issues)]))
            return min(filter(None, (code, of_issues)), default=exit_codes.CLEAN)
        to = replace(self.to, targets=others)
        found = (each.asset for each in stored)
        seen = overview(found, issues, top=self.drawing.top)
        deliver_assets(self.document, seen, stored, to, self.drawing, only_shown=to.top is not None)
        tell_assets(seen, to)
        return seen.exit_code(exit_zero=to.exit_zero)

    def _worst(self, stored: Sequence[Stored] | StoredResults) -> int:
        """Show the worst of many assets; one with a finding, if there is any, as a file that cannot
        be read has nothing to see."""
        if not len(stored):
            talk("satcheck: error: there is no asset to draw")
            return exit_codes.ERROR
        worst = min((each.asset for each in stored), key=_rank_to_see)
        if len(stored) > 1:
            named = f"{worst.file} is the worst of {len(stored):,} assets"
            if any(map(is_listed, worst.report.findings)):
                named = f"{worst.file} has the worst finding of {len(stored):,} assets"
            talk(f"satcheck: {named}: --asset names another")
        return self.report(worst.report)

    def report(self, stated: Report | SamplesReport) -> int:
        """Show the report of one check. Pictures need its scene, which is read again."""
        if isinstance(stated, SamplesReport):
            refuse_of_poses(self.to.forms)
        elif self.to.pose is not None:
            raise click.UsageError("--pose: the report is not about several poses")
        pictures = [t for t in self.to.targets if kind_of(t.form) == "picture"]
        if self.to.pose is not None and self.to.targets and not pictures:
            raise click.UsageError("--pose is for pictures: add -o pose.html")
        scene, issues = Scene(name="", units=stated.units, bodies=()), list[Issue]()
        if pictures or not self.to.targets:
            root, allow_outside = self.drawing.root, self.drawing.allow_outside
            scene, issues = stated_scene(stated, root, allow_outside=allow_outside)
        tell_issues(issues)
        stated = replace(stated, issues=(*issues, *stated.issues))
        for form, output in self.to.targets:
            text = partial(rendered, stated, scene, form, self.to)
            self.document.deliver(text, output, utf8=form != "table")
        if not self.to.targets:
            page = rendered(stated, scene, "html", self.to, self.document.page)
            _show(cast("str", page), self.document)
        elif files := files_line(stated, scene, self.to):
            talk(files)
        if len(pictures) == len(self.to.targets):
            return exit_codes.INCOMPLETE if issues else exit_codes.CLEAN
        return exit_codes.for_report(stated, exit_zero=self.to.exit_zero)


def _is_scene(target: Target) -> bool:
    """Return whether a document shows one scene: of several assets the worst."""
    return kind_of(target.form) == "picture" and target.form != "html"


def _rank_to_see(asset: Asset) -> tuple[float, ...]:
    return (not any(map(is_listed, asset.report.findings)), *asset_rank(asset))


def _named(stored: Iterable[Stored], name: str) -> Report:
    """Return the report of an asset. click.UsageError if there is none."""
    names = []
    for asset in (each.asset for each in stored):
        if asset.file == name:
            return asset.report
        names.append(asset.file)
    with_it = [file for file in names if name in file]
    hint = f" (did you mean {with_it[0]!r}?)" if with_it else meant(name, names)
    raise click.UsageError(f"--asset: no asset is {name}{hint}")


def _show(content: str, document: Document) -> None:
    """The path is printed, as a browser may not come up."""
    path = Path(mkdtemp(prefix="satcheck-")) / "report.html"
    write_file(path, content)
    document.write(f"{path}\n")
    displays = map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY"))
    if sys.platform in ("win32", "darwin") or any(displays):
        webbrowser.open(path.as_uri())
