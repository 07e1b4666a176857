"""Answers requests about MJCF files, in a child process, if MuJoCo is installed."""

from __future__ import annotations

import msgspec

from satcheck.plugins.mjcf.messages import Answer, Model, Request
from satcheck.scene.errors import MeshFileError, SceneFileError
from satcheck.scene.files_read import files_read
from satcheck.scene.loading.extras import imported
from satcheck.scene.loading.raw_mesh import RawScene, Refusal


def serve(message: bytes) -> bytes:
    """The answer may be a Refusal."""
    request = msgspec.msgpack.decode(message, type=Request)
    with files_read() as files:
        content = _content(request)
    return msgspec.msgpack.encode(Answer(content, tuple(files)))


def _content(request: Request) -> Model | RawScene | Refusal:
    try:
        imported("mujoco", "mjcf", "MJCF files")
        from satcheck.plugins.mjcf.compiling import compiled
        from satcheck.plugins.mjcf.contents import model_of, own_meshes_of

        read = compiled(request)
        return own_meshes_of(read) if request.only_meshes else model_of(read)
    except (MeshFileError, SceneFileError) as error:
        return Refusal(error.code, error.message)
