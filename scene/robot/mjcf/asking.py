"""Asks the child process in which MuJoCo reads MJCF files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import msgspec

from satcheck.core.worker import WorkerError
from satcheck.scene.errors import MeshFileError
from satcheck.scene.files_read import note, note_lost_reader
from satcheck.scene.issue import CODES
from satcheck.scene.loading import ReadLimits
from satcheck.scene.loading.child_formats import refused_by_worker
from satcheck.scene.loading.raw_mesh import RawScene, Refusal
from satcheck.scene.loading.reading_children import ReadingChildren
from satcheck.scene.loading.source import Source, read_source
from satcheck.scene.robot.mjcf.messages import Answer, Model, Request

MODEL_FORMATS = {".xml": "mjcf"}
_CHILD = "satcheck.scene.robot.mjcf.child"


def read_model(
    path: str,
    packages: Mapping[str, str | Path] | None,
    allowed: ReadLimits,
    children: ReadingChildren,
) -> Model:
    """The model of a file, in its pose qpos0. Raises MeshFileError."""
    if Path(path).suffix.lower() not in MODEL_FORMATS:
        message = "MuJoCo reads files that end in .xml: rename it"
        raise MeshFileError("unsupported-format", message, file=path)
    given = {name: str(place) for name, place in (packages or {}).items()}
    request = Request(path, given, allowed.permitted)
    content = _asked(request, allowed, children)
    assert isinstance(content, Model)
    return content


def read_own_meshes(
    path: str, location: Path, allowed: ReadLimits, children: ReadingChildren
) -> tuple[Source, RawScene]:
    """The file, and the meshes that only MuJoCo reads. Raises MeshFileError."""
    source = read_source(
        path,
        location,
        max_bytes=allowed.file_bytes,
        formats=MODEL_FORMATS,
        hashed=allowed.hashed,
    )
    request = Request(str(location), {}, allowed.permitted, only_meshes=True)
    content = _asked(request, allowed, children)
    assert isinstance(content, RawScene)
    return source, content


def _asked(request: Request, allowed: ReadLimits, children: ReadingChildren) -> Model | RawScene:
    file = request.path
    try:
        reply = children.ask(_CHILD, msgspec.msgpack.encode(request), seconds=allowed.seconds)
        answer = msgspec.msgpack.decode(reply, type=Answer)
    except WorkerError as error:
        note_lost_reader()
        raise refused_by_worker(error, "mjcf", file, allowed.megabytes) from error
    except msgspec.DecodeError:
        raise MeshFileError("reader-failed", "the reader's answer is damaged", file=file) from None
    for name in answer.files:
        note(name)
    content = answer.content
    if isinstance(content, Refusal):
        code = content.code if content.code in CODES else "reader-failed"
        raise MeshFileError(code, content.message, file=file)
    return content
