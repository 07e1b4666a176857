"""A body of a report that is a node within a file: read again, and held against what is said."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from shutil import copy
from typing import Any

import pytest

from satcheck.audit import Settings, check
from satcheck.scene import load_scene
from satcheck.verify import Rejected, VerificationReport, verify
from tests.cli.process import SAMPLES
from tests.scene import files

Json = dict[str, Any]


def certified(path: Path, split: Any = None) -> Json:
    settings = Settings(certificate=True, cache=False)
    report = check(load_scene([path], split=split), settings).to_dict()
    return dict(json.loads(json.dumps(report)))


def verified(document: Json) -> VerificationReport:
    return verify(document, Path("/"))


@pytest.mark.parametrize("name", ["gripper.glb", "rack.3mf"])
def test_a_report_about_nodes_is_accepted(name: str) -> None:
    found = verified(certified(SAMPLES / name))
    assert found.accepted
    assert {one.outcome for one in found.findings} == {"accepted"}


def test_a_report_about_components_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "two.obj"
    path.write_bytes(files.obj(files.TWO_CUBES_POINTS, files.TWO_CUBES))
    document = certified(path, "components")
    assert [body["path"] for body in document["bodies"]] == ["#1", "#2"]
    assert verified(document).accepted
    document["bodies"][1]["path"] = "#1"
    assert not verified(document).accepted


FORGED: dict[str, Callable[[list[Json]], Any]] = {
    "another node": lambda bodies: bodies[3].update(path="gripper/palm"),
    "no node": lambda bodies: bodies[3].update(path="gripper"),
    "all of the file": lambda bodies: bodies[3].update(path=None),
    "pose": lambda bodies: bodies[3].update(transform=[1, 0, 0, 9, *bodies[0]["transform"][4:]]),
}


@pytest.mark.parametrize("forgery", FORGED)
def test_a_node_that_is_another_is_rejected(forgery: str) -> None:
    document = certified(SAMPLES / "gripper.glb")
    FORGED[forgery](document["bodies"])
    assert not verified(document).accepted


def test_a_path_that_is_no_text_is_no_report() -> None:
    document = certified(SAMPLES / "gripper.glb")
    document["bodies"][3]["path"] = 3
    with pytest.raises(Rejected, match="path"):
        verified(document)


def test_a_file_that_changed_is_rejected_for_each_of_its_nodes(tmp_path: Path) -> None:
    path = Path(copy(SAMPLES / "gripper.glb", tmp_path))
    document = certified(path)
    path.write_bytes(path.read_bytes().replace(b"satcheck", b"SATCHECK"))
    found = verified(document)
    assert not found.accepted
    assert sum("SHA-256" in fault for fault in found.faults) == 4


def test_each_mesh_is_read_and_prepared_once(monkeypatch: pytest.MonkeyPatch) -> None:
    from satcheck.verify import bodies

    prepared = []
    shape_of = bodies.shape_of
    document = certified(SAMPLES / "gripper.glb")
    monkeypatch.setattr(
        bodies, "shape_of", lambda file, **how: prepared.append(file) or shape_of(file, **how)
    )
    assert verified(document).accepted
    assert sorted(str(file.part) for file in prepared) == ["finger", "palm", "payload"]
