"""`satcheck resolve`: from its options to a moved scene, a document and an exit code."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from satcheck.cli import exit_codes
from satcheck.cli.checking import load, refuse_early
from satcheck.cli.lengths import in_units_of
from satcheck.cli.output import Document, talk, write_file
from satcheck.core.frozen import frozen, replace

if TYPE_CHECKING:
    from satcheck.audit import Report, Settings
    from satcheck.audit.resolve import Resolution
    from satcheck.cli.output import Page
    from satcheck.scene import Scene
    from satcheck.scene.scene_builder import Split
    from satcheck.scene.units import Length

SCENE_SUFFIXES = frozenset({".json", ".toml"})


@frozen
class Choices:
    """What the command line asked for."""

    paths: tuple[str, ...]
    output: Path | None
    pins: tuple[str, ...]
    clearance: Length | None
    tolerance: Length | None
    max_motion: Length | None
    iterations: int
    split: Split | None
    allow_outside: bool
    allow_open: bool
    jobs: int
    form: str


def run(choices: Choices) -> int:
    """Resolve, write the scene and the document; returns the exit code."""
    refuse_early(choices.paths, choices.output)
    _refuse_output(choices)
    document = Document()
    scene = load(choices.paths, split=choices.split, allow_outside=choices.allow_outside)
    settings = _settings(choices, scene)
    found = _resolve(scene, settings, choices)
    if choices.output:
        write_file(choices.output, _written(scene, found, choices))
        found = replace(found, report=_checked(choices.output, settings, choices.allow_outside))
    document.write(_render(found, choices, document.page), utf8=choices.form == "json")
    return exit_codes.of_report(found.report, exit_zero=False)


def _is_scene(path: str) -> bool:
    return Path(path).suffix.lower() in SCENE_SUFFIXES


def _refuse_output(choices: Choices) -> None:
    """What cannot be written is said before any work is done."""
    if choices.output is None:
        return
    from satcheck.scene.loader import is_mesh

    first = choices.paths[0]
    if len(choices.paths) == 1 and _is_scene(first):
        wanted = Path(first).suffix.lower()
    elif all(map(is_mesh, choices.paths)):
        wanted = ".json"
    else:
        raise click.UsageError("-o writes one scene file, or one of mesh files alone")
    if choices.output.suffix.lower() != wanted:
        raise click.UsageError(f"-o {choices.output}: this scene is written as a {wanted} file")


def _settings(choices: Choices, scene: Scene) -> Settings:
    from satcheck.audit import Settings

    return Settings(
        clearance=_length(choices.clearance, scene, "--clearance"),
        tolerance=_length(choices.tolerance, scene, "--tolerance"),
        allow_open=choices.allow_open,
        jobs=choices.jobs,
    )


def _length(given: Length | None, scene: Scene, option: str) -> float | None:
    return None if given is None else in_units_of(given, scene.units, option)


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
    from satcheck.scene.moved_file import moved_scene_file, scene_file_of

    assert choices.output is not None
    translations = {move.body: move.translation for move in found.moves}
    if _is_scene(choices.paths[0]):
        return moved_scene_file(choices.paths[0], choices.output, translations)
    return scene_file_of(choices.output, scene, translations)


def _checked(path: Path, settings: Settings, allow_outside: bool) -> Report:
    """The file as anybody would check it; errors of reading are told."""
    from satcheck.audit import check
    from satcheck.audit.resolve import proof_of
    from satcheck.cli.report.words import issue_line
    from satcheck.scene import load_scene

    report = check(load_scene([path], allow_outside=allow_outside), proof_of(settings))
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
