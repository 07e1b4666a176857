"""What the child process does with MJCF files, if MuJoCo is installed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from satcheck.core.errors import SatcheckError
from satcheck.plugins.mjcf.messages import Answer, Model, Request
from satcheck.plugins.mjcf.readers import ENDING
from satcheck.scene.errors import MeshFileError
from satcheck.scene.files_read import files_read
from satcheck.scene.input_kind import is_robot
from satcheck.scene.loading.extras import imported
from satcheck.scene.loading.raw_mesh import RawScene, Refusal
from satcheck.scene.loading.readers import File

if TYPE_CHECKING:
    from satcheck.plugins.mjcf.compiling import Compiled


def serve(message: bytes) -> bytes:
    """Return the answer to a request about a model. It may be a Refusal."""
    request = msgspec.msgpack.decode(message, type=Request)
    with files_read() as files:
        content = _content(request)
    return msgspec.msgpack.encode(Answer(content, tuple(files)))


def own_meshes(file: File) -> RawScene:
    """Return the meshes that only MuJoCo reads. Raises SatcheckError."""
    if not is_robot(file.location):
        message = f"unsupported format {ENDING!r}: the outermost element is that of no robot"
        raise MeshFileError("unsupported-format", message)
    read = _compiled(Request(str(file.location), {}, file.permitted))
    from satcheck.plugins.mjcf.contents import own_meshes_of

    return own_meshes_of(read)


def _content(request: Request) -> Model | Refusal:
    try:
        read = _compiled(request)
        from satcheck.plugins.mjcf.contents import model_of

        return model_of(read)
    except SatcheckError as error:
        return Refusal(error.code, error.message)


def _compiled(request: Request) -> Compiled:
    imported("mujoco", "mjcf", "MJCF files")
    from satcheck.plugins.mjcf.compiling import compiled

    return compiled(request)
