"""Child processes for code that may hang, abort or use all memory.

`run_isolated("some.module", request, ...)` runs `serve(request: bytes) -> bytes` of that module in
a fresh interpreter and returns the reply. A `Worker` keeps the interpreter for further requests. A
fresh interpreter works on Windows, unlike a fork, and inherits no threads and no locks. If a native
library corrupts its memory, only the child dies.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from itertools import chain, islice
from queue import SimpleQueue
from typing import IO, TypeVar

from satcheck.core.worker_errors import (
    WorkerCrashed,
    WorkerError,
    WorkerFailed,
    WorkerNotStarted,
    WorkerOutOfMemory,
    WorkerStopped,
    WorkerTimeout,
)
from satcheck.core.worker_frames import (
    CHUNK_BYTES,
    HEADER,
    MEMORY_SIGNS,
    OUT_OF_MEMORY,
    REPLY,
    REQUEST,
    frame_header,
    frame_length,
    parcel,
    parse_frame,
)

__all__ = [
    "Worker",
    "WorkerCrashed",
    "WorkerError",
    "WorkerFailed",
    "WorkerNotStarted",
    "WorkerOutOfMemory",
    "WorkerStopped",
    "WorkerTimeout",
    "end_all_children",
    "run_isolated",
]

T = TypeVar("T")

_BYTES_PER_MEGABYTE = 1 << 20
_STDERR_TAIL_BYTES = 1 << 13  # of a child's standard error, kept for the error message
_STDERR_TAIL_LINES = 6
_POLL_SECONDS = 0.1  # interval of checks for Ctrl-C, which a blocked wait would not notice
_REAP_SECONDS = 5.0  # time for a child that closed its replies to end
# While a child answers many requests, the pauses between two readings of its replies: short enough
# that few replies fit into them, and the pipe holds them.
_REST_SECONDS = 0.01
_WINDOWS_NO_MEMORY_EXIT_CODE = 0xC0000017  # STATUS_NO_MEMORY

_children: set[_Child] = set()


def run_isolated(module: str, request: bytes, *, seconds: float, megabytes: int) -> bytes:
    """Runs `serve(request)` of the named module in a child of its own and returns the reply.

    Arguments and errors are those of Worker and Worker.ask().
    """
    with Worker(module, megabytes=megabytes) as worker:
        return worker.ask(request, seconds=seconds)


def end_all_children() -> None:
    """Kills every child of this process, for a process that ends itself without a farewell: a child
    whose native code keeps Python busy would notice that late."""
    for child in tuple(_children):
        child.kill()


class Worker:
    """A child process that answers one request after another. Close it, or use it in a `with`
    statement.

    module: importable name, under the same interpreter and environment; the working directory is
        not on the child's path.
    megabytes: limit of the child's address space in MiB. Systems that refuse such a limit (macOS,
        Windows) still have the time limit. A reply larger than this is refused everywhere.
    folder: the working directory of the child; None: that of this process.

    The first request starts the child.

    If the child dies, the next request starts a new one. It runs with one OpenMP thread. Threads
    may share a worker; their requests run one after another. answered: the number of requests that
    the current child has answered. last_words: if the last request lost its child, the end of what
    the child wrote to its standard error. grouped: the child gets a process group (on POSIX), so
    that its own children die when it does.
    """

    def __init__(
        self, module: str, *, megabytes: int, grouped: bool = False, folder: str | None = None
    ) -> None:
        self._module = module
        self._grouped = grouped and os.name == "posix"
        self.last_words = ""
        self._megabytes = megabytes
        self._folder = folder
        self._child: _Child | None = None
        self.answered = 0
        self._stopped = False
        self._turn = threading.Lock()

    def ask(self, request: bytes, *, seconds: float) -> bytes:
        """The reply. seconds: wall-clock limit, including the start of the child; the child is then
        killed.

        Raises WorkerNotStarted, WorkerStopped, WorkerTimeout, WorkerOutOfMemory or WorkerCrashed.
        Raises WorkerFailed if serve() itself raises; the child survives that.
        """
        (reply,) = self.replies([request], seconds=seconds)
        return reply

    def replies(
        self,
        requests: Iterable[bytes],
        *,
        seconds: float,
        ahead: Callable[[], int] = lambda: 1,
    ) -> Iterator[bytes]:
        """The replies to these requests, in their order, as they come. seconds: for each, after the
        reply before it. ahead: the most requests that the child may have at a time, so that it need
        not wait for this process.

        Raises what `ask` raises: the first request without a reply is to blame, and the child has
        not begun those after it. What the child had answered before it was lost or stopped is given
        first. The child ends if it still has requests when the iteration is left.
        """
        left = iter(requests)
        with self._turn:
            self.last_words = ""
            due = 0
            try:
                while True:
                    may_send = due <= ahead() // 2 and not (due and self._stopped)
                    if may_send and (sent := list(islice(left, ahead() - due))):
                        due += len(sent)
                        self._started().send(sent, seconds)
                    if not due:
                        return
                    assert self._child is not None
                    frame = self._child.reply(seconds)
                    if frame is None:
                        raise self._lost(seconds)
                    due -= 1
                    self.answered += 1
                    yield self._payload(*frame)
            finally:
                if due:
                    self._end()

    def _started(self) -> _Child:
        if self._child is None:
            self._child = _Child(self._module, self._megabytes, self._grouped, self._folder)
            self.answered = 0
        if self._stopped:  # stop() may have looked for a child before there was this one
            raise WorkerStopped(self._module)
        return self._child

    def _payload(self, status: bytes, payload: bytes) -> bytes:
        if status == REPLY:
            return payload
        if status == OUT_OF_MEMORY:
            self._end()
            raise WorkerOutOfMemory(self._module, self._megabytes)
        exception_type, _, exception_message = payload.decode("utf-8", "replace").partition("\n")
        raise WorkerFailed(self._module, exception_type, exception_message)

    def close(self) -> None:
        with self._turn:
            self._end()

    def stop(self) -> None:
        """Kills the child, even during a request of another thread. That request and all later ones
        raise WorkerStopped."""
        self._stopped = True
        if (child := self._child) is not None:
            child.kill()

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _end(self) -> _Child | None:
        child, self._child = self._child, None
        self.answered = 0
        if child is not None:
            child.end()
            self.last_words = bytes(child.stderr_tail).decode("utf-8", "replace")
        return child

    def _lost(self, seconds: float) -> WorkerError:
        """The reason why there is no reply, after the child has ended."""
        child = self._end()
        assert child is not None
        if self._stopped:
            return WorkerStopped(self._module)
        if child.reply_too_large:
            return WorkerOutOfMemory(self._module, self._megabytes)
        if child.timed_out:
            return WorkerTimeout(self._module, seconds)
        tail = "\n".join(self.last_words.splitlines()[-_STDERR_TAIL_LINES:])
        no_memory = child.exit_code == _WINDOWS_NO_MEMORY_EXIT_CODE
        if no_memory or any(sign in tail for sign in MEMORY_SIGNS):
            return WorkerOutOfMemory(self._module, self._megabytes)
        return WorkerCrashed(self._module, child.exit_code, tail)


class _Child:
    """A process and its three pipes. A thread serves each pipe, so that no pipe blocks another.

    Raises WorkerNotStarted. exit_code: after end().
    """

    def __init__(self, module: str, megabytes: int, grouped: bool, folder: str | None) -> None:
        import subprocess

        self._module = module
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "satcheck.core.worker_child", module, str(megabytes)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                bufsize=0,
                env=environment,
                process_group=0 if grouped else None,
                cwd=folder,
            )
        except OSError as error:
            raise WorkerNotStarted(module, str(error)) from error
        self._grouped = grouped
        self.timed_out = False
        self.reply_too_large = False
        self.stderr_tail = bytearray()
        self.exit_code = 0
        self._replies: deque[bytes] = deque()
        self._reply_limit = megabytes * _BYTES_PER_MEGABYTE + HEADER.size
        self._due = 0  # replies
        self._waits_since = 0.0
        self._answered = threading.Event()
        self._ending = threading.Event()
        self._closed = False  # the child closed its replies
        self._requests: SimpleQueue[list[bytes] | None] = SimpleQueue()
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        assert self._process.stderr is not None
        self._threads: list[threading.Thread] = []
        _children.add(self)
        self._threads.append(self._start(self._receive, self._process.stdout))
        self._threads.append(self._start(self._listen, self._process.stderr))
        self._threads.append(self._start(self._send, self._process.stdin))

    def send(self, requests: list[bytes], seconds: float) -> None:
        """Send requests to the child. seconds: for each."""
        if self._due == len(self._replies):
            self._waits_since = time.monotonic()
        self._due += len(requests)
        self._requests.put([parcel(each, seconds) for each in requests])

    def reply(self, seconds: float) -> tuple[bytes, bytes] | None:
        """(status, payload) of the next reply; None: there is none, or not in time."""
        while True:
            # Before the look: the last reply comes before the end.
            was_closed = self._closed or self.reply_too_large
            if self._replies:
                self._due -= 1
                return parse_frame(self._replies.popleft())
            remaining = self._waits_since + seconds - time.monotonic()
            self.timed_out = remaining <= 0.0 and not was_closed
            if was_closed or self.timed_out:
                return None
            self._answered.wait(min(remaining, _POLL_SECONDS))
            self._answered.clear()

    def kill(self) -> None:
        if not self._grouped:
            self._process.kill()
        elif self._process.returncode is None:  # else another group may have its number
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, signal.SIGKILL)

    def end(self) -> None:
        """Kills the child. A child that is already ending gets time to report the reason. The other
        processes of a group do not wait for that: the exit code of its first one is settled."""
        import subprocess

        with self._process:
            if self._closed and not self._grouped:
                with suppress(subprocess.TimeoutExpired):
                    self._process.wait(_REAP_SECONDS)
            self.kill()
            self._ending.set()
            self._requests.put(None)
            self.exit_code = self._process.wait()
            _children.discard(self)
            for thread in self._threads:
                thread.join(_REAP_SECONDS)

    def _start(self, work: Callable[[T], None], argument: T) -> threading.Thread:
        thread = threading.Thread(target=work, args=(argument,), daemon=True)
        try:
            thread.start()
        except RuntimeError as error:  # the system grants no more threads
            self.end()
            raise WorkerNotStarted(self._module, str(error)) from error
        return thread

    def _send(self, pipe: IO[bytes]) -> None:
        """The pipe stays open, because the child ends when it closes."""
        with suppress(OSError):  # the child has ended; its exit code gives the reason
            while (requests := self._requests.get()) is not None:
                pieces = ((frame_header(REQUEST, each), each) for each in requests)
                view = memoryview(b"".join(chain.from_iterable(pieces)))
                while view:
                    view = view[pipe.write(view) :]

    def _receive(self, pipe: IO[bytes]) -> None:
        data = bytearray()
        while chunk := pipe.read(CHUNK_BYTES):
            data += chunk
            while (length := frame_length(data)) is not None and len(data) >= length:
                self._replies.append(bytes(memoryview(data)[:length]))
                del data[:length]
                self._waits_since = time.monotonic()
                self._answered.set()
            if length is not None and length > self._reply_limit:
                self.reply_too_large = True
                break
            if not data and self._due > len(self._replies):
                self._ending.wait(_REST_SECONDS)
        self._closed = not self.reply_too_large
        self._answered.set()

    def _listen(self, pipe: IO[bytes]) -> None:
        while chunk := pipe.read(CHUNK_BYTES):
            self.stderr_tail += chunk
            del self.stderr_tail[:-_STDERR_TAIL_BYTES]
