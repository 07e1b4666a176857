"""`satcheck resolve`: from its options to a moved scene, a document and an exit code."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from satcheck.cli import exit_codes
from satcheck.cli.checking import load_inputs, refuse_early
from satcheck.cli.lengths import in_units_of
from satcheck.cli.output import Document, talk, write_file
from satcheck.core.frozen import frozen, replace

if TYPE_CHECKING:
    from collections.abc import Mapping

    from satcheck.audit import Report, Settings
    from satcheck.audit.resolve import Resolution
    from satcheck.cli.output import Page
    from satcheck.cli.posing import Posing
    from satcheck.scene import Scene
    from satcheck.scene.scene_builder import Split
    from satcheck.scene.units import Length

SCENE_SUFFIXES = frozenset({".json", ".toml"})


@frozen
class Choices:
    """The options of the command line."""

    paths: tuple[str, ...]
    moved: Path | None
    output: Path | None
    pins: tuple[str, ...]
    clearance: Length | None
    tolerance: Length | None
    max_motion: Length | None
    iterations: int
    split: Split | None
    units: str | None
    allow_outside: bool
    allow_open: bool
    jobs: int
    form: str
    packages: Mapping[str, Path]
    posing: Posing

    @property
    def rule_files(self) -> tuple[str, ...]:
        """Inputs beside others that state rules alone."""
        from satcheck.scene.loader import is_rules

        return tuple(filter(is_rules, self.paths)) if len(self.paths) > 1 else ()

    @property
    def body_files(self) -> tuple[str, ...]:
        rules = self.rule_files
        return tuple(path for path in self.paths if path not in rules)

    @property
    def scene_file(self) -> str | None:
        """The scene file, where one is all that was given, but for rules."""
        first, *others = self.body_files
        return None if others or Path(first).suffix.lower() not in SCENE_SUFFIXES else first


def run(choices: Choices) -> int:
    """Resolve, write the scene and the document; returns the exit code."""
    _refuse_outputs(choices)
    document = Document()
    scene = _loaded(choices)
    stray = _stray(choices, scene)
    settings = _settings(choices, scene)
    found = _resolve(scene, settings, choices)
    if choices.moved:
        write_file(choices.moved, _written(scene, found, choices))
        found = replace(found, report=_checked(choices.moved, settings, choices))
    utf8 = choices.form == "json"
    document.deliver(lambda page: _render(found, choices, page), choices.output, utf8=utf8)
    if stray is not None:
        talk(f"note: to read {choices.moved} give --allow-outside, because of {stray}")
    return exit_codes.of_report(found.report, exit_zero=False)


def _loaded(choices: Choices) -> Scene:
    scene = load_inputs(choices)
    if not choices.posing.given:
        return scene
    from satcheck.cli.posing import poses_of
    from satcheck.scene.robot import posed

    pose = poses_of(scene, choices.posing)
    if isinstance(pose, list):
        raise click.UsageError("resolve takes one pose, which places the links")
    return posed(scene, pose)


def _refuse_outputs(choices: Choices) -> None:
    """What cannot be written is said before any work is done."""
    refuse_early(choices.paths, choices.output, others=choices.posing.pose)
    if choices.moved is None:
        return
    refuse_early(choices.paths, choices.moved, others=choices.posing.pose, option="--moved")
    if choices.output is not None and choices.output.absolute() == choices.moved.absolute():
        raise click.UsageError("--moved and -o name the same file")
    from satcheck.scene.loader import is_mesh

    wanted = {".toml", ".json"}
    if choices.scene_file is not None:
        wanted = {Path(choices.scene_file).suffix.lower()}
    elif not all(map(is_mesh, choices.body_files)):
        raise click.UsageError(
            "--moved needs one scene file, or mesh files alone: links of robots are not moved"
        )
    if choices.moved.suffix.lower() not in wanted:
        known = " or ".join(sorted(wanted))
        raise click.UsageError(f"--moved {choices.moved}: this scene is written as a {known} file")


def _stray(choices: Choices, scene: Scene) -> str | None:
    """A mesh that OUT names outside of its folder; UsageError without --allow-outside."""
    if choices.moved is None:
        return None
    from satcheck.scene.moved_file import stray_mesh

    stray = stray_mesh(choices.scene_file, choices.moved, scene)
    if stray is not None and not choices.allow_outside:
        raise click.UsageError(
            f"--moved {choices.moved}: {stray} lies outside of its folder: write it into a folder "
            "that contains the meshes, or add --allow-outside"
        )
    return stray


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

    assert choices.moved is not None
    translations = {move.body: move.translation for move in found.moves}
    if choices.scene_file is not None:
        return moved_scene_file(choices.scene_file, choices.moved, translations)
    return scene_file_of(choices.moved, scene, translations)


def _checked(path: Path, settings: Settings, choices: Choices) -> Report:
    """The file as anybody would check it, beside the rules given; errors of reading are told. What
    cannot be read is not left behind."""
    from satcheck.audit import check
    from satcheck.audit.resolve import proof_of
    from satcheck.cli.report.words import issue_line
    from satcheck.core.errors import SatcheckError
    from satcheck.scene import load_scene

    try:
        scene = load_scene(
            [str(path), *choices.rule_files],
            units=choices.units,
            allow_outside=choices.allow_outside,
        )
    except SatcheckError:
        path.unlink(missing_ok=True)
        raise
    report = check(scene, proof_of(settings))
    for issue in report.issues:
        if issue.severity == "error":
            talk(f"satcheck: {issue_line(issue)}")
    return report


def _render(found: Resolution, choices: Choices, page: Page) -> str:
    output = str(choices.moved) if choices.moved else None
    if choices.form == "json":
        from satcheck.cli.report.json import document

        return document(found.to_dict(output))
    from satcheck.cli.report.resolution import render

    return render(found, page, output)
