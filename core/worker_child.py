"""The child's side of `core.worker`: `python -P -m satcheck.core.worker_child MODULE MEGABYTES`.

Standard output is redirected to standard error before the module is imported, so that prints of a
native library reach neither the replies nor the parent's output. Requests are answered one after
another. When their pipe closes (the parent is done, or was killed), the child ends itself, even
during work. A timer ends it if native code keeps Python from noticing that.
"""

from __future__ import annotations

import os
import sys
import threading
from queue import SimpleQueue
from typing import NoReturn

from satcheck.core.worker_frames import (
    CHUNK_BYTES,
    FAILED,
    HEADER,
    MEMORY_SIGNS,
    OUT_OF_MEMORY,
    REPLY,
    frame_header,
    frame_length,
    parse_frame,
    unwrapped,
)

_BYTES_PER_MEGABYTE = 1 << 20
_ORPHANED_EXIT_CODE = 3
# A request may take this much longer than its limit before the child ends itself: if there is a
# parent, it has ended the child at the limit.
_GRACE_SECONDS = 5.0
_LONGEST_SECONDS = 1e8
_NO_MEMORY = b"MemoryError\n"  # the parent looks for it in the last lines


def main(module: str, megabytes: int) -> None:
    """Never returns: exit handlers of native libraries must not run."""
    import signal

    # The terminal sends Ctrl-C to the child too; native code would not see a KeyboardInterrupt.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if sys.platform != "win32":
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
    reply_fd = os.dup(1)
    os.dup2(2, 1)
    requests: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_read_requests, args=(requests,), daemon=True).start()
    _limit_resources(megabytes)  # no thread starts under a small limit
    while True:
        request, seconds = unwrapped(requests.get())
        _end_after(seconds + _GRACE_SECONDS)
        status, payload = _serve(module, request)
        _end_after(0.0)
        frame = memoryview(frame_header(status, payload) + payload)
        while frame:
            frame = frame[os.write(reply_fd, frame) :]


def _end_after(seconds: float) -> None:
    """0: never."""
    if sys.platform != "win32":
        import signal

        signal.setitimer(signal.ITIMER_REAL, min(seconds, _LONGEST_SECONDS))


def _serve(module: str, request: bytes) -> tuple[bytes, bytes]:
    import importlib

    try:
        reply = importlib.import_module(module).serve(request)
        if not isinstance(reply, bytes):
            raise TypeError(f"serve() returned {type(reply).__name__}, not bytes")
    except MemoryError:
        return OUT_OF_MEMORY, b""
    except Exception as error:  # noqa: BLE001  (handed on to the parent, whatever it is)
        kind = type(error)
        name = kind.__qualname__
        if kind.__module__ != "builtins":
            name = f"{kind.__module__}.{name}"
        if any(sign in str(error) for sign in MEMORY_SIGNS):
            return OUT_OF_MEMORY, b""
        return FAILED, f"{name}\n{error}".encode("utf-8", "replace")
    return REPLY, reply


def _read_requests(requests: SimpleQueue[bytes]) -> None:
    """Several may wait: one reading of the pipe takes them all."""
    try:
        with open(0, "rb", buffering=CHUNK_BYTES, closefd=False) as pipe:
            while length := frame_length(header := pipe.read(HEADER.size)):
                frame = parse_frame(header + pipe.read(length - HEADER.size))
                if frame is None:
                    break
                requests.put(frame[1])
        _end_as_orphan()
    except MemoryError:  # the main thread would wait for the request
        os.write(2, _NO_MEMORY)
        os._exit(1)


def _end_as_orphan() -> NoReturn:
    """The first process of a group takes the others with it, as its parent would have done."""
    if sys.platform != "win32" and os.getpgrp() == os.getpid():
        import signal

        os.killpg(0, signal.SIGKILL)
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
            # macOS refuses address-space limits. The time limit still holds, see core.worker.
            continue


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
