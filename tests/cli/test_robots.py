"""Robots on the command line: poses, states, samples, their documents and exit codes."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from satcheck.cli.commands.schema import text
from tests.cli.process import SAMPLES, VALIDATOR, satcheck

ARM = ("arm.urdf", "arm.srdf")
JSON = ("--format", "json")
SCHEMA = json.loads(text("samples"))


def test_a_robot_at_rest() -> None:
    ran = satcheck(*ARM, *JSON)
    assert ran.code == 0, ran.err
    VALIDATOR.validate(ran.document)
    assert ran.document["pose"] == {"turn": 0, "shoulder": 0, "elbow": 0, "grip": 0}
    assert ran.document["units"] == "m"


def test_without_a_robot_there_is_no_pose() -> None:
    assert satcheck("box.obj", "cube.off", *JSON).document["pose"] is None


@pytest.mark.parametrize("given", [("--state", "folded"), ("--pose", '{"elbow": 3}')])
def test_one_pose_is_a_check_like_any_other(given: tuple[str, str]) -> None:
    ran = satcheck(*ARM, *given, "--depth", *JSON)
    assert ran.code == 1, ran.err
    VALIDATOR.validate(ran.document)
    assert ran.document["pose"]["elbow"] == 3
    deepest = max(ran.document["findings"], key=lambda finding: finding["depth"] or 0)
    assert {deepest["a"], deepest["b"]} in ({"base", "left"}, {"base", "right"})


def test_states_are_put_together_and_a_pose_goes_on_top() -> None:
    given = ("--state", "bowed", "--state", "open", "--pose", '{"shoulder": 0.25}')
    pose = satcheck(*ARM, *given, *JSON).document["pose"]
    assert pose == {"turn": 0, "shoulder": 0.25, "elbow": 1.25, "grip": 0.1875}


@pytest.mark.parametrize(
    ("given", "seed", "verdicts"),
    [
        (("--pose", "arm_poses.json"), None, ["pass", "fail", "fail"]),
        (("--pose", "arm_poses.json", "--pose", "{}"), None, ["pass", "fail", "fail", "pass"]),
        (("--pose", '[{"elbow": 3}]'), None, ["fail"]),
        (("--sample", "2"), 0, ["pass", "pass"]),
    ],
)
def test_several_poses_have_a_document_of_their_own(
    given: tuple[str, ...], seed: int | None, verdicts: list[str]
) -> None:
    ran = satcheck(*ARM, *given, *JSON, "--no-timings")
    assert ran.code == (1 if "fail" in verdicts else 0), ran.err
    Draft202012Validator(SCHEMA).validate(ran.document)
    assert [sample["verdict"] for sample in ran.document["samples"]] == verdicts
    assert ran.document["seed"] == seed
    assert ran.document["settings"]["depth"] is False
    assert satcheck(*ARM, *given, *JSON, "--no-timings").out == ran.out


def test_the_schema_is_whole() -> None:
    assert satcheck("schema", "samples").document == SCHEMA
    found = satcheck(*ARM, "--sample", "1", *JSON).document
    found["samples"][0]["findings"] = [{"a": "x"}]
    assert not Draft202012Validator(SCHEMA).is_valid(found)


def test_few_poses_have_a_row_each() -> None:
    ran = satcheck(*ARM, "--pose", "arm_poses.json", "--depth")
    assert ran.code == 1, ran.err
    rows = [line.split() for line in ran.out.splitlines() if " fail " in line]
    assert [row[:2] for row in rows] == [["2", "fail"], ["3", "fail"]]
    assert "base and upper penetrating 0.025" in ran.out
    counts = "3 poses, 7 bodies, 21 pairs, 9 allowed: 1 passes, 2 fail.\nFAIL: 4 of 21 pairs fail; "
    assert counts in ran.out


def test_of_many_poses_the_pairs_are_listed_with_the_number_of_a_pose() -> None:
    ran = satcheck(*ARM, "--sample", "100", "--seed", "4")
    assert ran.code == 1, ran.err
    row = next(line for line in ran.out.splitlines() if "base" in line and "upper" in line)
    number = int(row.rpartition("pose ")[2])
    samples = satcheck(*ARM, "--sample", "100", "--seed", "4", *JSON).document["samples"]
    (pose,) = (sample["pose"] for sample in samples if sample["number"] == number)
    again = satcheck(*ARM, "--pose", json.dumps(pose), *JSON)
    relations = {(f["a"], f["b"]): f["relation"] for f in again.document["findings"]}
    assert relations["base", "upper"] == "penetrating"
    assert "100 random poses (seed 4), 7 bodies, 21 pairs, 9 allowed:" in ran.out


def test_a_robot_of_one_link_passes_in_no_pose(tmp_path: Path) -> None:
    shape = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
    robot = tmp_path / "robot.urdf"
    robot.write_text(f'<robot name="r"><link name="base">{shape}{shape}</link></robot>')
    for given in ((), ("--pose", "{}"), ("--sample", "3")):
        ran = satcheck(str(robot), *given)
        assert ran.code == 3
        assert ran.out.endswith(" no pair was checked: 1 within one link.\n")
        found = satcheck(str(robot), *given, *JSON)
        assert found.code == 3
        assert [issue["code"] for issue in found.document["issues"]] == ["nothing-to-check"]
        assert found.document["summary"]["pairs"]["allowed"] == 1


def test_what_one_body_alone_has_lost_is_named(tmp_path: Path) -> None:
    shape = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
    parts = f'<link name="a">{shape}</link><group><link name="b">{shape}</link></group>'
    robot = tmp_path / "robot.urdf"
    robot.write_text(f'<robot name="r">{parts}</robot>')
    ran = satcheck(str(robot))
    assert ran.code == 2
    assert "<robot>: group is not read" in ran.err
    assert "one body alone cannot collide" in ran.err


def test_where_nothing_overlaps_there_is_no_example() -> None:
    given = ("--sample", "21", "--pose", '{"shoulder": 0, "elbow": 0, "grip": 0}')
    ran = satcheck(*ARM, *given)
    assert ran.code == 0, ran.err
    assert "21 (100 %)" in ran.out
    assert "the first overlap" not in ran.out
    assert ran.out.endswith("21 pairs, 9 allowed: 21 pass.\nPASS: no collision in any pose.\n")


def test_samples_hold_on_to_what_is_given() -> None:
    given = ("--sample", "3", "--state", "open", "--pose", '{"turn": 0.5}')
    samples = satcheck(*ARM, *given, *JSON).document["samples"]
    assert {(one["pose"]["turn"], one["pose"]["grip"]) for one in samples} == {(0.5, 0.1875)}
    assert len({one["pose"]["elbow"] for one in samples}) == 3


def test_beyond_limits_is_a_warning_beside_the_verdict() -> None:
    ran = satcheck(*ARM, "--pose", '[{"elbow": 3.5}, {}]')
    assert ran.code == 0, ran.err
    assert "pose 1: warning: joint 'elbow': 3.5 is beyond its limits -3 .. 3 by 0.5" in ran.out
    assert "warning: joint 'elbow': 3.5" in satcheck(*ARM, "--pose", '{"elbow": 3.5}').out


def test_a_robot_among_other_bodies(tmp_path: Path) -> None:
    scene = {
        "schema": "satcheck-scene-1",
        "units": "m",
        "bodies": [{"id": "wall", "mesh": str(SAMPLES / "box.obj")}],
    }
    (tmp_path / "wall.json").write_text(json.dumps(scene))
    ran = satcheck(*ARM, str(tmp_path / "wall.json"), *JSON, "--no-depth")
    assert ran.code == 1, ran.err
    hit = {
        f["a"] for f in ran.document["findings"] if f["b"] == "wall" and f["severity"] == "error"
    }
    assert "upper" in hit
    del scene["units"]  # then nobody knows how large it is beside a robot in metres
    (tmp_path / "wall.json").write_text(json.dumps(scene))
    ran = satcheck(*ARM, str(tmp_path / "wall.json"), *JSON, "--no-depth")
    assert ran.code == 3
    relations = {f["relation"] for f in ran.document["findings"] if f["b"] == "wall"}
    assert relations == {"indeterminate"}


def test_packages_by_option(tmp_path: Path) -> None:
    urdf = (SAMPLES / "arm.urdf").read_text().replace('filename="', 'filename="package://arm/m/')
    (tmp_path / "arm.urdf").write_text(urdf)
    ran = satcheck(str(tmp_path / "arm.urdf"), "arm.srdf")
    assert ran.code == 2
    (line,) = [line for line in ran.err.splitlines() if "error" in line]  # one cause, one message
    assert "4 bodies, the first in line 32 (package://arm/m/arm_beam.stl)" in line
    assert "package 'arm' is not found: --package arm=DIR says where it lies" in line
    ran = satcheck(str(tmp_path / "arm.urdf"), "arm.srdf", "--package", "arm/m=.")
    assert ran.code == 0, ran.err
    shutil.copytree(SAMPLES, tmp_path / "arm" / "m")
    ran = satcheck(str(tmp_path / "arm.urdf"), "arm.srdf")
    assert ran.code == 0, ran.err


def test_a_mesh_outside_needs_leave(tmp_path: Path) -> None:
    urdf = (SAMPLES / "arm.urdf").read_text().replace('filename="', f'filename="{SAMPLES}/')
    (tmp_path / "arm.urdf").write_text(urdf)
    ran = satcheck(str(tmp_path / "arm.urdf"), "arm.srdf")
    assert ran.code == 2
    assert "[outside-path]" in ran.err
    assert satcheck(str(tmp_path / "arm.urdf"), "arm.srdf", "--allow-outside").code == 0


def test_a_missing_mesh_is_one_body_of_many(tmp_path: Path) -> None:
    urdf = (SAMPLES / "arm.urdf").read_text().replace("arm_finger.obj", "gone.obj")
    (tmp_path / "arm.urdf").write_text(urdf)
    shutil.copy(SAMPLES / "arm_beam.stl", tmp_path)
    for given in ((), ("--sample", "2")):
        ran = satcheck(str(tmp_path / "arm.urdf"), "arm.srdf", *given, *JSON)
        assert ran.code == 2
        assert "2 bodies, the first in line 58 (gone.obj): no such file in " in ran.err
        assert len(ran.document["bodies"]) == 7
    table = satcheck(str(tmp_path / "arm.urdf"), "arm.srdf", "--sample", "1").out
    assert "7 pairs undecided" in table


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("box.obj", "cube.off", "--pose", "{}"), "no robot to pose"),
        ((*ARM, "--seed", "1"), "add --sample N"),
        ((*ARM, "--sample", "0"), "--sample"),
        ((*ARM, "--sample", "2", "--pose", "arm_poses.json"), "give one --pose at most"),
        ((*ARM, "--pose", '{"elbo": 1}'), "unknown joint 'elbo' (did you mean 'elbow'?)"),
        ((*ARM, "--pose", "gone.json"), "gone.json: no such file"),
        ((*ARM, "--pose", "box.obj"), "box.obj: line 1: not well-formed JSON"),
        ((*ARM, "--state", "flat"), "no state 'flat': the states are up, bowed, folded, open"),
        ((*ARM, "--sample", "2", "--certificate", *JSON), "--certificate takes one pose"),
        ((*ARM, "--sample", "2", "--explain"), "--explain takes one pose"),
        ((*ARM, "--package", "arm"), "should be NAME=DIR"),
        ((*ARM, "--package", "arm=gone"), "'gone' is no folder"),
        ((*ARM, "--pose", "arm_poses.json", "-o", "arm_poses.json"), "overwrite an input"),
        (("arm.srdf", "box.obj"), "about robot 'arm', which is not given"),
    ],
)
def test_misuse_exits_with_two(arguments: tuple[str, ...], said: str) -> None:
    ran = satcheck(*arguments)
    assert ran.code == 2
    assert said in ran.err.replace("\n", " ")
    assert ran.out == ""


def test_a_path_that_passes_says_through_how_many_poses(tmp_path: Path) -> None:
    path = tmp_path / "path.json"
    path.write_text('[{"shoulder": 0}, {"shoulder": 0.1}]')
    arm = (str(SAMPLES / "arm.urdf"), str(SAMPLES / "arm.srdf"))
    ran = satcheck(*arm, "--path", str(path))
    assert ran.out.endswith("PASS: no collision on the path through 2 poses.\n")
