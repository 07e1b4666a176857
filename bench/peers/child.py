"""Asks a peer about many pairs, one after another, and outlives it."""

from __future__ import annotations

import os
import select
import subprocess
from collections.abc import Iterable, Iterator, Sequence

from bench.peers.protocol import Answer, answer_of

# No pair of the hard cases takes a library that answers at all longer than this.
SECONDS = 10.0


def answers(
    command: Sequence[str], lines: Iterable[str], seconds: float = SECONDS
) -> Iterator[Answer]:
    """One answer a line. A child that dies or hangs is started again for the next line."""
    return map(answer_of, replies(command, lines, seconds))


def replies(command: Sequence[str], lines: Iterable[str], seconds: float) -> Iterator[str]:
    """The same, as the line that the child writes; `crash` or `hang` where it writes none."""
    child: subprocess.Popen[bytes] | None = None
    for line in lines:
        if child is None:
            child = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
            )
        reply = _ask(child, line, seconds)
        if reply in ("crash", "hang"):
            _end(child)
            child = None
        yield reply
    if child is not None:
        _end(child)


def _ask(child: subprocess.Popen[bytes], line: str, seconds: float) -> str:
    assert child.stdin is not None
    assert child.stdout is not None
    try:
        child.stdin.write(line.encode() + b"\n")
        child.stdin.flush()
    except BrokenPipeError:
        return "crash"
    text = b""
    while not text.endswith(b"\n"):
        if not select.select([child.stdout], [], [], seconds)[0]:
            return "hang"
        part = os.read(child.stdout.fileno(), 65536)
        if not part:
            return "crash"
        text += part
    return text.decode()


def _end(child: subprocess.Popen[bytes]) -> None:
    child.kill()
    child.communicate()
