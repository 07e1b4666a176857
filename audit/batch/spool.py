"""Results at a URL: a local file stands for them while a batch runs, as objects take no lines."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp

from satcheck.audit.batch.results import PART, part_of
from satcheck.audit.batch.urls import at, download
from satcheck.core.errors import SatcheckError


@contextmanager
def spooled(url: str) -> Iterator[Path]:
    """The local file that stands for the one at the URL, and its `.part` for that at the URL with
    `.part` (`results.ResultsFile`). Both are fetched at the beginning and stored when the run ends,
    however it ends. If that fails, they stay.

    Raises SatcheckError: `cannot-write`, and those of `batch.urls`.
    """
    path = Path(mkdtemp(prefix="satcheck-results-")) / "results.jsonl"
    part, part_url = part_of(path), f"{url}{PART}"
    download(url, path)
    if not download(part_url, part):
        part.touch()
        _store(part, part_url)  # that fails now rather than at the end
    finished = False
    try:
        yield path
        finished = True
    finally:
        if finished:
            _store(path, url)
        _store(part, part_url)
        shutil.rmtree(path.parent)


def _store(path: Path, url: str) -> None:
    """Brings the file to the URL, or its absence."""
    try:
        with at(url) as (system, name):
            if path.exists():
                system.put_file(str(path), name)
            elif system.exists(name):
                system.rm_file(name)
    except SatcheckError as error:
        reason = f"{error.message}. The results are in {path}"
        raise SatcheckError("cannot-write", reason, file=url) from error
