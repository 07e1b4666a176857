"""Asks the child process in which MuJoCo reads MJCF files, and what it does there."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.plugins.mjcf.readers import ENDING
from satcheck.scene.document import Document
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import File, RobotFile, imported, is_robot
from satcheck.scene.files.reading_children import read_in_child
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.issue import Issue
from satcheck.scene.robot.model import Robot

if TYPE_CHECKING:
    from satcheck.plugins.mjcf.compiling import Compiled

_MODEL = "satcheck.plugins.mjcf.child:model"


class Answer(Struct, frozen=True, tag=True):
    """What the child process makes of a file."""

    robot: Robot
    issues: tuple[Issue, ...]


def read_mjcf(root: Element, robot: RobotFile) -> tuple[Robot, tuple[Issue, ...]]:
    """Return the robot of a file, in its pose qpos0, and issues. Raises Refused."""
    path, allowed = root.file, robot.allowed
    location = Path(path)
    if location.suffix.lower() != ENDING:
        message = f"MuJoCo reads files that end in {ENDING}: rename it"
        raise Refused("unsupported-format", message, file=path)
    file = File(
        "mjcf",
        str(location.parent),
        location.name,
        b"",
        0,
        {**robot.options, "geometry": robot.geometry},
        permitted=allowed.permitted,
        path=path,
        packages={name: str(place) for name, place in robot.packages.items()},
    )
    answer = read_in_child(file, _MODEL, Answer, robot.children, allowed)
    return answer.robot, answer.issues


def model(file: File) -> Answer:
    """Return what MuJoCo makes of a file, in the child process. Raises SatcheckError."""
    read = _compiled(file)
    from satcheck.plugins.mjcf.reading import robot_of

    return robot_of(read, file.path, file.options)


def own_meshes(file: File) -> Document:
    """Return the meshes that only MuJoCo reads, in the child process. Raises SatcheckError."""
    if not is_robot(file.location):
        message = f"unsupported format {ENDING!r}: the outermost element is that of no robot"
        raise Refused("unsupported-format", message)
    read = _compiled(replace(file, path=str(file.location)))
    from satcheck.plugins.mjcf.compiling import own_meshes_of

    return own_meshes_of(read)


def _compiled(file: File) -> Compiled:
    imported("mujoco", "mjcf", "MJCF files")
    from satcheck.plugins.mjcf.compiling import compiled

    return compiled(file)
