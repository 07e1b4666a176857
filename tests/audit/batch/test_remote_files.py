"""Files at URLs."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from typing import Any

import fsspec
import pytest

from satcheck.audit.batch import remote
from satcheck.core.errors import SatcheckError


@pytest.fixture
def memory() -> Iterator[Any]:
    system = fsspec.filesystem("memory")
    yield system
    system.store.clear()


def test_names_with_a_scheme_are_urls() -> None:
    assert remote.is_url("s3://bucket/a.toml")
    assert remote.is_url("file:///a.toml")
    assert not any(map(remote.is_url, ("a.toml", "/a//b", "C:\\a", "a:b", "://a")))


def test_a_file_is_copied(memory: Any, tmp_path: Path) -> None:
    memory.pipe_file("/bucket/a.obj", b"v 0 0 0\n")
    place = tmp_path / "new" / "a.obj"
    assert remote.download("memory://bucket/a.obj", place)
    assert place.read_bytes() == b"v 0 0 0\n"
    assert [each.name for each in place.parent.iterdir()] == ["a.obj"]
    assert remote.digest("memory://bucket/a.obj") == sha256(b"v 0 0 0\n").hexdigest()


@pytest.mark.usefixtures("memory")
def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    assert not remote.download("memory://bucket/b.obj", tmp_path / "b.obj")
    assert list(tmp_path.iterdir()) == []
    assert remote.digest("memory://bucket/b.obj") is None


def test_an_unknown_scheme_is_told(tmp_path: Path) -> None:
    with pytest.raises(SatcheckError) as caught:
        remote.download("nowhere://a/b", tmp_path / "b")
    assert caught.value.code == "unreachable-url"
    assert str(caught.value).startswith("nowhere://a/b: ")


def test_without_fsspec_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fsspec.core", None)
    with pytest.raises(SatcheckError) as caught:
        remote.digest("memory://bucket/a")
    assert caught.value.code == "missing-extra"
    assert "pip install 'satcheck[remote]'" in str(caught.value)


def test_without_the_package_of_a_scheme_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def lacking(url: str) -> None:
        raise ImportError(f"Install bucketfs to access {url}")

    monkeypatch.setattr("fsspec.core.url_to_fs", lacking)
    with pytest.raises(SatcheckError) as caught:
        remote.digest("bucket://a")
    assert caught.value.code == "missing-extra"
    assert "Install bucketfs" in str(caught.value)
