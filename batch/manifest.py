"""The scenes of a batch as a file names them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import msgspec

from satcheck.batch.check_options import World
from satcheck.core.errors import SatcheckError

_JSON_LIST = "["


def read_manifest(path: Path) -> Iterator[World]:
    """A scene for each line: the name of a file, relative to the working directory, or a JSON list
    of files that are one scene together. Empty lines are skipped.

    Raises SatcheckError: `unreadable-file`, `bad-manifest`.
    """
    try:
        with path.open("rb") as lines:
            for number, line in enumerate(lines, 1):
                if text := os.fsdecode(line).strip():
                    yield _world(text, f"{path}:{number}")
    except OSError as error:
        reason = f"cannot be read: {error.strerror}"
        raise SatcheckError("unreadable-file", reason, file=str(path)) from None


def _world(line: str, place: str) -> World:
    if not line.startswith(_JSON_LIST):
        return (line,)
    try:
        world = msgspec.json.decode(line, type=World)
    except msgspec.DecodeError as error:
        raise SatcheckError("bad-manifest", f"no list of files: {error}", file=place) from None
    if not world:
        raise SatcheckError("bad-manifest", "the list of files is empty", file=place)
    return world
