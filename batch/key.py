"""What the answer for a world depends on: the contents of files, the options, the version."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from pathlib import Path

import msgspec
from msgspec.structs import replace

from satcheck._version import __version__
from satcheck.batch.check_options import CheckOptions, World
from satcheck.report.batch import InputFile

# Settings that change no answer.
_WITHOUT_EFFECT = frozenset({"jobs", "cache", "cache_directory", "timings"})
_PIECE_BYTES = 1 << 20


def digest(path: str) -> str | None:
    """The SHA-256 of a file; None: it is not there, or cannot be read."""
    try:
        with Path(path).open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError):
        return None


def inputs_of(paths: Iterable[str], digest: Callable[[str], str | None]) -> tuple[InputFile, ...]:
    return tuple(InputFile(path, digest(path)) for path in sorted(paths))


def key_of(world: World, options: CheckOptions, inputs: tuple[InputFile, ...]) -> str:
    settings = {k: v for k, v in options.settings.items() if k not in _WITHOUT_EFFECT}
    about = (__version__, world, replace(options, settings=settings), inputs)
    return hashlib.sha256(msgspec.msgpack.encode(about, order="deterministic")).hexdigest()
