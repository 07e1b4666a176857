"""What the answer for a world depends on: the contents of files, the options, the version."""

from __future__ import annotations

import hashlib
import json
import os
import stat
from collections import OrderedDict
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from msgspec import to_builtins
from msgspec.structs import replace

from satcheck._version import __version__
from satcheck.audit.batch import remote
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.report.batch import InputFile
from satcheck.scene.opening import FilesRead, Permitted, Signature, search_path

_MOST_DIGESTS = 5_000
# Settings that change no answer.
_WITHOUT_EFFECT = frozenset({"jobs", "cache", "cache_directory", "timings"})


def digest(name: str) -> str | None:
    """The SHA-256 of a file; of `folder/`: of the names of the folders in it. None: nothing is
    there. What is there and cannot be read has a digest that says why. Raises SatcheckError for a
    URL that cannot be reached."""
    if remote.is_url(name):
        return remote.digest(name)
    try:
        if name.endswith("/"):
            return _sha256(
                "\0".join(sorted(each.name for each in os.scandir(name) if each.is_dir()))
            )
        mode = Path(name).stat().st_mode
        if not stat.S_ISREG(mode):
            return _sha256(f"type {stat.S_IFMT(mode):o}")
        with Path(name).open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except (FileNotFoundError, NotADirectoryError, ValueError):
        return None
    except OSError as error:
        return _sha256(f"error {error.errno}")


class _Known(NamedTuple):
    """place: where the file really lies."""

    at: Signature
    digest: str | None
    place: str


class Digests:
    """The digests and places of files that did not change since they were made."""

    def __init__(self) -> None:
        self._known: OrderedDict[str, _Known] = OrderedDict()

    def digest(self, files: FilesRead, name: str) -> str | None:
        """files: the name is one of them."""
        at = files.signature(name)
        known = self._known.pop(name, None)
        if known is None or known.at != at:
            known = _Known(at, digest(name), real_path(name))
        if files.is_settled(name):
            self._known[name] = known
            if len(self._known) > _MOST_DIGESTS:
                self._known.popitem(last=False)
        return known.digest

    def real_path(self, name: str) -> str:
        """After `digest`. A file that is not there has nothing that would show a change."""
        known = self._known.get(name)
        return real_path(name) if known is None or known.at is None else known.place


def inputs_of(names: Iterable[str], digest: Callable[[str], str | None]) -> tuple[InputFile, ...]:
    return tuple(InputFile(name, digest(name)) for name in sorted(names))


def real_path(name: str) -> str:
    try:
        return name if remote.is_url(name) else os.path.realpath(name)
    except ValueError:  # a NUL: no file has this name
        return name


def key_of(
    world: World,
    terms: str,
    inputs: tuple[InputFile, ...],
    folders: Sequence[str] = (),
    real_path: Callable[[str], str] = real_path,
) -> str:
    """terms: of the options, see `terms_of`. folders: that the user gave. Where a file really lies
    counts: the names of packages and bodies, and what a scene may read, depend on it."""
    files = [(each.path, real_path(each.path), each.sha256) for each in inputs]
    around = Permitted.around(world, folders).folders
    return _sha256(json.dumps([terms, world, files, around]))


def terms_of(options: CheckOptions, limits: Limits | None = None) -> str:
    """A digest of what else the answers depend on, the same for all worlds of a batch, without the
    folders. limits: of
    answers without the steps that ended a process, as such a step may need more than these."""
    settings = {k: v for k, v in options.settings.items() if k not in _WITHOUT_EFFECT}
    stated = to_builtins(replace(options, settings=settings, folders=()))
    return _sha256(
        json.dumps([__version__, stated, search_path(), to_builtins(limits)], sort_keys=True)
    )


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()
