"""The formats that are read in a child process, from this process' side.

A file of such a format is untrusted input to large parsers, so all of its reading (the checks
before, the parser, the checks after) happens in `foreign_worker`, with a time and memory limit.
"""

from __future__ import annotations

from satcheck.core.worker import WorkerError, WorkerFailed, WorkerTimeout
from satcheck.scene.codes import CODES
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import protocol
from satcheck.scene.loading.raw_mesh import RawScene
from satcheck.scene.loading.reading_children import ReadingChildren
from satcheck.scene.loading.source import Source

_WORKER = "satcheck.scene.loading.foreign_worker"
_LONGEST_MESSAGE = 200  # characters of what a library says
_CODE_OF_WORKER = {
    "worker-timeout": "reader-timeout",
    "worker-out-of-memory": "reader-out-of-memory",
}


def read_foreign(
    source: Source,
    children: ReadingChildren,
    *,
    flat: bool,
    allow_outside: bool,
    seconds: float,
    megabytes: int,
) -> RawScene:
    """The meshes of a file of such a format; flat: as one mesh. Raises MeshFileError."""
    directory = str(source.location.absolute().parent)
    request = protocol.pack_request(
        source.format, directory, source.data, flat=flat, allow_outside=allow_outside
    )
    try:
        reply = children.ask(_WORKER, request, seconds=seconds)
    except WorkerError as error:
        raise refused_by_worker(error, source, megabytes) from error
    try:
        return protocol.unpack_reply(reply)
    except MeshFileError as error:
        code = error.code if error.code in CODES else "reader-failed"
        raise MeshFileError(code, error.message, file=source.path) from None


def refused_by_worker(error: WorkerError, source: Source, megabytes: int) -> MeshFileError:
    """What to tell of a child that was stopped or died while it read."""
    code = _CODE_OF_WORKER.get(error.code, "reader-failed")
    return MeshFileError(code, _explain(error, source, megabytes), file=source.path)


def _explain(error: WorkerError, source: Source, megabytes: int) -> str:
    kind = source.format.upper()
    if isinstance(error, WorkerTimeout):
        return f"reading this {kind} file was stopped after {error.seconds:g} s"
    if error.code == "worker-out-of-memory":
        return f"reading this {kind} file needs more than {megabytes} MiB"
    if isinstance(error, WorkerFailed):
        return _one_line(
            f"the {kind} reader failed: {error.exception_type}: {error.exception_message}"
        )
    return _one_line(f"the {kind} reader died: {error.message}")


def _one_line(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST_MESSAGE else line[:_LONGEST_MESSAGE] + " ..."
