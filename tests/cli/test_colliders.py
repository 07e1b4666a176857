"""`satcheck colliders` as a whole process: its documents, its exit codes, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from satcheck.cli.commands.schema import text
from tests.cli.process import satcheck

LINK = """<link name="{name}">
  <visual><geometry><{visual}/></geometry></visual>
  <collision><geometry><{collider}/></geometry></collision>
</link>"""
CYLINDER, BOX = 'cylinder radius="1" length="2"', 'box size="2 2 2"'


@pytest.fixture
def robot(tmp_path: Path) -> str:
    """A cylinder in a box, which sticks out of it by sqrt(2) - 1; and a mesh that is not there."""
    path = tmp_path / "robot.urdf"
    path.write_text(
        f'<robot name="r">{LINK.format(name="can", visual=CYLINDER, collider=BOX)}</robot>'
    )
    return str(path)


def test_json_holds_what_its_schema_says(robot: str) -> None:
    ran = satcheck("colliders", robot, "--format", "json")
    assert ran.code == 0, ran.err
    schema = json.loads(text("colliders"))
    Draft202012Validator(schema).validate(ran.document)
    (part,) = ran.document["parts"]
    low, high = part["out"]["bounds"]
    assert low <= 2**0.5 - 1 <= high
    assert part["out"]["farthest"]["body"] == "can"


@pytest.mark.parametrize(
    ("options", "code"),
    [((), 0), (("--max-out", "42cm"), 0), (("--max-out", "0.41"), 1), (("--max-short", "0"), 3)],
)
def test_limits_decide_the_exit_code(robot: str, options: tuple[str, ...], code: int) -> None:
    ran = satcheck("colliders", robot, *options)
    assert ran.code == code, ran.out
    assert ran.out.splitlines()[-1].startswith(("PASS", "FAIL", "", "INCOMPLETE")[code])


def test_every_format_says_where(robot: str, tmp_path: Path) -> None:
    names = ("sarif", "xml", "md", "html", "png", "glb", "txt")
    files = [tmp_path / f"colliders.{name}" for name in names]
    outputs = [word for file in files for word in ("-o", str(file))]
    assert satcheck("colliders", robot, "--max-out", "1cm", *outputs).code == 1
    sarif = json.loads(files[0].read_text())
    (result,) = sarif["runs"][0]["results"]
    assert (result["ruleId"], result["level"]) == ("collider-out", "error")
    assert "can: sticks out by 0.414" in result["message"]["text"]
    assert all(file.stat().st_size > 0 for file in files)
    for form in ("csv", "bcf"):
        assert satcheck("colliders", robot, "--format", form).code == 2


def test_an_unreadable_mesh_is_an_error_and_the_rest_is_answered(robot: str) -> None:
    lost = LINK.format(name="lost", visual='mesh filename="gone.obj"', collider=BOX)
    joint = '<joint name="j" type="fixed"><parent link="can"/><child link="lost"/></joint>'
    path = Path(robot)
    path.write_text(path.read_text().replace("</robot>", f"{lost}{joint}</robot>"))
    ran = satcheck("colliders", robot, "--format", "json")
    assert ran.code == 2
    reasons = {part["name"]: part["reason"] for part in ran.document["parts"]}
    assert reasons["can"] is None
    assert "cannot be used" in reasons["lost"]
    assert "gone.obj" in ran.err
    sarif = path.parent / "lost.sarif"
    ran = satcheck("colliders", robot, "-o", str(sarif))
    assert (ran.code, "lost: " in sarif.read_text()) == (2, True)
    assert ran.err.splitlines()[-1].startswith("FAIL: 1 of 2 links")


def test_both_causes_are_told(robot: str) -> None:
    path = Path(robot)
    path.write_text(path.read_text().replace(BOX, 'box size="1 1 9"'))
    ran = satcheck("colliders", robot, "--max-out", "1", "--max-short", "0.1")
    assert ran.code == 1
    assert "sticks out and falls short by more than the limit" in " ".join(ran.out.split())


def test_a_file_that_is_not_there_is_named() -> None:
    ran = satcheck("colliders", "gone.urd", "--max-out", "5cm")
    assert (ran.code, "gone.urd: no such file" in ran.err) == (2, True)


def test_a_file_without_both_geometries_is_refused() -> None:
    ran = satcheck("colliders", "box.obj")
    assert ran.code == 2
    assert "give a robot, a USD or a glTF file" in ran.err
    assert "--geometry" not in ran.err
    assert "give a robot, a USD or a glTF file" in satcheck("colliders").err


def test_where_nothing_is_compared_nothing_passes(tmp_path: Path) -> None:
    bare = tmp_path / "bare.urdf"
    bare.write_text('<robot name="r"><link name="can"><collision><geometry><box size="1 1 1"/>')
    bare.write_text(f"{bare.read_text()}</geometry></collision></link></robot>")
    ran = satcheck("colliders", str(bare), "--format", "json")
    assert (ran.code, ran.document["verdict"]) == (3, "incomplete")
    assert ran.document["parts"][0]["verdict"] is None
    junit = tmp_path / "junit.xml"
    assert satcheck("colliders", str(bare), "-o", str(junit)).code == 3
    assert "nothing was compared" in junit.read_text()


def test_a_config_file_states_the_limits(robot: str, tmp_path: Path) -> None:
    config = tmp_path / "limits.toml"
    config.write_text('max-out = "10mm"\nmax-depth = "1mm"\n')  # the other one is about a check
    ran = satcheck("colliders", robot, "--config", str(config), "--format", "json")
    assert ran.code == 1
    assert ran.document["settings"]["max_out"] == 0.01
    assert ran.document["config"]["options"] == {"max-out": "10mm"}


def test_colliders_of_one_link_need_no_pair_to_check(robot: str) -> None:
    path, second = Path(robot), f"<collision><geometry><{BOX}/></geometry></collision></link>"
    path.write_text(path.read_text().replace("</link>", second))
    ran = satcheck("colliders", robot, "--max-out", "42cm")
    assert ran.code == 0, ran.out
    assert ran.out.splitlines()[-1] == (
        "PASS: all links keep --max-out 0.42 m, and no colliders overlap."
    )


def test_the_opening_is_told_where_the_collider_sticks_out(tmp_path: Path) -> None:
    sarif = tmp_path / "props.sarif"
    assert satcheck("colliders", "props.urdf", "-o", str(sarif)).code == 0
    texts = [
        each["message"]["text"] for each in json.loads(sarif.read_text())["runs"][0]["results"]
    ]
    assert any("closes an opening at least 0.234 m wide" in each for each in texts)
