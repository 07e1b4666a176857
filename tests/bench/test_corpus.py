"""Where pairs come from."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from bench.accuracy.case import Case, Stated, case_of
from bench.accuracy.corpus import given, read

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
HERE: list[list[float]] = [[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
THERE: list[list[float]] = [[1.0, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
PAIRS = {
    "pairs": [
        {
            "id": name,
            "a": {"mesh": "meshes/a.obj", "transform": HERE},
            "b": {"mesh": "meshes/b.obj", "transform": THERE},
            "truth": truth,
        }
        for name, truth in (
            ("in", {"verdict": "contained", "best_known_length": 2.5}),
            ("apart", {"verdict": "separated", "distance": 0.5}),
            ("flush", {"verdict": "touching"}),
        )
    ]
}


def test_a_pair_file_states_its_truth(tmp_path: Path) -> None:
    (tmp_path / "pairs.json").write_text(json.dumps(PAIRS), encoding="utf-8")
    found = read(tmp_path)
    assert found == read(tmp_path / "pairs.json")
    stated = [case.stated for case in found.cases]
    assert stated == [Stated(True, way_out=2.5), Stated(False, distance=0.5), Stated()]
    first = found.cases[0]
    assert first.meshes[1] == str(tmp_path / "meshes/b.obj")
    assert first.transforms == (HERE, THERE)
    (scene,) = first.inputs(tmp_path)
    bodies = json.loads(scene.read_text(encoding="utf-8"))["bodies"]
    assert [body["transform"] for body in bodies] == [HERE, THERE]


def test_the_samples_are_asked_once_each() -> None:
    cases = {case.id.split("/")[1]: case for case in read(SAMPLES).cases}
    assert "pushed" in cases
    assert "pushed_contacts" not in cases
    assert len({case.meshes for case in cases.values()}) == len(cases)
    assert cases["notch"].stated == Stated(overlap=False)
    assert cases["arm"].stated == Stated(overlap=True, depth=0.5)
    assert cases["flush"].stated.overlap is None
    assert cases["open"].stated == Stated(overlap=True, depth=1.5)
    assert all(path.is_file() for case in cases.values() for path in case.inputs(SAMPLES))


def test_of_any_other_folder_every_two_meshes(tmp_path: Path) -> None:
    for name in ("a.obj", "b.STL", "c.ply", "notes.txt"):
        (tmp_path / name).touch()
    names = [tuple(Path(mesh).name for mesh in case.meshes) for case in read(tmp_path).cases]
    assert names == [("a.obj", "b.STL"), ("a.obj", "c.ply"), ("b.STL", "c.ply")]


def test_a_folder_without_two_meshes_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no pair of meshes"):
        read(tmp_path)


def test_a_case_survives_the_way_to_its_process() -> None:
    named = given((SAMPLES / "box.obj", SAMPLES / "cube.off"))
    placed = Case("x/y", ("a", "b"), (HERE, THERE), Stated(True, 1.0, 2.0, 3.0))
    for case in (named, placed):
        assert case_of(json.loads(json.dumps(case.to_dict()))) == case
