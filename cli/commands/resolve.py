"""`satcheck resolve SCENE`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit import Report, Settings, check
from satcheck.audit.resolve import Resolution, proof_of, resolve
from satcheck.cli import exit_codes
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import form_of, form_option
from satcheck.cli.formats.words import issue_line
from satcheck.cli.inputs import Inputs, load, refuse_early
from satcheck.cli.lengths import in_units_of, length, settings_of
from satcheck.cli.options import (
    color_option,
    debug_option,
    jobs_option,
    open_option,
    output_option,
    paths_argument,
    tolerance_option,
)
from satcheck.cli.output import Document, Page, talk, write_file
from satcheck.cli.posing import posed_once
from satcheck.cli.progress import Bar
from satcheck.cli.scene_options import one_scene_options
from satcheck.core.errors import SatcheckError
from satcheck.report.json import document as json_document
from satcheck.scene import Scene, load_scene
from satcheck.scene.input_kind import kind_of
from satcheck.scene.loader import is_rules
from satcheck.scene.loading.reading_children import ReadingChildren
from satcheck.scene.moved import WRITTEN_BACK, written_back
from satcheck.scene.moved.scene_file import stray_mesh
from satcheck.scene.new_scene_file import new_scene_file
from satcheck.scene.units import Length

SCENE_SUFFIXES = frozenset({".json", ".toml"})


@click.command("resolve", cls=Command, context_settings=HELP_NAMES)
@paths_argument("SCENE")
@click.option(
    "--scene-out",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Write the moved scene to FILE. [default: show the moves only]",
)
@click.option(
    "--pin",
    "pins",
    multiple=True,
    metavar="GLOB",
    help="Do not move bodies with such an id, or with group:GLOB in such a group. Repeatable.",
)
@click.option(
    "--clearance",
    type=length,
    help="The gap to leave between bodies. [default: none, they may touch]",
)
@tolerance_option
@click.option("--max-motion", type=length, help="Move no body farther than this.")
@click.option(
    "--iterations",
    type=click.IntRange(min=0),
    metavar="N",
    default=50,
    show_default=True,
    help="Rounds of pushing. Bodies that still overlap then move to a free place.",
)
@open_option
@jobs_option
@form_option
@output_option
@one_scene_options
@color_option
@debug_option
def command(
    form: str | None,
    output: Path | None,
    scene_out: Path | None,
    pins: tuple[str, ...],
    max_motion: Length | None,
    iterations: int,
    **options: Any,
) -> int:
    """Move the bodies of a scene apart, by short translations.

    SCENE is a scene file or mesh files, with or without robots. Static and pinned bodies stay, and
    so do the links of robots and pairs that the scene allows. Among several ways resolve takes one
    with a small sum of squared lengths. The moved scene is checked again (with --scene-out the file
    that was written), and what still overlaps is reported.

    Exit codes: 0, no pair overlaps any more; 1, a pair does; 2, wrong usage, an unreadable input, or
    an internal error; 3, nothing is known to overlap, but not everything could be checked.
    """
    inputs = Inputs.taken_from(options)
    if form is None and output is not None and output.suffix.lower() == ".toml":
        raise click.UsageError(
            f"-o {output}: the report is no TOML; --scene-out {output} writes the moved scene"
        )
    form = form_of(form, output)
    refuse_early(inputs, output)
    target = _target(inputs, scene_out, output)
    document = Document()
    scene = _posed(load(inputs), inputs)
    stray = _stray(target, scene, allow_outside=inputs.allow_outside)
    settings = settings_of({**options, **inputs.limits}, scene)
    if max_motion is not None:
        farthest = in_units_of(max_motion, scene.units, "--max-motion")
    else:
        farthest = None
    with Bar(verb="pushing apart") as bar:
        result = resolve(
            scene,
            settings,
            pins=pins,
            max_motion=farthest,
            iterations=iterations,
            progress=bar,
        )
    if scene_out is not None:
        _write_moved(scene_out, target, scene, result, inputs)
        result = replace(result, report=_checked(scene_out, target, settings, inputs))
    document.deliver(
        lambda page: _render(result, form, page, scene_out), output, utf8=form == "json"
    )
    if stray is not None:
        talk(f"note: to read {scene_out} give --allow-outside, because of {stray}")
    report = result.report
    return exit_codes.for_verdict(report.summary.verdict, report.issues, exit_zero=False)


class _Target(Struct, frozen=True):
    """Where the moved scene goes, and what it is made from.

    path: None: it is not written. rules: inputs beside others that state rules alone. source: the
    file that is written back, where it is all that was given, but for rules; None: the scene file
    is new.
    """

    path: Path | None
    rules: tuple[str, ...]
    source: str | None

    @property
    def scene(self) -> str | None:
        """The scene file that is written back."""
        source = self.source
        return source if source and Path(source).suffix.lower() in SCENE_SUFFIXES else None


def _target(inputs: Inputs, moved: Path | None, output: Path | None) -> _Target:
    """What cannot be written is said before any work is done."""
    if moved is not None:
        refuse_early(inputs, moved, option="--scene-out")
        if output is not None and output.absolute() == moved.absolute():
            raise click.UsageError("--scene-out and -o name the same file")
    rules = tuple(filter(is_rules, inputs.paths)) if len(inputs.paths) > 1 else ()
    bodies = [path for path in inputs.paths if path not in rules]
    if moved is None:
        return _Target(moved, rules, None)
    ending = moved.suffix.lower()
    own = WRITTEN_BACK.get(Path(bodies[0]).suffix.lower(), frozenset())
    back = len(bodies) == 1 and ending in own
    if back and inputs.has_poses and kind_of(bodies[0]) == "document":
        raise click.UsageError(
            f"--scene-out {moved}: a pose cannot be written back: write a scene file (.toml)"
        )
    is_scene = len(bodies) == 1 and kind_of(bodies[0]) == "scene"
    if not is_scene and not all(kind_of(path) in ("mesh", "document") for path in bodies):
        raise click.UsageError(
            "--scene-out needs one scene file, or mesh files alone: links of robots are not moved"
        )
    wanted = own if is_scene else SCENE_SUFFIXES | (own if len(bodies) == 1 else frozenset())
    if ending not in wanted:
        known = " or ".join(sorted(wanted))
        raise click.UsageError(f"--scene-out {moved}: this scene is written as a {known} file")
    if back and not is_scene and moved.absolute().parent != Path(bodies[0]).absolute().parent:
        raise click.UsageError(
            f"--scene-out {moved}: write it beside {bodies[0]}, which may refer to files there"
        )
    return _Target(moved, rules, bodies[0] if back else None)


def _posed(scene: Scene, inputs: Inputs) -> Scene:
    if not inputs.has_poses:
        return scene
    return posed_once(scene, inputs, "resolve takes one pose, which places the links")


def _stray(target: _Target, scene: Scene, *, allow_outside: bool) -> str | None:
    """A mesh outside of the folder of the file to write, which names it; UsageError unless
    allow_outside."""
    if target.path is None or (target.source is not None and target.scene is None):
        return None
    stray = stray_mesh(target.scene, target.path, scene)
    if stray is not None and not allow_outside:
        raise click.UsageError(
            f"--scene-out {target.path}: {stray} lies outside of its folder: write it into a "
            "folder that contains the meshes, or add --allow-outside"
        )
    return stray


def _write_moved(
    path: Path, target: _Target, scene: Scene, result: Resolution, inputs: Inputs
) -> None:
    translations = {move.body: move.translation for move in result.moves}
    if target.source is None:
        write_file(
            path, new_scene_file(path, scene, inputs.mesh_files(scene.reading), translations)
        )
        return
    children, seconds = ReadingChildren(inputs.megabytes_per_file), inputs.seconds_per_file
    content = written_back(path, target.source, scene, translations, children, seconds=seconds)
    write_file(path, content)


def _checked(path: Path, target: _Target, settings: Settings, inputs: Inputs) -> Report:
    """The file as anybody would check it, beside the rules given; errors of reading are told. What
    cannot be read is not left behind."""
    try:
        scene = load_scene(
            [str(path), *target.rules],
            units=inputs.units,
            allow_outside=inputs.allow_outside,
            reading=inputs.reading,
            geometry=inputs.geometry,
        )
    except SatcheckError:
        path.unlink(missing_ok=True)
        raise
    report = check(scene, proof_of(settings))
    for issue in report.issues:
        if issue.severity == "error":
            talk(f"satcheck: {issue_line(issue)}")
    return report


def _render(result: Resolution, form: str, page: Page, moved: Path | None) -> str:
    output = str(moved) if moved else None
    if form == "json":
        return json_document(result.document(output))
    from satcheck.cli.formats.resolution import render

    return render(result, page, output)
