"""What the registry knows of MJCF files. A child process imports MuJoCo, which reads them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.scene.document import Document
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import File, Option, Reader, imported, reader_of_robot

if TYPE_CHECKING:
    from satcheck.plugins.mjcf.compiling import Compiled
    from satcheck.scene.robot.model import RobotDocument

ENDING = ".xml"
MESH_HULLS = Option("mesh_hulls", bool, "true: hulls of meshes, as in MuJoCo", False)


def read_mjcf(file: File) -> RobotDocument:
    """Return the robot of a file, in its pose qpos0, and issues. Raises SatcheckError."""
    if file.location.suffix.lower() != ENDING:
        message = f"MuJoCo reads files that end in {ENDING}: rename it"
        raise Refused("unsupported-format", message)
    read = _compiled(file)
    from satcheck.plugins.mjcf.reading import Reading

    return Reading(read, file.path, file.options).document()


def own_meshes(file: File) -> Document:
    """Return the meshes that only MuJoCo reads. Raises SatcheckError."""
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


READERS = (
    Reader(
        "mjcf",
        "MJCF",
        (ENDING,),
        "satcheck.plugins.mjcf.readers:read_mjcf",
        kind="robot",
        options=(MESH_HULLS,),
        roots=("mujoco",),
        texts=(),
    ),
    Reader(
        "mjcf",
        "MJCF",
        (ENDING,),
        "satcheck.plugins.mjcf.readers:own_meshes",
        kind="robot",
        by_name=True,
    ),
)
