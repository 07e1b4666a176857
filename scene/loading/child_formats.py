"""Reads files in a child process.

Such a file is untrusted input to large parsers. All of its reading, checks included, happens in
`serve`, with a time limit and a memory limit. The request and its answer are MessagePack messages,
and msgspec checks their types.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Self

import msgspec
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.core.worker import WorkerError, WorkerFailed, WorkerTimeout
from satcheck.scene.errors import MeshFileError
from satcheck.scene.files_read import files_read, note, note_lost_reader
from satcheck.scene.issue import CODES
from satcheck.scene.loading.raw_mesh import RawScene, Refusal
from satcheck.scene.loading.readers import File, ReadLimits, reader_of
from satcheck.scene.loading.reading import read_with
from satcheck.scene.loading.reading_children import ReadingChildren
from satcheck.scene.permitted import ANYWHERE, NOTHING_ELSE, Permitted

_LONGEST_MESSAGE = 200  # characters of what a library says
_CODE_OF_WORKER = {
    "worker-timeout": "reader-timeout",
    "worker-out-of-memory": "reader-out-of-memory",
}


class Request(msgspec.Struct, frozen=True):
    """A file to read, without its names: these are bytes, as those of some files are no UTF-8.

    folders: that the file may name files in, beside its own; None: all.
    """

    directory: bytes
    name: bytes
    folders: tuple[bytes, ...] | None
    file: File

    @classmethod
    def about(cls, file: File, directory: str) -> Self:
        """directory: of the file, absolute."""
        may = file.permitted
        folders = None if may.anywhere else tuple(map(os.fsencode, may.folders))
        names = os.fsencode(directory), os.fsencode(file.name)
        blank = replace(file, directory="", name="", path="", permitted=NOTHING_ELSE, isolated=True)
        return cls(*names, folders, blank)

    def named(self) -> File:
        """Return the file with its names."""
        folders = self.folders
        may = ANYWHERE if folders is None else Permitted(tuple(map(os.fsdecode, folders)))
        directory, name = os.fsdecode(self.directory), os.fsdecode(self.name)
        return replace(self.file, directory=directory, name=name, permitted=may)


class Reply(msgspec.Struct, frozen=True):
    """files: those that the file refers to, read or looked for."""

    content: RawScene | Refusal
    files: tuple[bytes, ...]


def read_in_child(file: File, children: ReadingChildren, allowed: ReadLimits) -> RawScene:
    """Return the meshes of a file. Raises MeshFileError."""
    path, folder = file.path, Path(file.directory)
    directory = str(folder.absolute())
    request = msgspec.msgpack.encode(Request.about(file, directory))
    try:
        reply = children.ask(__name__, request, seconds=allowed.seconds)
        answer = msgspec.msgpack.decode(reply, type=Reply)
    except WorkerError as error:
        note_lost_reader()
        raise refused_by_worker(error, file.format, path, allowed.megabytes) from error
    except msgspec.DecodeError:
        message = "the reader's answer is damaged"
        raise MeshFileError("reader-failed", message, file=path) from None
    for name in answer.files:
        note(_as_given(Path(os.fsdecode(name)), directory, folder))
    content = answer.content
    if isinstance(content, Refusal):
        code = content.code if content.code in CODES else "reader-failed"
        raise MeshFileError(code, content.message, file=path)
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
    file = msgspec.msgpack.decode(message, type=Request).named()
    with files_read() as files:
        content = _content(file)
    return msgspec.msgpack.encode(Reply(content, tuple(map(os.fsencode, files))))


def _content(file: File) -> RawScene | Refusal:
    reader = reader_of(file.location.suffix)
    assert reader is not None  # the parent has found it
    try:
        return read_with(reader, file)
    except SatcheckError as error:
        return Refusal(error.code, error.message)
