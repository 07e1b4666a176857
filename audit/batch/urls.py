"""Files at URLs, through fsspec (the extra `remote`).

Every function raises SatcheckError: `unreachable-url`, and `missing-extra` without fsspec or
without the package of the scheme.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from satcheck.core.errors import SatcheckError

# The slashes of `file:///` belong to the head, so that what follows is never an absolute path.
_URL = re.compile(r"([A-Za-z][A-Za-z0-9+.-]*:///?)(.*)", re.DOTALL)
_PIECE_BYTES = 1 << 20


def is_url(name: str) -> bool:
    return _URL.fullmatch(name) is not None


def split(url: str) -> tuple[str, str]:
    """(head, path), as `s3://` and `bucket/file`."""
    match = _URL.fullmatch(url)
    assert match is not None
    return match[1], match[2]


def download(url: str, path: Path) -> bool:
    """Whether there is such a file. Half a file never has the path."""
    beside = path.with_name(f"{path.name}.download")
    with _system(url) as (system, name):
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            system.get_file(name, str(beside))
        except FileNotFoundError:
            return False
        beside.replace(path)
    return True


def upload(path: Path, url: str) -> None:
    """The file appears at the URL as a whole where the file system can do that, as objects do."""
    with _system(url) as (system, name):
        system.put_file(str(path), name)


def remove(url: str) -> None:
    """Also if there is none."""
    with _system(url) as (system, name):
        if system.exists(name):
            system.rm_file(name)


def matches(pattern: str) -> list[str]:
    """The URLs that a pattern (`*`, `**`, `?`, `[...]`) stands for, sorted."""
    head, _ = split(pattern)
    with _system(pattern) as (system, name):
        return sorted(head + _without_head(each) for each in system.glob(name))


def lines(url: str) -> Iterator[bytes]:
    """Of a file."""
    with _system(url) as (system, name), system.open(name, "rb") as file:
        yield from file


def digest(url: str) -> str | None:
    """The SHA-256 of a file; None: nothing is there."""
    sha256 = hashlib.sha256()
    with _system(url) as (system, name):
        try:
            with system.open(name, "rb") as file:
                while piece := file.read(_PIECE_BYTES):
                    sha256.update(piece)
        except FileNotFoundError:
            return None
    return sha256.hexdigest()


@contextmanager
def _system(url: str) -> Iterator[tuple[Any, str]]:
    """The file system, and the name of the file in it."""
    try:
        from fsspec.core import url_to_fs
    except ImportError:
        reason = "reading a URL needs fsspec: pip install 'satcheck[remote]'"
        raise SatcheckError("missing-extra", reason, file=url) from None
    try:
        yield url_to_fs(url)
    except ImportError as error:
        reason = f"{error}: its package is to be installed beside satcheck"
        raise SatcheckError("missing-extra", reason, file=url) from None
    except SatcheckError:
        raise
    except Exception as error:  # file systems raise what their libraries raise
        reason = f"cannot be reached: {type(error).__name__}: {error}"
        raise SatcheckError("unreachable-url", reason, file=url) from error


def _without_head(name: str) -> str:
    """Of a name that a file system lists, with its scheme or without."""
    return (split(name)[1] if is_url(name) else name).lstrip("/")
