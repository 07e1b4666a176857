"""Files at URLs."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from typing import Any

import fsspec
import pytest

from satcheck.audit.batch import urls
from satcheck.core.errors import SatcheckError


@pytest.fixture
def memory() -> Iterator[Any]:
    system = fsspec.filesystem("memory")
    yield system
    system.store.clear()


def test_names_with_a_scheme_are_urls() -> None:
    assert urls.is_url("s3://bucket/a.toml")
    assert urls.is_url("file:///a.toml")
    assert not any(map(urls.is_url, ("a.toml", "/a//b", "C:\\a", "a:b", "://a")))


def test_a_file_is_copied(memory: Any, tmp_path: Path) -> None:
    memory.pipe_file("/bucket/a.obj", b"v 0 0 0\n")
    place = tmp_path / "new" / "a.obj"
    assert urls.download("memory://bucket/a.obj", place)
    assert place.read_bytes() == b"v 0 0 0\n"
    assert [each.name for each in place.parent.iterdir()] == ["a.obj"]
    assert urls.digest("memory://bucket/a.obj") == sha256(b"v 0 0 0\n").hexdigest()


def test_a_file_that_is_not_there(memory: Any, tmp_path: Path) -> None:
    assert not urls.download("memory://bucket/b.obj", tmp_path / "b.obj")
    assert list(tmp_path.iterdir()) == []
    assert urls.digest("memory://bucket/b.obj") is None
    urls.remove("memory://bucket/b.obj")
    assert not memory.store


def test_a_pattern_stands_for_urls(memory: Any) -> None:
    for name in ("b/1.toml", "a/2.toml", "a/3.obj"):
        memory.pipe_file(f"/bucket/{name}", b"")
    found = urls.matches("memory://bucket/**/*.toml")
    assert found == ["memory://bucket/a/2.toml", "memory://bucket/b/1.toml"]


def test_an_upload_replaces_what_is_there(memory: Any, tmp_path: Path) -> None:
    memory.pipe_file("/bucket/a", b"old and longer")
    (tmp_path / "a").write_bytes(b"new\nlines\n")
    urls.upload(tmp_path / "a", "memory://bucket/a")
    assert list(urls.lines("memory://bucket/a")) == [b"new\n", b"lines\n"]
    urls.remove("memory://bucket/a")
    assert not memory.exists("/bucket/a")


def test_an_unknown_scheme_is_told(tmp_path: Path) -> None:
    with pytest.raises(SatcheckError) as caught:
        urls.download("nowhere://a/b", tmp_path / "b")
    assert caught.value.code == "unreachable-url"
    assert str(caught.value).startswith("nowhere://a/b: ")


def test_without_fsspec_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fsspec.core", None)
    with pytest.raises(SatcheckError) as caught:
        urls.digest("memory://bucket/a")
    assert caught.value.code == "missing-extra"
    assert "pip install 'satcheck[remote]'" in str(caught.value)
