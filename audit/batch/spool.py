"""Results at a URL: a local file stands for them while a batch runs, as objects take no lines."""

from __future__ import annotations

import hashlib
import shutil
import time
from pathlib import Path
from typing import Self

from filelock import FileLock, Timeout

from satcheck.audit.batch import urls
from satcheck.audit.batch.results import PART, part_of
from satcheck.core.errors import SatcheckError
from satcheck.decompose.cache import default_directory

_SECONDS_BETWEEN_UPLOADS = 60.0
# Of the time of a run, for uploads of what is there so far.
_SHARE_OF_TIME = 0.05
_PIECE_BYTES = 1 << 20


class Spool:
    """`path` is a local file that stands for the one at the URL, and its `.part` for that at the
    URL with `.part` (`results.ResultsFile`). Both are fetched at the beginning. The part is
    uploaded at intervals, and when a run is ended; the whole file when a run has finished. A spool
    whose upload fails stays, and the next run begins with it.

    Use it in a `with` statement around the ResultsFile of the path. Raises SatcheckError:
    `results-in-use`, `cannot-write`, and those of `batch.urls`.
    """

    def __init__(self, url: str) -> None:
        name = hashlib.sha256(url.encode("utf-8", "surrogateescape")).hexdigest()[:16]
        self._url = url
        self._part_url = f"{url}{PART}"
        self._folder = default_directory() / "batches" / name
        self._lock = FileLock(f"{self._folder}.lock")
        self.path = self._folder / "results.jsonl"
        self._part = part_of(self.path)
        self._uploaded = time.monotonic()
        self._took = 0.0

    def __enter__(self) -> Self:
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            self._lock.acquire(timeout=0)
        except Timeout:
            reason = "another run on this machine is writing it"
            raise SatcheckError("results-in-use", reason, file=self._url) from None
        except OSError as error:
            reason = f"cannot be written: {error.strerror}"
            raise SatcheckError("cannot-write", reason, file=str(self._folder)) from None
        try:
            self._fetch()
        except BaseException:
            self._lock.release()
            raise
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        try:
            if kind is None:
                self._upload(self.path, self._url)
                urls.remove(self._part_url)
            elif self._part.exists():
                self._upload(self._part, self._part_url)
            else:
                urls.remove(self._part_url)
            shutil.rmtree(self._folder)
        finally:
            self._lock.release()

    def upload_part(self) -> None:
        """If the last time is long ago."""
        pause = max(_SECONDS_BETWEEN_UPLOADS, self._took / _SHARE_OF_TIME)
        if time.monotonic() - self._uploaded > pause:
            self._upload(self._part, self._part_url)

    def _upload(self, path: Path, url: str) -> None:
        began = time.monotonic()
        try:
            urls.upload(path, url)
        except SatcheckError as error:
            raise SatcheckError(
                "cannot-write", f"{error.message}. The results are in {path}", file=url
            ) from error
        self._uploaded = time.monotonic()
        self._took = self._uploaded - began

    def _fetch(self) -> None:
        """Of a part that is here and at the URL, the lines of both are kept: another machine may
        have gone on."""
        urls.download(self._url, self.path)
        there = self._folder / "there"
        if not urls.download(self._part_url, there):
            self._part.touch()
            self._upload(self._part, self._part_url)  # that fails now rather than at the end
        elif not _begins_with(self._part, there):
            _append(self._part, there)
            there.replace(self._part)


def _append(path: Path, to: Path) -> None:
    if path.exists():
        with path.open("rb") as more, to.open("ab") as lines:
            shutil.copyfileobj(more, lines)


def _begins_with(path: Path, beginning: Path) -> bool:
    if not path.exists():
        return False
    with path.open("rb") as file, beginning.open("rb") as wanted:
        while piece := wanted.read(_PIECE_BYTES):
            if file.read(len(piece)) != piece:
                return False
    return True
