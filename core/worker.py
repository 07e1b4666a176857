"""Code that may hang, abort or eat the memory, run in a disposable child process.

`run_isolated("some.module", request, ...)` runs that module's `serve(request: bytes) -> bytes` in
a fresh interpreter (`python -P -m satcheck.core.worker some.module`) and returns the reply. A fresh
interpreter rather than a fork: it works on Windows, inherits no threads and no locks of ours, and
a native library that corrupts its memory takes only the child with it.

The two pipes carry one frame each: magic, status, length, CRC-32, payload. The child moves its
standard output to its standard error before it imports the module, so whatever a native library
prints never reaches the reply nor our own output. The request pipe stays open until the reply is
there; when it closes early (the parent was killed), the child ends itself.
"""

from __future__ import annotations

import os
import struct
import sys
import threading
import time
import zlib
from typing import IO, TYPE_CHECKING

from satcheck.core.worker_errors import (
    WorkerCrashed,
    WorkerError,
    WorkerFailed,
    WorkerNotStarted,
    WorkerOutOfMemory,
    WorkerTimeout,
)

if TYPE_CHECKING:
    from subprocess import Popen

__all__ = [
    "WorkerCrashed",
    "WorkerError",
    "WorkerFailed",
    "WorkerNotStarted",
    "WorkerOutOfMemory",
    "WorkerTimeout",
    "run_isolated",
]

_HEADER = struct.Struct("<8scQI")  # magic, status, payload length in bytes, CRC-32 of the payload
_MAGIC = b"SATWRK01"
_REQUEST = b"Q"
_REPLY = b"R"
_FAILED = b"F"
_OUT_OF_MEMORY = b"M"

_BYTES_PER_MEGABYTE = 1 << 20
_CHUNK_BYTES = 1 << 16  # one pipe read
_STDERR_TAIL_BYTES = 1 << 13  # of a child's talk, kept for the error message
_STDERR_TAIL_LINES = 6
_POLL_SECONDS = 0.1  # between looks for Ctrl-C, where a blocked wait would not notice it
_REAP_SECONDS = 5.0  # for a child that closed its reply, and for its pipes, to be gone
_ORPHANED_EXIT_CODE = 3
_MEMORY_SIGNS = (
    "bad_alloc",
    "MemoryError",
    "Cannot allocate memory",
    "out of memory",
    "failed to map segment",  # a shared library that did not fit
)
_WINDOWS_NO_MEMORY_EXIT_CODE = 0xC0000017  # STATUS_NO_MEMORY


def run_isolated(module: str, request: bytes, *, seconds: float, megabytes: int) -> bytes:
    """Runs `serve(request)` of the named module in a child process and returns its reply.

    module: importable name, under the same interpreter and environment; the working directory is
        not on the child's path.
    seconds: wall-clock limit, start of the interpreter included; then the child is killed.
    megabytes: limit of the child's address space in MiB. Systems that refuse such a limit (macOS,
        Windows) still have the time limit. A reply larger than this is refused everywhere.

    The child runs with one OpenMP thread. Raises WorkerNotStarted, WorkerTimeout,
    WorkerOutOfMemory, WorkerCrashed, or WorkerFailed when serve() itself raises.
    """
    import subprocess

    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    deadline = time.monotonic() + seconds
    try:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", "satcheck.core.worker", module, str(megabytes)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            bufsize=0,
            env=environment,
        )
    except OSError as error:
        raise WorkerNotStarted(module, str(error)) from error
    with process:
        conversation = _Conversation(process, request, megabytes * _BYTES_PER_MEGABYTE)
        try:
            finished = conversation.wait(deadline)
            if finished and not conversation.reply_too_large:
                _let_go(process)
        finally:
            process.kill()  # also on Ctrl-C
            exit_code = process.wait()
            conversation.join(_REAP_SECONDS)
    return _judge(module, conversation, finished, exit_code, seconds, megabytes)


def _let_go(process: Popen[bytes]) -> None:
    """Waits until a child that has closed its reply is gone, for the sake of its exit code."""
    import subprocess

    try:
        process.wait(_REAP_SECONDS)
    except subprocess.TimeoutExpired:
        return  # the caller kills it


class _Conversation:
    """The three pipes of one child, each served by a thread so that none can block the others."""

    def __init__(self, process: Popen[bytes], request: bytes, reply_limit: int) -> None:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        self.reply = bytearray()
        self.reply_too_large = False
        self.stderr_tail = bytearray()
        self._reply_limit = reply_limit + _HEADER.size
        self._closed = threading.Event()
        self._threads = (
            threading.Thread(target=self._send, args=(process.stdin, request), daemon=True),
            threading.Thread(target=self._receive, args=(process.stdout,), daemon=True),
            threading.Thread(target=self._listen, args=(process.stderr,), daemon=True),
        )
        for thread in self._threads:
            thread.start()

    def wait(self, deadline: float) -> bool:
        """Whether the child closed its reply (by answering or by dying) before the deadline."""
        while not self._closed.is_set():
            remaining = deadline - time.monotonic()
            if remaining <= 0.0:
                return False
            self._closed.wait(min(remaining, _POLL_SECONDS))
        return True

    def join(self, seconds: float) -> None:
        for thread in self._threads:
            thread.join(seconds)

    def _send(self, pipe: IO[bytes], request: bytes) -> None:
        try:
            for piece in (_frame_header(_REQUEST, request), request):
                view = memoryview(piece)
                while view:
                    view = view[pipe.write(view) :]
        except OSError:
            return  # the child is gone; its exit code tells the story
        # Not closed here: to the child, the end of this pipe is the end of its parent.

    def _receive(self, pipe: IO[bytes]) -> None:
        while chunk := pipe.read(_CHUNK_BYTES):
            self.reply += chunk
            if len(self.reply) > self._reply_limit:
                self.reply_too_large = True
                break
        self._closed.set()

    def _listen(self, pipe: IO[bytes]) -> None:
        while chunk := pipe.read(_CHUNK_BYTES):
            self.stderr_tail += chunk
            del self.stderr_tail[:-_STDERR_TAIL_BYTES]


