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
    child: subprocess.Popen[bytes] | None = None
    for line in lines:
        if child is None:
            child = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
            )
        answer = _ask(child, line, seconds)
        if answer.status in ("crash", "hang"):
            _end(child)
            child = None
        yield answer
    if child is not None:
        _end(child)


def _ask(child: subprocess.Popen[bytes], line: str, seconds: float) -> Answer:
    assert child.stdin is not None
    assert child.stdout is not None
    try:
        child.stdin.write(line.encode() + b"\n")
        child.stdin.flush()
    except BrokenPipeError:
        return Answer("crash")
    text = b""
    while not text.endswith(b"\n"):
        if not select.select([child.stdout], [], [], seconds)[0]:
            return Answer("hang")
        part = os.read(child.stdout.fileno(), 65536)
        if not part:
            return Answer("crash")
        text += part
    return answer_of(text.decode())


def _end(child: subprocess.Popen[bytes]) -> None:
    child.kill()
    child.communicate()
