"""Reads 3MF, DAE, STEP, IFC, USD and some glTF files in a child process.

Such a file is untrusted input to large parsers. All of its reading, checks included, happens in
`serve`, with a time limit and a memory limit. The request and its answer are MessagePack messages,
and msgspec checks their types.
"""

from __future__ import annotations

import os
from pathlib import Path

import msgspec

from satcheck.core.errors import SatcheckError
from satcheck.core.worker import WorkerError, WorkerFailed, WorkerTimeout
from satcheck.scene.errors import MeshFileError
from satcheck.scene.files_read import files_read, note, note_lost_reader
from satcheck.scene.issue import CODES
from satcheck.scene.loading.raw_mesh import Block, RawScene, Refusal, alone
from satcheck.scene.loading.reading_children import ReadingChildren
from satcheck.scene.loading.source import Source
from satcheck.scene.permitted import ANYWHERE, Permitted
from satcheck.scene.read_options import ReadOptions

_OPENED_BY_NAME = frozenset(("usd",))
_LONGEST_MESSAGE = 200  # characters of what a library says
_CODE_OF_WORKER = {
    "worker-timeout": "reader-timeout",
    "worker-out-of-memory": "reader-out-of-memory",
}


class Request(msgspec.Struct, frozen=True):
    """A file to read: its format, the directory that its references are relative to, its name
    there, the folders beside it in which they may lie (None: all), whether to return one mesh for
    the whole file, the options of the user, and its bytes (none for a reader that opens it by
    name). Names are bytes, as those of some files are no UTF-8.
    """

    format: str
    directory: bytes
    name: bytes
    flat: bool
    permitted: tuple[bytes, ...] | None
    options: ReadOptions
    data: Block


class Reply(msgspec.Struct, frozen=True):
    """files: those that the file refers to, read or looked for."""

    content: RawScene | Refusal
    files: tuple[bytes, ...]


def read_in_child(
    source: Source,
    children: ReadingChildren,
    *,
    flat: bool,
    permitted: Permitted,
    options: ReadOptions,
    seconds: float,
    megabytes: int,
) -> RawScene:
    """The meshes of a file of such a format; flat: as one mesh. Raises MeshFileError."""
    directory = str(source.location.absolute().parent)
    data = b"" if source.format in _OPENED_BY_NAME else source.data
    request = Request(
        source.format,
        os.fsencode(directory),
        os.fsencode(source.location.name),
        flat,
        None if permitted.anywhere else tuple(map(os.fsencode, permitted.folders)),
        options,
        data,
    )
    try:
        reply = children.ask(__name__, msgspec.msgpack.encode(request), seconds=seconds)
        answer = msgspec.msgpack.decode(reply, type=Reply)
    except WorkerError as error:
        note_lost_reader()
        raise refused_by_worker(error, source.format, source.path, megabytes) from error
    except msgspec.DecodeError:
        message = "the reader's answer is damaged"
        raise MeshFileError("reader-failed", message, file=source.path) from None
    for file in answer.files:
        note(_as_given(Path(os.fsdecode(file)), directory, source.location.parent))
    content = answer.content
    if isinstance(content, Refusal):
        code = content.code if content.code in CODES else "reader-failed"
        raise MeshFileError(code, content.message, file=source.path)
    return content


def _as_given(file: Path, directory: str, folder: Path) -> Path:
    """The file by the path of its folder as given; it may lie elsewhere."""
    return folder / file.relative_to(directory) if file.is_relative_to(directory) else file


def refused_by_worker(
    error: WorkerError, file_format: str, path: str, megabytes: int
) -> MeshFileError:
    """The error for a child that was stopped or died while it read a file."""
    code = _CODE_OF_WORKER.get(error.code, "reader-failed")
    return MeshFileError(code, _explain(error, file_format.upper(), megabytes), file=path)


def _explain(error: WorkerError, kind: str, megabytes: int) -> str:
    if isinstance(error, WorkerTimeout):
        limit = f"{error.seconds:g} s (raise it with --seconds-per-file)"
        return f"reading this {kind} file was stopped after {limit}"
    if error.code == "worker-out-of-memory":
        limit = f"{megabytes} MiB (raise it with --megabytes-per-file)"
        return f"reading this {kind} file needs more than {limit}"
    if isinstance(error, WorkerFailed):
        return _one_line(
            f"the {kind} reader failed: {error.exception_type}: {error.exception_message}"
        )
    return _one_line(f"the {kind} reader died: {error.message}")


def _one_line(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST_MESSAGE else line[:_LONGEST_MESSAGE] + " ..."


def serve(message: bytes) -> bytes:
    """Runs in the child process. The answer may be a Refusal."""
    request = msgspec.msgpack.decode(message, type=Request)
    with files_read() as files:
        content = _content(request)
    return msgspec.msgpack.encode(Reply(content, tuple(map(os.fsencode, files))))


def _content(request: Request) -> RawScene | Refusal:
    try:
        scene = _read(request)
        if request.flat:
            from satcheck.scene.loading.flatten import flattened

            return alone(flattened(scene))
        return scene
    except SatcheckError as error:
        return Refusal(error.code, error.message)


def _read(request: Request) -> RawScene:
    data = memoryview(request.data)
    directory, folders = os.fsdecode(request.directory), request.permitted
    permitted = ANYWHERE if folders is None else Permitted(tuple(map(os.fsdecode, folders)))
    match request.format:
        case "3mf":
            from satcheck.scene.loading.threemf import read_3mf

            return read_3mf(data)
        case "dae":
            from satcheck.scene.loading.collada import read_collada

            return alone(read_collada(data))
        case "ifc":
            from satcheck.scene.loading.ifc import read_ifc

            return read_ifc(data, request.options)
        case "usd":
            from satcheck.scene.loading.usd import read_usd

            place = Path(directory, os.fsdecode(request.name))
            return read_usd(place, request.options, permitted)
        case "step":
            from satcheck.scene.loading.step.assembly import read_step

            return read_step(data, request.options)
    from satcheck.scene.loading.gltf import read_gltf

    return read_gltf(
        data,
        directory,
        binary=request.format == "glb",
        permitted=permitted,
        isolated=True,
        geometry=request.options.geometry,
    )
