"""The child processes that read the files of a run.

A file of a large parser is untrusted input. All of its reading, checks included, happens in
`serve`, with a time limit and a memory limit. The answer is a MessagePack message, and msgspec
checks its type. A child reads many files, because importing its large parsers takes
longer than reading most files. If a file stops or kills its child, only this file fails, and the
next file gets a new child.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Generic, TypeVar

import msgspec
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.core.plugins import function_at
from satcheck.core.worker_errors import (
    WorkerCrashed,
    WorkerError,
    WorkerFailed,
    WorkerOutOfMemory,
    WorkerTimeout,
)
from satcheck.scene.access import DEFAULT_MEGABYTES_PER_FILE, files_read, note, note_lost_reader
from satcheck.scene.document import Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import File, ReadLimits
from satcheck.scene.issue import CODES

Content = TypeVar("Content")

_LONGEST_MESSAGE = 200  # characters of what a library says


class ReadingChildren:
    """A child process, and a new one when it has died. megabytes: its limit. module: which serves.
    The child ends by `close`, when this object is deleted, or when the process ends."""

    def __init__(self, megabytes: int, module: str = __name__) -> None:
        from weakref import finalize

        from satcheck.core.worker import Worker

        self._worker = Worker(module, megabytes=megabytes)
        finalize(self, self._worker.close)

    def ask(self, request: bytes, *, seconds: float) -> bytes:
        """`serve(request)` of the module. seconds: for this request. Raises WorkerError.

        Earlier files may have used up the memory of a child, or damaged it. If such a child fails,
        a new one decides, so that no answer depends on earlier files.
        """
        fresh = self._worker.answered == 0
        try:
            return self._worker.ask(request, seconds=seconds)
        except (WorkerOutOfMemory, WorkerCrashed):
            if fresh:
                raise
            return self._worker.ask(request, seconds=seconds)

    def close(self) -> None:
        self._worker.close()


class Reply(msgspec.Struct, Generic[Content], frozen=True):
    """files: those that the file refers to, read or looked for."""

    content: Content | Refusal
    files: tuple[bytes, ...]


def read_in_child(
    file: File, read: str, kind: type[Content], children: ReadingChildren, allowed: ReadLimits
) -> Content:
    """Return what a function, "module:name", makes of a file in a child process: an object of this
    kind. Raises Refused."""
    import pickle  # few checks need a child

    directory = str(Path(file.directory).absolute())
    try:
        sent = pickle.dumps((read, replace(file, directory=directory, isolated=True)))
        reply = children.ask(sent, seconds=allowed.seconds)
        answer = msgspec.msgpack.decode(reply, type=Reply[kind])  # type: ignore[valid-type]
    except WorkerError as error:
        note_lost_reader()
        raise _lost(error, file, allowed.permitted.megabytes) from error
    except msgspec.DecodeError:
        message = "the reader's answer is damaged"
        raise Refused("reader-failed", message, file=file.path) from None
    for name in answer.files:
        note(_as_given(Path(os.fsdecode(name)), directory, file.directory))
    content: Content | Refusal = answer.content
    if isinstance(content, Refusal):
        code = content.code if content.code in CODES else "reader-failed"
        raise Refused(code, content.message, file=file.path)
    return content


def _as_given(file: Path, directory: str, folder: str) -> Path:
    """The file by the path of its folder as given; it may lie elsewhere."""
    return Path(folder) / file.relative_to(directory) if file.is_relative_to(directory) else file


def _lost(error: WorkerError, file: File, megabytes: int) -> Refused:
    """The error for a child that was stopped or died while it read a file."""
    kind, code = file.format.upper(), "reader-failed"
    if isinstance(error, WorkerTimeout):
        limit = f"{error.seconds:g} s (raise it with --limit seconds=N)"
        code, said = "reader-timeout", f"reading this {kind} file was stopped after {limit}"
    elif error.code == "worker-out-of-memory":
        limit = f"{megabytes} MiB (raise it with --limit megabytes=N)"
        code, said = "reader-out-of-memory", f"reading this {kind} file needs more than {limit}"
    elif isinstance(error, WorkerFailed):
        what = f"{error.exception_type}: {error.exception_message}"
        said = _one_line(f"the {kind} reader failed: {what}")
    else:
        said = _one_line(f"the {kind} reader died: {error.message}")
    if code == "reader-failed" and megabytes < DEFAULT_MEGABYTES_PER_FILE:
        # A library that does not look whether it got memory fails or dies in any way.
        said += f"; {megabytes} MiB may be too little (raise it with --limit megabytes=N)"
    return Refused(code, said, file=file.path)


def _one_line(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST_MESSAGE else line[:_LONGEST_MESSAGE] + " ..."


def serve(message: bytes) -> bytes:
    """Runs in the child process. The answer may be a Refusal."""
    import pickle

    read, file = pickle.loads(message)
    with files_read() as files:
        content = _content(file, read)
    return msgspec.msgpack.encode(Reply(content, tuple(map(os.fsencode, files))))


def _content(file: File, read: str) -> object:
    try:
        return function_at(read)(file)
    except SatcheckError as error:
        return Refusal(error.code, error.with_line if isinstance(error, Refused) else error.message)
