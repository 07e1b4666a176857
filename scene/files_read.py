"""Which files are read or looked for, for callers that keep results of a check.

Whatever opens an input, or asks whether it is there, notes it here; nothing depends on whether
anybody listens.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_listening: list[dict[str, None]] = []


def note(location: str | Path) -> None:
    """location: of a file that the answer depends on, even if it is not there."""
    for listener in _listening:
        listener[str(location)] = None


@contextmanager
def files_read() -> Iterator[dict[str, None]]:
    """The files noted while it lasts, in that order, each once."""
    noted: dict[str, None] = {}
    _listening.append(noted)
    try:
        yield noted
    finally:
        _listening.remove(noted)
