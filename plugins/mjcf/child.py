"""What the child process does with MJCF files, if MuJoCo is installed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.plugins.mjcf.asking import Answer
from satcheck.plugins.mjcf.readers import ENDING
from satcheck.scene.errors import Refused
from satcheck.scene.input_kind import is_robot
from satcheck.scene.loading.extras import imported
from satcheck.scene.loading.raw_mesh import RawScene
from satcheck.scene.loading.readers import File

if TYPE_CHECKING:
    from satcheck.plugins.mjcf.compiling import Compiled


def model(file: File) -> Answer:
    """Return what MuJoCo makes of a file. Raises SatcheckError."""
    read = _compiled(file)
    from satcheck.plugins.mjcf.reading import robot_of

    return robot_of(read, file.path, file.options)


def own_meshes(file: File) -> RawScene:
    """Return the meshes that only MuJoCo reads. Raises SatcheckError."""
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
