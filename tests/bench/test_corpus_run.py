"""The run over a folder of files: what it writes down, what it asks about, what it counts."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import Any

from bench.corpus import ask, chosen, files_of, measure, partners, questions, read_run
from bench.opinions.tables import proven, table

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
EYE = [[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
SATCHECK = [sys.executable, "-m", "satcheck.cli"]
LIAR = """
import json, sys
pair = {"relation": "separated", "quality": "exact", "tolerance": 0.0}
empty = {"bodies": [], "issues": [], "findings": [pair], "summary": {"verdict": "pass"}}
print(json.dumps(empty))
"""


def pair(**changed: Any) -> dict[str, Any]:
    made = {
        "what": "pair",
        "file": "a.stl",
        "kind": "overlap",
        "files": ["a.stl", "a.stl"],
        "matrices": [EYE, EYE],
        "exit": 0,
        "traceback": False,
        "relation": "separated",
        "quality": "exact",
        "undecided": None,
        "tolerance": 1e-6,
    }
    return made | changed


def test_files_are_found_by_their_ending_and_size(tmp_path: Path) -> None:
    for name in ("b.STL", "a.obj", "robot.urdf", "notes.txt"):
        (tmp_path / name).touch()
    found = files_of(tmp_path)
    assert [path.name for path in found] == ["a.obj", "b.STL", "robot.urdf"]
    (tmp_path / "list").write_text(f"{tmp_path}/b.STL\n{tmp_path}/gone.obj\n", encoding="utf-8")
    assert files_of(tmp_path / "list") == [tmp_path / "b.STL"]
    assert {couple["other"] for couple in partners(found, 0)} == {str(p) for p in found[:2]}


def test_a_traceback_is_an_answer() -> None:
    broken = ask([sys.executable, "-c", "raise ValueError"], [])
    assert (broken["exit"], broken["traceback"]) == (1, True)
    fine = ask(SATCHECK, [str(SAMPLES / "box.obj"), str(SAMPLES / "box_pushed.stl")])
    assert (fine["exit"], fine["traceback"]) == (1, False)
    assert fine["report"]["findings"][0]["relation"] == "penetrating"


def test_passes_and_overlaps_are_judged_and_nothing_else() -> None:
    records = [
        pair(),
        pair(relation="penetrating", exit=1),
        pair(relation="indeterminate", exit=3),
        {key: value for key, value in pair(exit=2).items() if key != "relation"},
        {"what": "file", "file": "a.stl"},
    ]
    assert [question["claim"] for question in questions(records)] == ["pass", "alarm"]


def test_a_run_is_continued_and_not_repeated(tmp_path: Path) -> None:
    folder = tmp_path / "files"
    folder.mkdir()
    shutil.copy(SAMPLES / "box.obj", folder)
    (folder / "broken.stl").write_bytes(b"solid")
    run = tmp_path / "run.jsonl"
    measure(files_of(folder), SATCHECK, 0, run)
    records = read_run(run)
    kinds = {record["kind"] for record in records if record["what"] == "pair"}
    assert kinds >= {"far", "beside", "graze", "overlap", "within"}
    standings = {record["standing"] for record in records if record["what"] == "opinion"}
    assert standings == {"agrees"}
    assert [record["exit"] for record in records if record["what"] == "file"] == [2, 2]
    measure(files_of(folder), SATCHECK, 0, run)
    assert read_run(run) == records


def test_a_false_pass_is_found_out(tmp_path: Path) -> None:
    run = tmp_path / "run.jsonl"
    measure([SAMPLES / "box.obj"], [sys.executable, "-c", LIAR], 0, run)
    false = {r["kind"] for r in read_run(run) if r.get("standing") == "false"}
    assert false == {"graze", "overlap", "within", "other"} - _apart(run)
    assert "false pass (separated): overlap" in table(read_run(run))


def _apart(run: Path) -> set[str]:
    """Kinds that the random directions left apart, by satcheck itself."""
    honest = run.with_name("honest.jsonl")
    measure([SAMPLES / "box.obj"], SATCHECK, 0, honest)
    pairs = [r for r in read_run(honest) if r["what"] == "pair"]
    return {r["kind"] for r in pairs if r["relation"] in ("separated", "touching")}


def test_only_what_is_decided_by_proof_counts_as_proven() -> None:
    assert proven(pair())
    assert proven(pair(quality="bounded"))
    assert not proven(pair(quality="estimate"))
    assert not proven(pair(relation="indeterminate", quality=None))
    assert not proven(pair(undecided="inside"))
    assert not proven({"what": "pair", "exit": 2})


def test_the_table_counts_what_was_gained() -> None:
    before = [pair(quality="estimate"), pair(kind="within")]
    now = [pair(), pair(kind="within", relation="indeterminate", quality=None, exit=3)]
    text = table(now, before)
    assert "Proven now and not before: 1; before and not now: 1" in text
    assert "| separated, not proven, exit 0 | separated, exit 0 | 1 |" in text
    assert "Pairs: 2, 1 of them proven" in text


def test_a_limit_picks_the_same_pairs_in_every_run() -> None:
    looks: list[dict[str, Any]] = [
        {"what": "look", "file": f"{k}.stl", "pairs": {"far": EYE, "within": EYE}} for k in range(5)
    ]
    few, many = chosen(looks, 0, 3), chosen([*looks[::-1], {"what": "file"}], 0, None)
    assert [(look["file"], kind) for look, kind in few] == [
        (look["file"], kind) for look, kind in many[:3]
    ]
    assert len(many) == 10
