"""Reads MJCF files with MuJoCo, in a child process."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.plugins.mjcf.readers import ENDING
from satcheck.scene.document import Document
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import File, imported, reader_of_robot
from satcheck.scene.robot.model import RobotDocument

if TYPE_CHECKING:
    from satcheck.plugins.mjcf.compiling import Compiled


def read_mjcf(file: File) -> RobotDocument:
    """Return the robot of a file, in its pose qpos0, and issues. Raises SatcheckError."""
    if file.location.suffix.lower() != ENDING:
        message = f"MuJoCo reads files that end in {ENDING}: rename it"
        raise Refused("unsupported-format", message)
    read = _compiled(file)
    from satcheck.plugins.mjcf.reading import robot_of

    return robot_of(read, file.path, file.options)


def own_meshes(file: File) -> Document:
    """Return the meshes that only MuJoCo reads, in the child process. Raises SatcheckError."""
    if reader_of_robot(file.location) is None:
        message = f"unsupported format {ENDING!r}: the outermost element is that of no robot"
        raise Refused("unsupported-format", message)
    read = _compiled(replace(file, path=str(file.location)))
    from satcheck.plugins.mjcf.compiling import own_meshes_of

    return own_meshes_of(read)


def _compiled(file: File) -> Compiled:
    imported("mujoco", "mjcf", "MJCF files")
    from satcheck.plugins.mjcf.compiling import compiled

    return compiled(file)
