"""A check of many poses: from the options to a document and an exit code."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from satcheck.cli import exit_codes
from satcheck.cli.checking import settings_of
from satcheck.cli.output import Document, talk
from satcheck.core.frozen import replace

if TYPE_CHECKING:
    from satcheck.audit.samples import Samples
    from satcheck.cli.checking import Choices
    from satcheck.cli.output import Page
    from satcheck.scene import Scene
    from satcheck.scene.robot import Pose


def check_and_tell(
    scene: Scene, poses: Sequence[Pose], choices: Choices, document: Document
) -> int:
    """Check the poses, write the document, tell the errors on stderr; returns the exit code."""
    from satcheck.audit.samples import check_poses
    from satcheck.cli.progress import Bar

    for option in ("certificate", "explain", "cross_check"):
        if getattr(choices, option):
            name = option.replace("_", "-")
            raise click.UsageError(f"--{name} takes one pose, and several are given")
    settings = settings_of(choices, scene)
    with Bar("poses") as bar:
        found = check_poses(scene, poses, settings, progress=bar)
    found = replace(found, seed=choices.posing.random_seed)
    utf8 = choices.form == "json"
    document.deliver(lambda page: _render(found, choices, page), choices.output, utf8=utf8)
    _tell(found, scene, choices)
    return exit_codes.of_verdict(found.verdict, found.issues, exit_zero=choices.exit_zero)


def _render(found: Samples, choices: Choices, page: Page) -> str:
    if choices.form == "json":
        from satcheck.cli.report.json import document

        return document(found.to_dict(choices.timings))
    from satcheck.cli.report.samples import render

    return render(found, page)


def _tell(found: Samples, scene: Scene, choices: Choices) -> None:
    from satcheck.cli.report.samples import summary_line
    from satcheck.cli.report.words import issue_line

    for trace in found.tracebacks if choices.debug else ():
        talk(trace.rstrip())
    told = {(issue.code, issue.body, issue.message) for issue in scene.issues}
    for issue in found.issues:
        if issue.severity == "error" and (issue.code, issue.body, issue.message) not in told:
            talk(f"satcheck: {issue_line(issue)}")
    if choices.output:
        talk(f"{summary_line(found)} Report: {choices.output}")