def _judge(
    module: str,
    conversation: _Conversation,
    finished: bool,
    exit_code: int,
    seconds: float,
    megabytes: int,
) -> bytes:
    """The reply, or the error that says why there is none."""
    if conversation.reply_too_large:
        raise WorkerOutOfMemory(module, megabytes)
    frame = _parse_frame(bytes(conversation.reply))
    if frame is not None:
        status, payload = frame
        if status == _REPLY:
            return payload
        if status == _OUT_OF_MEMORY:
            raise WorkerOutOfMemory(module, megabytes)
        exception_type, _, exception_message = payload.decode("utf-8", "replace").partition("\n")
        raise WorkerFailed(module, exception_type, exception_message)
    if not finished:
        raise WorkerTimeout(module, seconds)
    text = bytes(conversation.stderr_tail).decode("utf-8", "replace")
    tail = "\n".join(text.splitlines()[-_STDERR_TAIL_LINES:])
    if exit_code == _WINDOWS_NO_MEMORY_EXIT_CODE or any(sign in tail for sign in _MEMORY_SIGNS):
        raise WorkerOutOfMemory(module, megabytes)
    raise WorkerCrashed(module, exit_code, tail)


def _frame_header(status: bytes, payload: bytes) -> bytes:
    return _HEADER.pack(_MAGIC, status, len(payload), zlib.crc32(payload))


def _parse_frame(data: bytes) -> tuple[bytes, bytes] | None:
    """(status, payload), or None when the frame is truncated or damaged."""
    if len(data) < _HEADER.size:
        return None
    magic, status, length, checksum = _HEADER.unpack_from(data)
    payload = data[_HEADER.size :]
    if magic != _MAGIC or len(payload) != length or zlib.crc32(payload) != checksum:
        return None
    return status, payload


def _child_main(module: str, megabytes: int) -> None:
    """The child's side. Never returns: exit handlers of native libraries must not run."""
    import signal

    # The terminal sends Ctrl-C to the child too; native code would not see a KeyboardInterrupt.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    reply_fd = os.dup(1)
    os.dup2(2, 1)
    _limit_resources(megabytes)
    request = _read_request()
    threading.Thread(target=_exit_with_parent, daemon=True).start()
    status, payload = _serve(module, request)
    frame = memoryview(_frame_header(status, payload) + payload)
    while frame:
        frame = frame[os.write(reply_fd, frame) :]
    os._exit(0)


def _serve(module: str, request: bytes) -> tuple[bytes, bytes]:
    import importlib

    try:
        reply = importlib.import_module(module).serve(request)
        if not isinstance(reply, bytes):
            raise TypeError(f"serve() returned {type(reply).__name__}, not bytes")
    except MemoryError:
        return _OUT_OF_MEMORY, b""
    except Exception as error:  # noqa: BLE001  (handed on to the parent, whatever it is)
        kind = type(error)
        name = kind.__qualname__
        if kind.__module__ != "builtins":
            name = f"{kind.__module__}.{name}"
        if any(sign in str(error) for sign in _MEMORY_SIGNS):
            return _OUT_OF_MEMORY, b""
        return _FAILED, f"{name}\n{error}".encode("utf-8", "replace")
    return _REPLY, reply


def _read_request() -> bytes:
    header = _read_exactly(_HEADER.size)
    length = _HEADER.unpack(header)[2]
    frame = _parse_frame(header + _read_exactly(length))
    if frame is None:
        os._exit(_ORPHANED_EXIT_CODE)
    return frame[1]


def _read_exactly(length: int) -> bytes:
    data = bytearray()
    while len(data) < length:
        chunk = os.read(0, min(length - len(data), _CHUNK_BYTES))
        if not chunk:
            os._exit(_ORPHANED_EXIT_CODE)
        data += chunk
    return bytes(data)


def _exit_with_parent() -> None:
    if not os.read(0, 1):
        os._exit(_ORPHANED_EXIT_CODE)


def _limit_resources(megabytes: int) -> None:
    """No core dump, no crash dialog, no more than `megabytes` MiB of address space."""
    if sys.platform == "win32":
        import msvcrt

        msvcrt.SetErrorMode(msvcrt.SEM_FAILCRITICALERRORS | msvcrt.SEM_NOGPFAULTERRORBOX)
        return
    import resource

    limits = {
        resource.RLIMIT_CORE: 0,
        resource.RLIMIT_AS: megabytes * _BYTES_PER_MEGABYTE,
    }
    for kind, wanted in limits.items():
        _, hard = resource.getrlimit(kind)
        ceiling = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        try:
            resource.setrlimit(kind, (ceiling, ceiling))
        except (ValueError, OSError):
            # macOS refuses address-space limits: said in run_isolated(), the time limit holds.
            continue


if __name__ == "__main__":
    _child_main(sys.argv[1], int(sys.argv[2]))
