"""The command as a whole process: what it answers, and the exit code."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.cli.process import (
    APART,
    PUSHED,
    SAMPLES,
    VALIDATOR,
    satcheck,
)


def test_overlap_is_exit_1_and_a_table() -> None:
    ran = satcheck(*PUSHED)
    assert ran.code == 1
    assert "penetrating" in ran.out
    assert "(-1, 0, 0)" in ran.out
    assert ran.out.splitlines()[-2:] == [
        "FAIL: box and box_pushed overlap (thickness 1, 1 to pull apart).",
        "Next: -o report.html shows it in 3-D.",
    ]
    assert ran.err == ""


def test_no_overlap_is_exit_0() -> None:
    ran = satcheck(*APART)
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.endswith("\nPASS: no collision.\n")


def test_exit_zero_forgives_findings_but_not_failures() -> None:
    assert satcheck("--exit-zero", *PUSHED).code == 0
    assert satcheck("--exit-zero", "box.obj", "gone.obj").code == 2


def test_every_pair_of_many_is_checked() -> None:
    ran = satcheck("--format", "json", "box.obj", "box_pushed.stl", "cube.off", "far_a.obj")
    assert ran.code == 1
    assert ran.document["summary"]["pairs"]["total"] == 6


def test_json_is_one_document_that_follows_the_schema() -> None:
    ran = satcheck("--format", "json", *PUSHED)
    VALIDATOR.validate(ran.document)
    assert ran.document["findings"][0]["depth"] == 1.0
    assert ran.err == ""


def test_without_timings_the_bytes_repeat() -> None:
    once = satcheck("--format", "json", "--no-timings", "--jobs", "1", *PUSHED, "cube.off")
    again = satcheck("--format", "json", "--no-timings", "--jobs", "4", *PUSHED, "cube.off")
    assert once.out == again.out
    assert "microseconds" not in once.out


def test_depth_that_was_not_asked_for_is_null() -> None:
    (finding,) = satcheck("--format", "json", "--no-depth", *PUSHED).document["findings"]
    assert finding["relation"] == "penetrating"
    assert finding["depth"] is None
    assert finding["mtv"] is None


def test_contacts_are_there_when_asked_for() -> None:
    without, asked = (
        satcheck("--format", "json", *more, *PUSHED) for more in ((), ("--contacts",))
    )
    assert without.document["findings"][0]["contacts"] is None
    VALIDATOR.validate(asked.document)
    (loop,) = asked.document["findings"][0]["contacts"]["curves"]
    assert loop["closed"]
    assert loop["length"] == 8.5


def test_a_volume_is_there_when_asked_for() -> None:
    without, asked = (satcheck("--format", "json", *more, *PUSHED) for more in ((), ("--volume",)))
    assert without.document["findings"][0]["volume"] is None
    VALIDATOR.validate(asked.document)
    finding = asked.document["findings"][0]
    assert abs(finding["volume"] - 2.625) <= finding["volume_error"] < 1e-8


def test_clearance_finds_the_near() -> None:
    ran = satcheck("--clearance", "0.75", *APART)
    assert ran.code == 1
    assert "near" in ran.out
    assert "0.5" in ran.out
    assert satcheck("--clearance", "0.25", *APART).code == 0


def test_tolerance_widens_the_touch_band() -> None:
    (finding,) = satcheck("--format", "json", "--tolerance", "2", *PUSHED).document["findings"]
    assert finding["relation"] == "touching"
    assert finding["exact_relation"] == "penetrating"


def test_a_body_within_an_open_mesh_is_no_pass() -> None:
    ran = satcheck("open_box.off", "cube.off")
    assert ran.code == 1
    assert "contains" in ran.out
    allowed = satcheck("--allow-open", "open_box.off", "cube.off")
    assert allowed.code == 0
    assert allowed.out.splitlines()[-1] == "PASS: no collision."


def test_a_body_in_a_hole_is_no_pass(tmp_path: Path) -> None:
    part, shell = tmp_path / "part.obj", str(SAMPLES / "open_box.off")
    points = [(x, y, z) for z in (3, 5) for y in (0, 1) for x in (2, 3)]
    quads = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
    lines = [f"v {x} {y} {z}" for x, y, z in points] + [f"f {' '.join(map(str, q))}" for q in quads]
    part.write_text("\n".join(lines) + "\n")
    ran = satcheck(shell, str(part))
    assert ran.code == 3
    assert "the hole of open_box" in ran.out
    assert satcheck("--allow-open", shell, str(part)).code == 0


@pytest.mark.parametrize(
    ("key", "value", "code", "line"),
    [
        ("allowed_pairs", [["base", "bolt", "bolted"]], 0, "PASS: no pair was checked: 1 allowed"),
        ("ignore_within_groups", ["all"], 3, "INCOMPLETE: no pair was checked: 1 within ignored"),
    ],
)
def test_nothing_checked_passes_only_where_rules_allow_all(
    tmp_path: Path, key: str, value: list[Any], code: int, line: str
) -> None:
    mesh = str(SAMPLES / "box.obj")
    bodies = [{"id": id, "mesh": mesh, "group": "all"} for id in ("base", "bolt")]
    scene = {"schema": "satcheck-scene-1", "name": "x", "bodies": bodies, key: value}
    (tmp_path / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
    ran = satcheck(str(tmp_path / "scene.json"))
    assert ran.code == code
    assert line in ran.out
    assert "o collision" not in ran.out


def test_explain_tells_the_plan() -> None:
    ran = satcheck("--explain", *PUSHED)
    assert "box against box_pushed: penetrating" in ran.out


@pytest.mark.parametrize(("option", "code"), [("0.4mm", 0), ("0.6mm", 1), ("0.03in", 1)])
def test_units_of_a_scene(option: str, code: int) -> None:
    """Between base and arm there is a gap of 0.5 mm; base and bolt are allowed to meet."""
    ran = satcheck("--format", "json", "--clearance", option, "workcell.json")
    assert ran.code == code
    assert ran.document["units"] == "mm"
    assert ran.document["summary"]["pairs"]["allowed"] == 1
