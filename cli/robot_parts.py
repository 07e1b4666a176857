"""Writes the convex parts of a robot: its URDF, with an OBJ file for each part beside it."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Final

import click
from msgspec.structs import replace

from satcheck.cli.inputs import Inputs
from satcheck.cli.output import cannot_write, write_file
from satcheck.scene import Body, Scene, written_meshes
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.opening import read_whole
from satcheck.scene.robot import SceneRobot
from satcheck.scene.robot.written_urdf import urdf_of_parts

URDF: Final = ".urdf"
_UNSAFE = re.compile(r"[^A-Za-z0-9_.-]")  # in names of files, on some systems


def in_links(scene: Scene) -> list[Body]:
    """Return the meshes of a robot, each in the frame of its link. Raises click.UsageError unless
    the scene is one robot with a mesh."""
    robot = _only_robot(scene)
    offsets = {body.id: None if body.offset == IDENTITY else body.offset for body in robot.bodies}
    meshes = [body for body in scene.bodies if body.shape is None]
    if not (meshes or scene.unreadable):
        raise click.UsageError(
            "no collider of this robot is a mesh, and other shapes are convex already; --geometry "
            "visual splits what is drawn"
        )
    return [replace(body, transform=offsets[body.id]) for body in meshes]


def write_urdf(
    output: Path, scene: Scene, parts: Mapping[str, Sequence[written_meshes.Part]], inputs: Inputs
) -> None:
    """Write a robot and the files of its parts, into the folder beside it that has its name.

    parts: id of a body -> its parts in the frame of its link. Equal parts share a file.
    """
    robot = _only_robot(scene)
    folder = output.with_suffix("")
    names: dict[tuple[bytes, bytes], str] = {}
    contents: dict[str, bytes] = {}
    for name, mesh in chain.from_iterable(parts.values()):
        if (key := mesh.to_bytes()) not in names:
            plain = _UNSAFE.sub("_", name)
            plain = f"{plain}.{len(names)}" if f"{plain}.obj" in contents else plain
            names[key] = f"{plain}.obj"
            contents[names[key]] = written_meshes.written([(plain, mesh)], ".obj", None)
    path = robot.robot.file
    back = os.path.relpath(Path(path).absolute().parent, output.absolute().parent)
    document = urdf_of_parts(
        read_whole(path, inputs.permitted.most_of_tree),
        robot,
        {id_: entry.line for id_, entry in scene.entries.items()},
        {
            id_: [f"{folder.name}/{names[mesh.to_bytes()]}" for _, mesh in own]
            for id_, own in parts.items()
        },
        inputs.geometry or "collision",
        "" if back == "." else Path(back).as_posix(),
    )
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise cannot_write(str(folder), error.strerror) from None
    read = {Path(body.file.path).resolve() for body in scene.bodies}
    for file, content in contents.items():
        if (folder / file).resolve() in read:
            raise click.UsageError(f"{folder / file} would overwrite an input")
        write_file(folder / file, content)
    write_file(output, document)


def _only_robot(scene: Scene) -> SceneRobot:
    own = [body.id for robot in scene.robots for body in robot.bodies]
    if len(scene.robots) != 1 or not {body.id for body in scene.bodies}.issubset(own):
        raise click.UsageError(f"parts as {URDF} are those of one robot: give its URDF alone")
    return scene.robots[0]
