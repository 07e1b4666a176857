"""Pictures beside a report, `--png` and `--glb`, and options that contradict each other."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from satcheck.cli.formats.registry import kind_of
from satcheck.cli.inputs import Inputs, is_same_file, refuse_early
from satcheck.cli.output import write_file
from satcheck.report.samples import SamplesReport

if TYPE_CHECKING:
    from satcheck.report.report import Report
    from satcheck.scene import Scene

# Format -> file.
Pictures = Mapping[str, Path]
_OPTIONS = ("png", "glb")


def taken_pictures(options: dict[str, Any]) -> Pictures:
    """Removes their options from `options`."""
    return {form: path for form in _OPTIONS if (path := options.pop(form)) is not None}


def refuse_pictures(
    pictures: Pictures, inputs: Inputs, output: Path | None, baseline: Path | None = None
) -> None:
    """output: the file of the report. No file may overwrite an input or another output."""
    written = {} if output is None else {"-o": output}
    for form, path in pictures.items():
        option = f"--{form}"
        refuse_early(inputs, path, baseline, option=option)
        for other, file in written.items():
            if is_same_file(path, file):
                raise click.UsageError(f"{option} {path} would overwrite the file of {other}")
        written[option] = path


def write_pictures(pictures: Pictures, report: Report, scene: Scene) -> None:
    """Raises SatcheckError where there is no picture, or it cannot be written."""
    from satcheck.cli.formats.picture import render

    for form, path in pictures.items():
        write_file(path, render(form, report, scene))


def files_line(
    report: Report | SamplesReport, scene: Scene, form: str, output: Path | None, pictures: Pictures
) -> str:
    """`Report: a.json. Image of box and lid: a.png. Model: a.glb`; empty without a file."""
    named = [] if output is None or form in _OPTIONS else [f"Report: {output}"]
    files = pictures if output is None or form not in _OPTIONS else {form: output, **pictures}
    if not isinstance(report, SamplesReport):
        named += [f"{_what(kind, report, scene)}: {path}" for kind, path in files.items()]
    return ". ".join(named)


def _what(form: str, report: Report, scene: Scene) -> str:
    from satcheck.cli.formats.picture.data import drawn_finding

    if form == "glb":
        return "Model"
    finding = drawn_finding(report, scene)
    return f"Image of {f'{finding.a} and {finding.b}' if finding else 'all bodies'}"


def refuse_certificate(form: str, *, wanted: bool) -> None:
    if wanted and form != "json":
        raise click.UsageError(
            "--certificate needs a JSON report: add -o report.json or --format json"
        )


def refuse_of_poses(form: str, **options: Any) -> None:
    """Of many poses a report has counts and no evidence."""
    if kind_of(form) != "plain":
        raise click.UsageError(f"--format {form} takes one pose, and several are given")
    for name in ("baseline", "certificate", "explain", "cross_check", "png", "glb"):
        if options.get(name):
            option = name.replace("_", "-")
            raise click.UsageError(f"--{option} takes one pose, and several are given")


def refuse_of_worlds(form: str, inputs: Inputs, **options: Any) -> None:
    """What is about one world."""
    refused = {f"--format {form}": kind_of(form) == "picture", "poses": inputs.has_poses}
    refused |= {f"--{name}": bool(options[name]) for name in ("certificate", "explain")}
    refused |= {f"--{name}": name in options for name in ("png", "glb")}
    for what in (what for what, given in refused.items() if given):
        raise click.UsageError(
            f"each scene is a world of its own, and {what} is about one: give one scene, or --merge"
        )
