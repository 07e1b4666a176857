"""`satcheck resolve`: from its options to a moved scene, a document and an exit code."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from satcheck.cli import exit_codes
from satcheck.cli.checking import load, refuse_early
from satcheck.cli.output import Document, talk, write_file

if TYPE_CHECKING:
    from satcheck.audit import Report, Settings
    from satcheck.audit.resolve import Resolution
    from satcheck.cli.lengths import Length
    from satcheck.cli.output import Page
    from satcheck.scene import Scene

SCENE_SUFFIX = ".json"


@dataclass(frozen=True, slots=True)
class Choices:
    """What the command line asked for."""

    paths: tuple[str, ...]
    output: Path | None
    pins: tuple[str, ...]
    clearance: Length | None
    tolerance: Length | None
    max_motion: Length | None
    iterations: int
    allow_open: bool
    jobs: int
    form: str


def run(choices: Choices) -> int:
    """Resolve, write the scene and the document; returns the exit code."""
    refuse_early(choices.paths, choices.output)
    _refuse_output(choices)
    document = Document()
    scene = load(choices.paths)
    settings = _settings(choices, scene)
    found = _resolve(scene, settings, choices)
    if choices.output:
        write_file(choices.output, _written(scene, found, choices))
        found = replace(found, report=_checked(choices.output, settings))
    document.write(_render(found, choices, document.page), utf8=choices.form == "json")
    return exit_codes.of_report(found.report, exit_zero=False)


def _is_scene(path: str | Path) -> bool:
    return Path(path).suffix.lower() == SCENE_SUFFIX


def _refuse_output(choices: Choices) -> None:
    if choices.output is None:
        return
    if not _is_scene(choices.output):
        raise click.UsageError(f"-o {choices.output}: a moved scene is written as a .json file")
    if len(choices.paths) > 1 and any(map(_is_scene, choices.paths)):
        raise click.UsageError("-o writes one scene file, or one of mesh files alone, not of both")


def _settings(choices: Choices, scene: Scene) -> Settings:
    from satcheck.audit import Settings

    return Settings(
        clearance=_length(choices.clearance, scene, "--clearance"),
        tolerance=_length(choices.tolerance, scene, "--tolerance"),
        allow_open=choices.allow_open,
        jobs=choices.jobs,
    )


def _length(given: Length | None, scene: Scene, option: str) -> float | None:
    return None if given is None else given.in_units_of(scene.units, option)


def _resolve(scene: Scene, settings: Settings, choices: Choices) -> Resolution:
    from satcheck.audit.resolve import resolve
    from satcheck.cli.progress import Bar

    with Bar() as bar:
        return resolve(
            scene,
            settings,
            pins=choices.pins,
            max_motion=_length(choices.max_motion, scene, "--max-motion"),
            iterations=choices.iterations,
            progress=bar,
        )


def _written(scene: Scene, found: Resolution, choices: Choices) -> str:
    from satcheck.audit.resolve import moved_scene
    from satcheck.scene.moved_file import moved_scene_file, scene_file_of

    assert choices.output is not None
    translations = {move.body: move.translation for move in found.moves}
    bodies = {body.id: body for body in moved_scene(scene, translations).bodies}
    placements = {
        id_: body.transform
        for id_, body in bodies.items()
        if id_ in translations and body.transform is not None
    }
    if _is_scene(choices.paths[0]):
        return moved_scene_file(Path(choices.paths[0]), choices.output, placements)
    return scene_file_of(choices.output, bodies, placements)


def _checked(path: Path, settings: Settings) -> Report:
    """The file as anybody would check it; errors of reading are told."""
    from satcheck.audit import check
    from satcheck.audit.resolve import proof_of
    from satcheck.cli.report.words import issue_line

    report = check([str(path)], proof_of(settings))
    for issue in report.issues:
        if issue.severity == "error":
            talk(f"satcheck: {issue_line(issue)}")
    return report


def _render(found: Resolution, choices: Choices, page: Page) -> str:
    output = str(choices.output) if choices.output else None
    if choices.form == "json":
        from satcheck.cli.report.json import document

        return document(found.to_dict(output))
    from satcheck.cli.report.resolution import render

    return render(found, page, output)
