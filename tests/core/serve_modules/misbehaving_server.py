"""A worker module that does, on request, what third-party libraries do to us."""

from __future__ import annotations

import ctypes
import os
import sys
import time


class RefusedRequest(Exception):
    pass


def serve(request: bytes) -> bytes:
    command, _, rest = request.partition(b" ")
    return _COMMANDS[command](rest)


def _echo(rest: bytes) -> bytes:
    return rest


def _chatter(rest: bytes) -> bytes:
    print("said by Python")  # noqa: T201
    os.write(1, b"said by native code\n" * 1000)
    os.write(2, b"complaint\n" * 100_000)
    sys.stdout.flush()
    return rest


def _abort(rest: bytes) -> bytes:
    os.write(2, b"first line\nlast words\n")
    os.abort()
    return rest


def _abort_on_memory(rest: bytes) -> bytes:
    os.write(2, b"terminate called after throwing an instance of 'std::bad_alloc'\n")
    os.abort()
    return rest


def _segfault(_rest: bytes) -> bytes:
    return ctypes.string_at(0)


def _exit(rest: bytes) -> bytes:
    os._exit(int(rest))
    return rest


def _hang(rest: bytes) -> bytes:
    time.sleep(600.0)
    return rest


def _record_and_hang(rest: bytes) -> bytes:
    with open(rest, "w", encoding="ascii") as file:  # noqa: PTH123
        file.write(str(os.getpid()))
    return _hang(rest)


def _eat_memory(rest: bytes) -> bytes:
    return bytes(int(rest) << 20)


def _raise(rest: bytes) -> bytes:
    raise RefusedRequest(rest.decode())


def _raise_builtin(rest: bytes) -> bytes:
    raise ValueError(rest.decode())


def _wrong_type(rest: bytes) -> bytes:
    return rest.decode()  # type: ignore[return-value]


def _environment(rest: bytes) -> bytes:
    return os.environ.get(rest.decode(), "").encode()


def _path(_rest: bytes) -> bytes:
    return "\n".join(sys.path).encode()


def _modules(_rest: bytes) -> bytes:
    return "\n".join(sys.modules).encode()


def _pid(_rest: bytes) -> bytes:
    return str(os.getpid()).encode()


_COMMANDS = {
    b"echo": _echo,
    b"chatter": _chatter,
    b"abort": _abort,
    b"abort_on_memory": _abort_on_memory,
    b"segfault": _segfault,
    b"exit": _exit,
    b"hang": _hang,
    b"record_and_hang": _record_and_hang,
    b"eat_memory": _eat_memory,
    b"raise": _raise,
    b"raise_builtin": _raise_builtin,
    b"wrong_type": _wrong_type,
    b"environment": _environment,
    b"path": _path,
    b"modules": _modules,
    b"pid": _pid,
}
