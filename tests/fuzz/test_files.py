"""A few damaged files of each kind; `python -m tests.fuzz.files` tries any number."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import pytest

from satcheck.cli.stated_scene import read_stored, stated_scene
from satcheck.report.report import Report
from tests.fuzz.files import fault_of, file_of, workplace
from tests.fuzz.readers import READERS, attempt, name_of, seeds
from tests.fuzz.written import GOLDEN
from tests.scene import files

COUNT = 25


@pytest.mark.parametrize("kind", READERS)
def test_damage_is_an_error_with_a_code(kind: str, tmp_path: Path) -> None:
    path = workplace(tmp_path) / name_of(kind)
    for number in range(COUNT):
        path.write_bytes(file_of(kind, 0, number))
        code, fault = fault_of(kind, path)
        assert not fault, (kind, number, fault)
        assert code == "" or code.replace("-", "").isalnum()


@pytest.mark.parametrize("kind", READERS)
def test_some_file_of_the_kind_is_good(kind: str, tmp_path: Path) -> None:
    """Damage to files that are refused anyway would try nothing."""
    path = workplace(tmp_path) / name_of(kind)
    codes = set()
    for seed in seeds(kind):
        path.write_bytes(seed)
        codes.add(attempt(kind, path))
    assert "" in codes, codes


def golden(change: Callable[[dict[str, Any]], object]) -> bytes:
    report = json.loads((GOLDEN / "pushed.json").read_text("utf-8"))
    change(report)
    return json.dumps(report).encode()


def gltf(**members: Any) -> bytes:
    document, buffer = files.gltf_document()
    return files.glb({**document, **members}, buffer)


# What once raised what no reader should raise.
FAULTS = [
    ("glb", gltf(extensionsRequired=[[]])),
    ("glb", gltf(extensionsUsed=[{}])),
    ("glb", gltf(bufferViews=[{"extensions": {"EXT_meshopt_compression": {"mode": []}}}])),
    ("gltf", gltf(buffers=[{"uri": "A" * 5000, "byteLength": 3}])[20:-500]),
    ("baseline", b"\xff"),
    ("baseline", b"[" * 100_000),
    ("view", b"\xff"),
    ("view", b"[" * 100_000),
    ("json", b'{"schema": "satcheck.scene/1", "bodies": [{"id": -Infinity, "mesh": NaN}]}'),
    ("verify", golden(lambda report: report["settings"].update(accuracy="\ud800"))),
    ("verify", b'{"a": 1, ' + b", ".join(b'"%d": 0' % k for k in range(100_000)) + b', "7": 1}'),
]


@pytest.mark.parametrize(("kind", "content"), FAULTS, ids=range(len(FAULTS)))
def test_what_was_a_fault_is_an_error(kind: str, content: bytes, tmp_path: Path) -> None:
    path = workplace(tmp_path) / name_of(kind)
    path.write_bytes(content)
    assert attempt(kind, path)


def test_a_report_that_places_a_body_nowhere(tmp_path: Path) -> None:
    path = workplace(tmp_path) / name_of("view")
    path.write_bytes(golden(lambda report: report["bodies"][0].update(transform=[1.0] * 16)))
    scene, issues = stated_scene(cast("Report", read_stored(path)), path.parent)
    assert [issue.code for issue in issues] == ["not-drawn"]
    assert len(scene.bodies) == 1
