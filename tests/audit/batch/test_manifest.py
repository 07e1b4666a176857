"""Which scenes a manifest names."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.audit.batch.manifest import read_manifest
from satcheck.core.errors import SatcheckError


def read(folder: Path, content: bytes) -> list[tuple[str, ...]]:
    path = folder / "manifest"
    path.write_bytes(content)
    return list(read_manifest(str(path)))


def test_a_name_is_all_that_stands_in_a_line(tmp_path: Path) -> None:
    assert read(tmp_path, b"a.obj \r\n b.obj\n\n  \nc\xc2\xa0") == [
        ("a.obj ",),
        (" b.obj",),
        ("c\xa0",),
    ]


def test_a_mark_of_utf_8_is_no_part_of_a_name(tmp_path: Path) -> None:
    assert read(tmp_path, b"\xef\xbb\xbfa.obj\n") == [("a.obj",)]


def test_names_that_are_no_text_may_be_in_a_list(tmp_path: Path) -> None:
    assert read(tmp_path, b'["\xff.obj", "b.obj"]\n') == [("\udcff.obj", "b.obj")]


@pytest.mark.parametrize("line", [b"[x].obj", b"[]", b"[1]", b'["a"', b"[" * 100_000])
def test_what_begins_like_a_list_has_to_be_one(tmp_path: Path, line: bytes) -> None:
    with pytest.raises(SatcheckError) as caught:
        read(tmp_path, b"a.obj\n" + line)
    assert caught.value.code == "bad-manifest"
    assert ":2" in str(caught.value)
