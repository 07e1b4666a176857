"""`satcheck convert SCENE -o FILE`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from satcheck.cli import exit_codes
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.formats.numbers import at_most
from satcheck.cli.formats.words import counted, issue_line, with_unit
from satcheck.cli.inputs import Inputs, load, refuse_early
from satcheck.cli.options import color_option, debug_option, paths_argument
from satcheck.cli.output import harmless, talk, write_file
from satcheck.cli.posing import posed_once
from satcheck.cli.scene_options import one_scene_options
from satcheck.core.shapes import is_curved
from satcheck.scene import Scene
from satcheck.scene.glb_file import Node, glb, rounding
from satcheck.scene.new_scene_file import left_out_of, new_scene_file, stray_mesh
from satcheck.scene.units import unit_of

# The lines about what was written, and the ids of bodies that are not in the file.
Told = tuple[list[str], list[str]]


@click.command("convert", cls=Command, context_settings=HELP_NAMES)
@paths_argument("SCENE")
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="The file to write: a scene file (.toml, .json), or its meshes (.glb).",
)
@one_scene_options
@color_option
@debug_option
def command(output: Path, **options: Any) -> int:
    """Write any scene as a scene file of satcheck, or as GLB.

    SCENE is what a check takes. A scene file names the mesh files and their parts where they lie,
    and states placements, groups, rules and motions. Robots stand as they are posed. A GLB file has
    a node for each body, in metres if the unit is known, and no rules; the axes stay as they are.

    Exit codes: 0, all bodies are in the file; 2, wrong usage, an unreadable input, or an internal
    error; 3, some bodies are not in the file.
    """
    inputs = Inputs.taken_from(options)
    refuse_early(inputs, output)
    write = _WRITERS.get(output.suffix.lower())
    if write is None:
        raise click.UsageError(f"-o {output}: a scene is written as {', '.join(_WRITERS)}")
    scene = load(inputs, least=1)
    if inputs.has_poses:
        scene = posed_once(scene, inputs, "convert takes one pose, which places the links")
    scene.require_in_space("it cannot be converted")
    scene.require_one_unit()
    if not scene.bodies:
        return exit_codes.ERROR  # the errors are told
    lines, lost = write(output, scene, inputs)
    for line in lines:
        talk(harmless(line))
    for issue in scene.issues:
        if issue.severity == "warning":
            talk(harmless(f"satcheck: {issue_line(issue)}"))
    for body in lost:
        talk(harmless(f"satcheck: {body} is not in {output}: it could not be read"))
    return exit_codes.INCOMPLETE if lost else exit_codes.CLEAN


def _write_scene(output: Path, scene: Scene, inputs: Inputs) -> Told:
    write_file(output, new_scene_file(output, scene, inputs.mesh_files(scene.reading)))
    lost = left_out_of(scene)
    stated = len(scene.bodies) + len(scene.unreadable) - len(lost)
    rules = len(scene.rules) + len(scene.body_rules)
    lines = [f"{output}: {counted(stated, 'body', 'bodies')}, {counted(rules, 'rule')}"]
    if (stray := stray_mesh(output, scene)) is not None:
        lines.append(f"note: to read {output} give --allow-outside, because of {stray}")
    if scene.robots:
        lines.append("note: joints are not written: the links stand where the pose puts them")
    return lines, lost


def _write_glb(output: Path, scene: Scene, inputs: Inputs) -> Told:
    del inputs
    nodes = [Node(body.id, body.file.mesh, body.transform) for body in scene.bodies]
    write_file(output, glb(nodes, scene.units))
    error = with_unit(at_most(rounding(nodes)), unit_of(scene.units))
    lines = [
        f"{output}: {counted(len(nodes), 'body', 'bodies')}; "
        f"32-bit numbers move a vertex by {error}"
    ]
    curved = sum(body.shape is not None and is_curved(body.shape) for body in scene.bodies)
    if curved:
        shapes = counted(curved, "curved shape is", "curved shapes are")
        lines.append(f"note: {shapes} written as facets that lie within")
    if scene.rules or scene.body_rules or scene.motions:
        lines.append("note: GLB has no rules and no motions: they are not written")
    return lines, [body.id for body in scene.unreadable]


_WRITERS: dict[str, Callable[[Path, Scene, Inputs], Told]] = {
    ".toml": _write_scene,
    ".json": _write_scene,
    ".glb": _write_glb,
}
