"""Worlds at URLs: a check reads copies of their files, and names the URLs."""

from __future__ import annotations

import hashlib
import os
import posixpath
import shutil
from collections.abc import Iterable
from pathlib import Path
from urllib.parse import quote, unquote

import msgspec
from msgspec.structs import replace

from satcheck.audit.batch.check_options import World
from satcheck.audit.batch.urls import download, is_url, split
from satcheck.report.batch import InputFile
from satcheck.scene.loading.readers import robots

_MOST_BYTES = 2 << 30  # of copies


def is_remote(world: World) -> bool:
    return any(map(is_url, world))


def make_room(folder: Path) -> None:
    """Removes copies that have become too many."""
    if sum(each.stat().st_size for each in folder.rglob("*")) > _MOST_BYTES:
        shutil.rmtree(folder)


class Copies:
    """Copies of the files of a world in the layout that they have at their URLs, with a folder for
    each kind of URL. Worlds with the same roots share them, so that a mesh is fetched once. Nothing
    else is in the folder, so that no check finds what lies outside of the roots."""

    def __init__(self, folder: Path, world: World, *, anywhere: bool) -> None:
        """anywhere: also of files outside of the folders of the world."""
        self._roots = tuple(sorted({_root(name, anywhere) for name in filter(is_url, world)}))
        key = hashlib.sha256("\n".join(self._roots).encode("utf-8", "surrogateescape"))
        self._folder = folder.resolve() / key.hexdigest()[:16]

    def path(self, name: str) -> str:
        """Where the copy of this file is. A local file is its own copy."""
        if not is_url(name):
            return name
        head, path = split(name)
        return str(self._folder / quote(head, safe="") / _tidy(path))

    def url(self, path: str) -> str | None:
        """Of the file with this copy; None: a local file."""
        place = Path(os.path.normpath(path))
        if self._folder not in place.parents:
            return None
        head, _, rest = place.relative_to(self._folder).as_posix().partition("/")
        return unquote(head) + rest

    def fetch(self, paths: Iterable[str]) -> bool:
        """Copies those of these files that have no copy; whether there was one. Raises
        SatcheckError (`batch.urls`)."""
        return sum(map(self._fetch, paths)) > 0

    def _fetch(self, path: str) -> bool:
        url = self.url(path)
        if url is None or not url.startswith(self._roots) or Path(path).exists():
            return False
        return download(url, Path(os.path.normpath(path)))

    def inputs(self, read: Iterable[InputFile]) -> tuple[InputFile, ...]:
        """By their URLs."""
        known = [
            replace(each, path=self.url(each.path) or each.path)
            for each in read
            if self._is_known(each)
        ]
        return tuple(sorted(known, key=lambda of: of.path))

    def _is_known(self, file: InputFile) -> bool:
        """Not a folder of copies, as nobody lists the remote ones, and nothing that was looked for
        above the copies."""
        if self.url(file.path) is not None:
            return not file.path.endswith("/") and not Path(file.path).is_dir()
        return file.sha256 is not None or not self._folder.is_relative_to(Path(file.path).parent)

    def with_urls(self, text: bytes) -> bytes:
        """JSON with URLs instead of the paths of copies."""
        for head in {split(root)[0] for root in self._roots}:
            place = msgspec.json.encode(f"{self.path(head)}{os.sep}")[1:-1]
            text = text.replace(place, head.encode())
        return text


def _root(url: str, anywhere: bool) -> str:
    """What the URLs of the files of a world begin with. As with local files, these are in the
    folder of the world, and for a robot in the folder above it; else, on the same host or in the
    same bucket. A robot in XML of another ending is known as such only when it is here."""
    head, path = split(url)
    folders = _tidy(path).split("/")[:-1]
    endings = {ending for reader in robots().values() for ending in reader.endings}
    if anywhere:
        folders = folders[:1]
    elif posixpath.splitext(path)[1].lower() in endings and len(folders) > 1:
        folders = folders[:-1]
    return head + "".join(f"{folder}/" for folder in folders)


def _tidy(path: str) -> str:
    """Without `..`, also where it leads above everything."""
    return posixpath.normpath(f"/{path}").lstrip("/")
