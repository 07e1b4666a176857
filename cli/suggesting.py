"""`satcheck suggest`: from its options to a document and an exit code."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from satcheck.cli import exit_codes
from satcheck.cli.checking import load_inputs, refuse_early
from satcheck.cli.output import Document, talk
from satcheck.cli.posing import Posing, poses_of
from satcheck.core.frozen import frozen

if TYPE_CHECKING:
    from satcheck.audit.suggest import Suggestions
    from satcheck.core.conventions import Plane
    from satcheck.scene import Scene
    from satcheck.scene.robot import Pose
    from satcheck.scene.scene_builder import Split


@frozen
class Choices:
    """The options of the command line."""

    paths: tuple[str, ...]
    form: str
    output: Path | None
    never: bool
    planar: Plane | None
    packages: Mapping[str, Path]
    split: Split | None
    units: str | None
    allow_outside: bool
    posing: Posing


def run(choices: Choices) -> int:
    """Look, write the document, say on stderr what it is worth; returns the exit code."""
    from satcheck.cli.report.suggest import chosen, remark
    from satcheck.cli.report.words import issue_line

    refuse_early(choices.paths, choices.output, others=choices.posing.pose)
    document = Document()
    scene = load_inputs(choices)
    if choices.form == "srdf" and len(scene.robots) != 1:
        raise click.UsageError("SRDF is about one robot: give one URDF")
    found = _suggest(scene, choices)
    pairs = chosen(found, never=choices.never)
    text = _render(found, choices, scene)
    document.deliver(lambda _: text, choices.output, utf8=True)
    for issue in found.issues:
        if issue.severity == "error" and issue.code not in {known.code for known in scene.issues}:
            talk(f"satcheck: {issue_line(issue)}")
    talk(remark(found, pairs, never=choices.never))
    if choices.form == "srdf" and pairs:
        talk("An SRDF has one line for two links: it covers all pairs of their bodies.")
    if any(issue.severity == "error" for issue in found.issues):
        return exit_codes.ERROR
    return exit_codes.INCOMPLETE if found.undecided else exit_codes.CLEAN


def _suggest(scene: Scene, choices: Choices) -> Suggestions:
    from satcheck.audit import Settings
    from satcheck.audit.suggest import suggest
    from satcheck.cli.progress import Bar

    placed, poses = _poses(scene, choices.posing)
    if placed:
        from satcheck.scene.robot import posed

        scene = posed(scene, placed)
    held = tuple(placed) if choices.posing.sample else ()
    with Bar("poses") as bar:
        seed = choices.posing.random_seed
        settings = Settings(planar=choices.planar)
        return suggest(scene, settings, poses, seed, progress=bar, held=held)


def _poses(scene: Scene, posing: Posing) -> tuple[Pose, list[Pose]]:
    """(as the robots are placed, the other poses to look at). What --sample holds on to places them
    too; of a list of poses none does."""
    if not posing.given:
        return {}, []
    found = poses_of(scene, posing)
    if not isinstance(found, list):
        return found, []
    placed = poses_of(scene, Posing(pose=posing.pose if posing.sample else (), state=posing.state))
    assert not isinstance(placed, list)  # --sample takes no list
    return placed, found


def _render(found: Suggestions, choices: Choices, scene: Scene) -> str:
    from satcheck.cli.report import suggest as texts

    if choices.form == "json":
        from satcheck.cli.report.json import document

        return document(found.to_dict())
    pairs = texts.chosen(found, never=choices.never)
    if choices.form == "srdf":
        return texts.srdf(found, pairs, scene.robots[0].robot.name)
    return texts.toml(found, pairs)
