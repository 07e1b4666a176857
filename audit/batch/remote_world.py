"""Worlds at URLs: a check reads copies of their files, and names the URLs."""

from __future__ import annotations

import hashlib
import os
import posixpath
import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path

import msgspec
from msgspec.structs import replace

from satcheck.audit.batch import urls
from satcheck.audit.batch.check_options import World
from satcheck.report.batch import InputFile
from satcheck.scene.loading.readers import robots

# Copies beyond this size are removed before the next world.
_MOST_BYTES = 2 << 30
# Of robots; one in XML of another ending is known as such only when it is here.


def is_remote(world: World) -> bool:
    return any(map(urls.is_url, world))


class Copies:
    """A folder for copies of remote files. Worlds with the same roots share them, so that a mesh is
    fetched once."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder.resolve()
        self._bytes = 0

    def of(self, world: World, *, anywhere: bool) -> Copy:
        """anywhere: also of files outside of the folders of the world."""
        if self._bytes > _MOST_BYTES:
            shutil.rmtree(self._folder)
            self._bytes = 0
        roots = sorted({_root(name, anywhere=anywhere) for name in world if urls.is_url(name)})
        key = hashlib.sha256("\n".join(roots).encode("utf-8", "surrogateescape")).hexdigest()[:16]
        return Copy(self, self._folder / key, roots)

    def fetch(self, url: str, path: Path) -> bool:
        """Whether there is such a file."""
        there = urls.download(url, path)
        if there:
            self._bytes += path.stat().st_size
        return there


class Copy:
    """Copies of files below some URLs, the roots, in a folder that has nothing else, so that no
    check finds what lies outside. Below the folder each kind of URL has a number."""

    def __init__(self, copies: Copies, folder: Path, roots: Sequence[str]) -> None:
        self._copies = copies
        self._folder = folder
        self._roots = roots
        self._heads = sorted({urls.split(root)[0] for root in roots})
        self._missing: set[str] = set()

    def path(self, name: str) -> str:
        """Where the copy of this file is. A local file is its own copy."""
        if not urls.is_url(name):
            return name
        head, path = urls.split(name)
        return str(self._folder / str(self._heads.index(head)) / _tidy(path))

    def url(self, path: str) -> str | None:
        """Of the file with this copy; None: a local file."""
        try:
            inner = Path(os.path.normpath(path)).relative_to(self._folder)
        except ValueError:
            return None
        match inner.parts:
            case (number, *rest) if number.isdecimal():
                return self._heads[int(number)] + "/".join(rest)
        return None

    def fetch(self, paths: Iterable[str]) -> bool:
        """Copies those of these files that have no copy; whether there was one. Raises
        SatcheckError (`batch.urls`)."""
        return sum(map(self._fetch, paths)) > 0

    def _fetch(self, path: str) -> bool:
        url = self.url(path)
        if url is None or url in self._missing or Path(path).exists():
            return False
        allowed = any(map(url.startswith, self._roots))
        fetched = allowed and self._copies.fetch(url, Path(os.path.normpath(path)))
        if not fetched:
            self._missing.add(url)
        return fetched

    def inputs(self, read: Iterable[InputFile]) -> tuple[InputFile, ...]:
        """By their URLs. Folders of copies are left out, as nobody lists the remote ones, and what
        was looked for above the copies."""
        named = (self._named(each) for each in read)
        return tuple(sorted((each for each in named if each is not None), key=lambda of: of.path))

    def _named(self, file: InputFile) -> InputFile | None:
        url = self.url(file.path)
        if url is None:
            above = Path(file.path).parent in self._folder.parents
            return None if above and file.sha256 is None else file
        is_folder = file.path.endswith("/") or Path(file.path).is_dir()
        return None if is_folder else replace(file, path=url)

    def with_urls(self, text: bytes) -> bytes:
        """JSON with URLs instead of the paths of copies."""
        for number, head in enumerate(self._heads):
            place = msgspec.json.encode(f"{self._folder / str(number)}{os.sep}")[1:-1]
            text = text.replace(place, head.encode())
        return text


def _root(url: str, *, anywhere: bool) -> str:
    """What the URLs of the files of a world begin with. As with local files, these are in the
    folder of the world, and for a robot in the folder above it; else, on the same host or in the
    same bucket."""
    head, path = urls.split(url)
    folders = _tidy(path).split("/")[:-1]
    if anywhere:
        folders = folders[:1]
    elif posixpath.splitext(path)[1].lower() in _endings_of_robots() and len(folders) > 1:
        folders = folders[:-1]
    return head + "".join(f"{folder}/" for folder in folders)


def _tidy(path: str) -> str:
    """Without `..`, also where it leads above everything."""
    return posixpath.normpath(f"/{path}").lstrip("/")


def _endings_of_robots() -> set[str]:
    return {ending for reader in robots().values() for ending in reader.endings}
