"""Files at URLs, through fsspec (the extra `remote`): the copies that a check reads, and results.

A cache of fsspec keeps its files in one folder, so that a scene finds no mesh beside it, and takes
the half of a file, which a killed process has left, for the file. So the copies here have the
layout of the URLs, and get their names when they are whole.
"""

from __future__ import annotations

import hashlib
import os
import posixpath
import re
import shutil
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp
from typing import Any
from urllib.parse import quote, unquote

import msgspec
from msgspec.structs import replace

from satcheck.audit.batch.options import World
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import InputFile
from satcheck.scene.files.readers import robot_endings

# The slashes of `file:///` belong to the head, so that what follows is never an absolute path.
_URL = re.compile(r"([A-Za-z][A-Za-z0-9+.-]*:///?)(.*)", re.DOTALL)
_MOST_BYTES = 2 << 30  # of copies


def is_url(name: str) -> bool:
    return ":/" in name and _URL.fullmatch(name) is not None  # few names are URLs


def is_remote(world: World) -> bool:
    return any(map(is_url, world))


@contextmanager
def at(url: str) -> Iterator[tuple[Any, str]]:
    """Yield the file system, and the name of the file in it. What fails within is a SatcheckError:
    `unreachable-url`, or `missing-extra` without fsspec or the package of the scheme."""
    try:
        from fsspec.core import url_to_fs

        yield url_to_fs(url)
    except ImportError as error:
        reason = f"{error}: pip install 'satcheck[remote]', and the package of the scheme"
        raise SatcheckError("missing-extra", reason, file=url) from None
    except Exception as error:  # file systems raise what their libraries raise
        reason = f"cannot be reached: {type(error).__name__}: {error}"
        raise SatcheckError("unreachable-url", reason, file=url) from error


def download(url: str, path: Path) -> bool:
    """Copy a file, and return whether there is one."""
    half = path.with_name(f"{path.name}.download")
    with at(url) as (system, name):
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            system.get_file(name, str(half))
        except FileNotFoundError:
            return False
        half.replace(path)
    return True


def upload(path: Path, url: str) -> None:
    """Bring the file to the URL, or its absence. Raises SatcheckError (`cannot-write`)."""
    try:
        with at(url) as (system, name):
            if path.exists():
                system.put_file(str(path), name)
            elif system.exists(name):
                system.rm_file(name)
    except SatcheckError as error:
        reason = f"{error.message}. The results are in {path}"
        raise SatcheckError("cannot-write", reason, file=url) from error


def digest(url: str) -> str | None:
    """Return the SHA-256 of a file; None: nothing is there."""
    with at(url) as (system, name):
        try:
            with system.open(name, "rb") as file:
                return hashlib.file_digest(file, "sha256").hexdigest()
        except FileNotFoundError:
            return None


@contextmanager
def local_results(url: str, ending: str) -> Iterator[Path]:
    """Yield a local file for the results at a URL while a batch runs, as objects take no lines.
    That with this ending at its name (`results.PART`) is there, too. Both are stored when the run
    ends, however it ends. If that fails, they stay."""
    path = Path(mkdtemp(prefix="satcheck-results-")) / "results.jsonl"
    part = path.with_name(path.name + ending)
    download(url, path)
    if not download(url + ending, part):
        part.touch()
        upload(part, url + ending)  # that fails now rather than at the end
    kept = {part: url + ending}
    try:
        yield path
        kept = {path: url, **kept}
    finally:
        for file, name in kept.items():
            upload(file, name)
        shutil.rmtree(path.parent)


class Copies:
    """Copies of the files of a world. Worlds with the same roots share them, so that a mesh is
    fetched once. Nothing else is in their folder, so that no check finds what lies outside of the
    roots."""

    def __init__(self, folder: Path, world: World, *, anywhere: bool) -> None:
        """anywhere: also of files outside of the folders of the world."""
        self._roots = tuple(sorted({_root(name, anywhere) for name in filter(is_url, world)}))
        key = hashlib.sha256("\n".join(self._roots).encode("utf-8", "surrogateescape"))
        self._folder = folder.resolve() / key.hexdigest()[:16]

    def path(self, name: str) -> str:
        """Return where the copy of this file is. A local file is its own copy."""
        head, path = _split(name)
        return str(self._folder / quote(head, safe="") / path) if head else name

    def url(self, path: str) -> str | None:
        """Return the URL of the file with this copy; None: a local file."""
        place = Path(os.path.normpath(path))
        if self._folder not in place.parents:
            return None
        head, _, rest = place.relative_to(self._folder).as_posix().partition("/")
        return unquote(head) + rest

    def fetch(self, paths: Iterable[str]) -> bool:
        """Copy those of these files that have no copy, and return whether there was one. Raises
        SatcheckError."""
        wanted = {path: self.url(path) for path in paths if not Path(path).exists()}
        fetched = [
            download(url, Path(os.path.normpath(path)))
            for path, url in wanted.items()
            if url is not None and url.startswith(self._roots)
        ]
        return any(fetched)

    def inputs(self, read: Iterable[InputFile]) -> tuple[InputFile, ...]:
        """Return the files under their URLs. Folders of copies are left out, as nobody lists the
        remote ones, and so is what was looked for above the copies."""
        known = []
        for file in read:
            url = self.url(file.path)
            if url is None:
                above = self._folder.is_relative_to(Path(file.path).parent)
                known += [] if above and file.sha256 is None else [file]
            elif not file.path.endswith("/") and not Path(file.path).is_dir():
                known.append(replace(file, path=url))
        return tuple(sorted(known, key=lambda file: file.path))

    def with_urls(self, text: bytes) -> bytes:
        """Return JSON with URLs instead of the paths of copies."""
        for head in {_split(root)[0] for root in self._roots}:
            place = msgspec.json.encode(f"{self.path(head)}{os.sep}")[1:-1]
            text = text.replace(place, head.encode())
        return text


def make_room(folder: Path) -> None:
    """Remove copies that have become too many."""
    if sum(each.stat().st_size for each in folder.rglob("*")) > _MOST_BYTES:
        shutil.rmtree(folder)


def _split(url: str) -> tuple[str, str]:
    """Return `s3://` and `bucket/file`, without `..`, also where it leads above everything; no head
    of a local file."""
    match = _URL.fullmatch(url)
    return (match[1], posixpath.normpath(f"/{match[2]}").lstrip("/")) if match else ("", url)


def _root(url: str, anywhere: bool) -> str:
    """Return the begin of the URLs of the files of a world. As with local files, these are in the
    folder of the world, and for a robot in the folder above it; else, on the same host or in the
    same bucket. A robot in XML of another ending is known as such only when it is here."""
    head, path = _split(url)
    folders = path.split("/")[:-1]
    if anywhere:
        folders = folders[:1]
    elif posixpath.splitext(path)[1].lower() in robot_endings() and len(folders) > 1:
        folders = folders[:-1]
    return head + "".join(f"{folder}/" for folder in folders)
