"""Files at URLs, through fsspec (the extra `remote`)."""

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


def is_url(name: str) -> bool:
    return _URL.fullmatch(name) is not None


def split(url: str) -> tuple[str, str]:
    """(head, path), as `s3://` and `bucket/file`."""
    match = _URL.fullmatch(url)
    assert match is not None
    return match[1], match[2]


@contextmanager
def at(url: str) -> Iterator[tuple[Any, str]]:
    """The file system, and the name of the file in it. What fails within is a SatcheckError:
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
    """Whether there is such a file. Half a file never has the path."""
    beside = path.with_name(f"{path.name}.download")
    with at(url) as (system, name):
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            system.get_file(name, str(beside))
        except FileNotFoundError:
            return False
        beside.replace(path)
    return True


def digest(url: str) -> str | None:
    """The SHA-256 of a file; None: nothing is there."""
    with at(url) as (system, name):
        try:
            with system.open(name, "rb") as file:
                return hashlib.file_digest(file, "sha256").hexdigest()
        except FileNotFoundError:
            return None
