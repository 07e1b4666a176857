"""What the answer for a world depends on: the contents of files, the options, the versions."""

from __future__ import annotations

import hashlib
import json
import os
import stat
from collections import OrderedDict
from collections.abc import Callable, Iterable, Sequence
from io import FileIO

from msgspec import to_builtins
from msgspec.structs import replace

from satcheck._version import __version__
from satcheck.audit.batch import remote
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.core.plugins import versions
from satcheck.report.assets import InputFile
from satcheck.scene.access import FilesRead, Permitted, Signature, search_path

_MOST_DIGESTS = 5_000
_BLOCK_BYTES = 1 << 18
_status, _is_link = os.stat, os.path.islink
# Settings that change no answer.
_WITHOUT_EFFECT = frozenset({"jobs", "cache", "cache_directory", "timings"})


def digest(name: str) -> str | None:
    """Return the SHA-256 of a file; of `folder/`: of the names of the folders in it. None: nothing
    is there. What is there and cannot be read has a digest that says why. Raises SatcheckError for
    a URL that cannot be reached."""
    if remote.is_url(name):
        return remote.digest(name)
    try:
        if name.endswith("/"):
            folders = sorted(each.name for each in os.scandir(name) if each.is_dir())
            return _sha256("\0".join(folders))
        mode = _status(name).st_mode
        if not stat.S_ISREG(mode):  # a pipe would be waited for
            return _sha256(f"type {stat.S_IFMT(mode):o}")
        made = hashlib.sha256()
        with FileIO(name) as file:
            while block := file.read(_BLOCK_BYTES):
                made.update(block)
        return made.hexdigest()
    except (FileNotFoundError, NotADirectoryError, ValueError):
        return None
    except OSError as error:
        return _sha256(f"error {error.errno}")


class Digests:
    """The digests of files that did not change since they were made, of those that no reading of
    the file gives."""

    def __init__(self) -> None:
        self._known: OrderedDict[str, tuple[Signature, str | None]] = OrderedDict()

    def digest(self, files: FilesRead, name: str) -> str | None:
        """files: the name is one of them."""
        if name in files.digests:
            return files.digests[name]
        at = files.signatures[name]
        known = self._known.pop(name, None)
        if known is None or known[0] != at:
            known = at, digest(name)
        if files.is_settled(name):
            self._known[name] = known
            if len(self._known) > _MOST_DIGESTS:
                self._known.popitem(last=False)
        return known[1]


def inputs_of(names: Iterable[str], digest: Callable[[str], str | None]) -> tuple[InputFile, ...]:
    return tuple(InputFile(name, digest(name)) for name in sorted(names))


def key_of(
    world: World, terms: str, inputs: tuple[InputFile, ...], folders: Sequence[str] = ()
) -> str:
    """Return the key of a result. terms: of the options, see `terms_of`. folders: that the user
    gave. Where a file really lies counts: the names of packages and bodies, and what a scene may
    read, depend on it."""
    places: dict[str, str] = {}
    files = [(each.path, _place(each.path, places), each.sha256) for each in inputs]
    around = Permitted.around(world, folders).folders
    return _sha256(json.dumps([terms, world, files, around]))


def _place(name: str, places: dict[str, str]) -> str:
    """Return the path without links. places: of the folders that are known so far."""
    if remote.is_url(name):
        return name
    folder, base = os.path.split(name)
    try:
        if base in ("", "..") or _is_link(name):
            return os.path.realpath(name)
        if folder not in places:
            places[folder] = os.path.realpath(folder)
        return f"{places[folder]}/{base}"
    except ValueError:  # a NUL: no file has this name
        return name


def terms_of(options: CheckOptions, limits: Limits | None = None) -> str:
    """A digest of what else the answers depend on, the same for all worlds of a batch, without the
    folders. limits: of answers without the steps that ended a process, as such a step may need more
    than these."""
    settings = {k: v for k, v in options.settings.items() if k not in _WITHOUT_EFFECT}
    stated = to_builtins(replace(options, settings=settings, folders=()))
    return _sha256(
        json.dumps(
            [__version__, versions(), stated, search_path(), to_builtins(limits)], sort_keys=True
        )
    )


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()
