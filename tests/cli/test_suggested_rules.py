"""What `satcheck suggest` writes, given beside the same input: that passes, no worse one."""

from __future__ import annotations

import json
import shutil
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sample_meshes import hierarchies, make
from tests.cli.process import SAMPLES, Ran, satcheck
from tests.scene import files
from tests.scene.robot.robots import joint, link, robot_of

JSON = ("--format", "json")
HOSTILE = ("plain", "two words", "[1]", "[!a]*", "what?", "a/b", 'say "hi"', "Ø 螺", "group:x", "]")
# Steps of 0.75 along x between unit cubes: each overlaps the next alone.
STEP = 0.75


def cube_at(x: float) -> list[tuple[float, float, float]]:
    return [(x + a, b, c) for a, b, c in files.CUBE_POINTS]


def meshes(folder: Path) -> tuple[str, ...]:
    """A file name cannot hold a slash."""
    names = [f"{name.replace('/', '_')}.obj" for name in HOSTILE]
    for k, name in enumerate(names):
        (folder / name).write_bytes(files.obj(cube_at(STEP * k)))
    return tuple(names)


def glb(folder: Path) -> tuple[str, ...]:
    box = make.box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    nodes: list[dict[str, Any]] = [
        {"name": name, "mesh": 0, "translation": [STEP * k, 0, 0]} for k, name in enumerate(HOSTILE)
    ]
    content = hierarchies.glb({"box": box}, nodes, list(range(len(HOSTILE))))
    (folder / "level.glb").write_bytes(content)
    return ("level.glb",)


def threemf(folder: Path) -> tuple[str, ...]:
    shutil.copy(SAMPLES / "rack.3mf", folder)
    return ("rack.3mf",)


def components(folder: Path) -> tuple[str, ...]:
    points = [*cube_at(0), *((x, y + 0.5, z + 0.25) for x, y, z in cube_at(STEP)), *cube_at(9)]
    faces = [tuple(i + 8 * k for i in face) for k in range(3) for face in files.CUBE]
    (folder / "parts.stl").write_bytes(files.binary_stl(points, faces))
    return ("parts.stl", "--split", "components")


def split_glb(folder: Path) -> tuple[str, ...]:
    return (*glb(folder), "--split", "components")


def nodes_of_two(folder: Path) -> tuple[str, ...]:
    shutil.copy(SAMPLES / "gripper.glb", folder)
    return (*glb(folder), "gripper.glb", "--split", "nodes")


def concave(folder: Path) -> tuple[str, ...]:
    """Their depth is a wide interval."""
    names = ("kettle.obj", "snowflake.obj")
    for name in names:
        shutil.copy(SAMPLES / name, folder)
    return names


def toml_scene(folder: Path) -> tuple[str, ...]:
    bodies = "".join(
        f"[[bodies]]\nid = {json.dumps(name, ensure_ascii=False)}\nposition = [{STEP * k}, 0, 0]\n"
        'shape = {type = "box", size = [1, 1, 1]}\n'
        for k, name in enumerate(HOSTILE)
    )
    text = f'schema = "satcheck.scene/1"\nunits = "mm"\n{bodies}'
    (folder / "cell.toml").write_text(text, encoding="utf-8")
    return ("cell.toml",)


def json_scene(folder: Path) -> tuple[str, ...]:
    shape = {"type": "box", "size": [1, 1, 1]}
    bodies = [
        {"id": name, "shape": shape, "position": [STEP * k, 0, 0]} for k, name in enumerate(HOSTILE)
    ]
    scene = {"schema": "satcheck.scene/1", "bodies": bodies}
    (folder / "cell.json").write_text(json.dumps(scene), encoding="utf-8")
    return ("cell.json",)


def simple_scene(folder: Path) -> tuple[str, ...]:
    (folder / "cube.obj").write_bytes(files.obj())
    rows = [[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    bodies = [
        {"id": name, "mesh": "cube.obj", "transform": [[1, 0, 0, STEP * k], *rows]}
        for k, name in enumerate(HOSTILE)
    ]
    scene = {"schema": "satcheck-scene-1", "bodies": bodies}
    (folder / "simple.json").write_text(json.dumps(scene), encoding="utf-8")
    return ("simple.json",)


def robot(folder: Path) -> tuple[str, ...]:
    origin = f'<origin xyz="{STEP} 0 0"/>'
    links = ("base [0]", "arm *", "tool/1")
    text = robot_of(
        *map(link, links),
        *(joint(f"j{k}", links[k], links[k + 1], inside=origin) for k in range(2)),
    )
    (folder / "r.urdf").write_text(text, encoding="utf-8")
    allowed = '<disable_collisions link1="base [0]" link2="arm *" reason="Adjacent"/>'
    srdf = f'<robot name="r">{allowed}</robot>'
    (folder / "r.srdf").write_text(srdf, encoding="utf-8")
    return ("r.urdf", "r.srdf")


def outlines(folder: Path) -> tuple[str, ...]:
    square = {"type": "outline", "points": [[0, 0], [1, 0], [1, 1], [0, 1]]}
    bodies = [{"id": f"shape {k}", "shape": square, "position": [STEP * k, 0, 0]} for k in range(4)]
    scene = {"schema": "satcheck.scene/1", "bodies": bodies}
    (folder / "nest.json").write_text(json.dumps(scene), encoding="utf-8")
    return ("nest.json", "--planar", "xy")


KINDS = (
    *(meshes, concave, glb, threemf, components, split_glb, nodes_of_two, toml_scene, json_scene),
    *(simple_scene, robot, outlines),
)


def pairs_of(ran: Ran, *relations: str) -> set[tuple[str, str]]:
    """Findings with one of these relations, or all of them."""
    findings = ran.document["findings"]
    return {(f["a"], f["b"]) for f in findings if not relations or f["relation"] in relations}


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_the_suggested_pairs_pass_and_no_others_are_limited(
    kind: Callable[[Path], tuple[str, ...]], tmp_path: Path
) -> None:
    """Links with a joint between them are allowed."""
    given = kind(tmp_path)
    bare = satcheck(*JSON, *given, cwd=tmp_path)
    meet = pairs_of(bare, "penetrating")
    assert meet
    assert bare.code in (0, 1), bare.err
    suggested = satcheck("suggest", *given, "-o", "rules.toml", cwd=tmp_path)
    assert suggested.code == 0, suggested.err
    for inputs in (
        (*given, "rules.toml"),
        ("rules.toml", *given),
        ("rules.toml", *given, "./rules.toml"),
    ):
        ran = satcheck(*JSON, *inputs, cwd=tmp_path)
        assert ran.code == 0, ran.err
        assert [b["id"] for b in ran.document["bodies"]] == [
            b["id"] for b in bare.document["bodies"]
        ]
        jointed = meet if kind is robot else set()
        assert pairs_of(ran) == pairs_of(bare) - jointed
        limited = {(f["a"], f["b"]) for f in ran.document["findings"] if f["rule"]}
        assert limited == meet - jointed
        suggested_ones = [r for r in ran.document["rules"] if r["reason"].startswith("suggested:")]
        assert {rule["allowed"] for rule in suggested_ones} == {True if jointed else None}
        assert "unused-rule" not in {issue["code"] for issue in ran.document["issues"]}
        assert ran.document["settings"] == bare.document["settings"]


def table(folder: Path, sunk: float, name: str = "table.glb", legs: int = 4) -> str:
    """A top, and legs that stand in it by so much, in metres."""
    top = make.box((-1, -1, 0), (1, 1, 0.1))
    leg = make.box((-0.05, -0.05, -0.7), (0.05, 0.05, 0.0))
    nodes: list[dict[str, Any]] = [{"name": "top", "mesh": 0}]
    for k in range(legs):
        at = [0.8 - 1.6 * (k % 2), 0.8 - 1.6 * (k // 2 % 2), sunk]
        nodes.append({"name": f"leg.{k:03d}", "mesh": 1, "translation": at})
    content = hierarchies.glb({"top": top, "leg": leg}, nodes, list(range(len(nodes))))
    (folder / name).write_bytes(content)
    return name


def test_a_leg_that_sinks_deeper_fails(tmp_path: Path) -> None:
    """From 2 mm to 91 mm, beside the rules that allow the 2 mm."""
    name = table(tmp_path, 0.002)
    assert satcheck("suggest", name, "-o", "rules.toml", cwd=tmp_path).code == 0
    assert satcheck(name, "rules.toml", cwd=tmp_path).code == 0
    table(tmp_path, 0.091)
    ran = satcheck(*JSON, name, "rules.toml", cwd=tmp_path)
    assert ran.code == 1
    assert {f["severity"] for f in ran.document["findings"] if f["rule"]} == {"error"}


def test_a_folder_has_one_file_of_rules(tmp_path: Path) -> None:
    """An asset is a scene of its own; of two with the same names and nearly the same overlap the
    larger limit counts."""
    (tmp_path / "kit").mkdir()
    table(tmp_path / "kit", 0.0028)
    table(tmp_path / "kit", 0.003, "stool.glb")
    ran = satcheck("suggest", "kit", "-o", "rules.toml", cwd=tmp_path)
    assert ran.code == 0, ran.err
    rules = tomllib.loads((tmp_path / "rules.toml").read_text())["rules"]
    assert [(rule["a"], rule["b"]) for rule in rules] == [("top", "leg.*")]
    assert all(0.0033 <= rule["max_depth"] <= 0.00331 for rule in rules)
    assert "in kit/stool.glb, kit/table.glb" in rules[0]["reason"]
    checked = ("batch", "kit", "--rules", "rules.toml")
    assert satcheck(*checked, cwd=tmp_path).code == 0
    table(tmp_path / "kit", 0.091)
    assert satcheck(*checked, cwd=tmp_path).code == 1


def box_on_plate(height: float, rule: str = "") -> str:
    """Boxes of edge 10; the upper one stands so high above the lower one's top."""
    shape = 'shape = {type = "box", size = [10, 10, 10]}'
    bodies = f"""\
schema = "satcheck.scene/1"
units = "mm"
bodies = [
    {{id = "plate", {shape}}},
    {{id = "bolt1", {shape}, position = [0, 0, {10 + height}]}},
]
"""
    return bodies + (f'[[rules]]\na = "bolt1"\nb = "plate"\n{rule}\n' if rule else "")


@pytest.mark.parametrize(
    "other",
    [
        box_on_plate(1.0, 'clearance = "2mm"'),
        box_on_plate(-0.05, 'max_depth = "0.1mm"'),
        box_on_plate(-1.0, 'severity = "warning"'),
    ],
)
def test_a_rule_that_would_loosen_rules_of_another_asset_is_not_suggested(
    other: str, tmp_path: Path
) -> None:
    (tmp_path / "kit").mkdir()
    (tmp_path / "kit" / "p.toml").write_text(box_on_plate(-5.0))
    (tmp_path / "kit" / "q.toml").write_text(other)
    ran = satcheck("suggest", "kit", cwd=tmp_path)
    assert ran.code == 3
    assert tomllib.loads(ran.out)["rules"] == []
    (tmp_path / "rules.toml").write_text(ran.out)
    assert satcheck("batch", "kit", "--rules", "rules.toml", cwd=tmp_path).code == 1
    assert "not suggested: plate and bolt1: a rule goes by names" in ran.out
    lines = (
        "satcheck batch kit -o report.json",
        "satcheck baseline write baseline.json report.json",
    )
    assert f"\nNext: {', then '.join(lines)} accepts what\neach asset has now" in ran.err
    for line in lines:
        assert satcheck(*line.split()[1:], cwd=tmp_path).code in (0, 1)
    assert satcheck("batch", "kit", "--baseline", "baseline.json", cwd=tmp_path).code == 0


def test_of_pairs_of_the_same_names_the_worst_sets_the_limits(tmp_path: Path) -> None:
    """A touch needs no rule, but a rule cannot leave its asset out."""
    (tmp_path / "kit").mkdir()
    for name, height in (("p", -5.0), ("q", -4.0), ("r", 0.0)):
        (tmp_path / "kit" / f"{name}.toml").write_text(box_on_plate(height))
    ran = satcheck("suggest", "kit", "-o", "rules.toml", cwd=tmp_path)
    assert ran.code == 0
    (rule,) = tomllib.loads((tmp_path / "rules.toml").read_text())["rules"]
    assert (rule["max_thickness"], rule["max_depth"]) == (5.5, 5.5)
    assert "in kit/p.toml, kit/q.toml; the limits add 10 % to kit/p.toml: " in rule["reason"]
    assert "2 pairs of these names need less" in rule["reason"]
    assert "1 rule lets some pairs overlap more than they do" in ran.err
    assert "as plate and bolt1 in kit/p.toml.\n" in ran.err
    assert satcheck("batch", "kit", "--rules", "rules.toml", cwd=tmp_path).code == 0


def kit_of_two(folder: Path) -> None:
    """A table in metres, and a rack in millimetres."""
    (folder / "kit").mkdir()
    table(folder / "kit", 0.002)
    shutil.copy(SAMPLES / "rack.3mf", folder / "kit")


def test_limits_for_assets_in_several_units_are_in_the_smallest(tmp_path: Path) -> None:
    """A number without a unit would mean another length in each asset."""
    kit_of_two(tmp_path)
    assert satcheck("suggest", "kit", "-o", "rules.toml", cwd=tmp_path).code == 0
    document = tomllib.loads((tmp_path / "rules.toml").read_text())
    assert document["units"] == "mm"
    limits = [(rule["a"], rule["max_depth"]) for rule in document["rules"]]
    assert limits == [("rack/tray", 0.55), ("top", 2.2)]
    assert "depth 2 mm as placed" in document["rules"][1]["reason"]
    checked = ("batch", "kit", "--rules", "rules.toml")
    assert satcheck(*checked, cwd=tmp_path).code == 0
    table(tmp_path / "kit", 0.0025)
    assert satcheck(*checked, cwd=tmp_path).code == 1


def test_lengths_without_a_unit_count_as_in_the_check_with_the_rules(tmp_path: Path) -> None:
    (tmp_path / "kit").mkdir()
    shutil.copy(SAMPLES / "rack.3mf", tmp_path / "kit")
    plain = 'schema = "satcheck.scene/1"\nbodies = [\n'
    for k in range(2):
        plain += f'{{id = "b{k}", shape = {{type = "box", size = [1, 1, 1]}}, '
        plain += f"position = [{STEP * k}, 0, 0]}},\n"
    (tmp_path / "kit" / "plain.toml").write_text(f"{plain}]\n")
    ran = satcheck("suggest", "kit", "-o", "rules.toml", cwd=tmp_path)
    assert ran.code == 0, ran.err
    assert "\nkit/plain.toml: no unit is stated, and lengths count in mm, as in a check" in ran.err
    document = tomllib.loads((tmp_path / "rules.toml").read_text())
    assert document["units"] == "mm"
    assert ("b0", 0.275) in [(rule["a"], rule["max_depth"]) for rule in document["rules"]]
    assert satcheck("batch", "kit", "--rules", "rules.toml", cwd=tmp_path).code == 0


def test_rules_of_a_folder_for_one_of_its_assets_warn_of_nothing(tmp_path: Path) -> None:
    """The rules for the others select no pair in it. They permit, so nothing is missed."""
    kit_of_two(tmp_path)
    assert satcheck("suggest", "kit", "-o", "rules.toml", cwd=tmp_path).code == 0
    for given in (("kit/rack.3mf", "rules.toml"), ("kit/rack.3mf", "--rules", "rules.toml")):
        ran = satcheck(*given, cwd=tmp_path)
        assert ran.code == 0, ran.err
        assert "warning" not in ran.out
        assert "1 suggested rule about no pair of bodies here" in ran.out
    ran = satcheck("kit/rack.3mf", "rules.toml", *JSON, cwd=tmp_path)
    severities = [i["severity"] for i in ran.document["issues"] if i["code"] == "unused-rule"]
    assert severities == ["note"]


def test_files_of_a_folder_can_be_left_out(tmp_path: Path) -> None:
    kit_of_two(tmp_path)
    ran = satcheck("suggest", "kit", "--exclude", "*.3mf", cwd=tmp_path)
    assert ran.code == 0, ran.err
    assert [rule["a"] for rule in tomllib.loads(ran.out)["rules"]] == ["top"]
    ran = satcheck("suggest", "kit/table.glb", "--exclude", "*.3mf", cwd=tmp_path)
    assert ran.code == 2
    assert "--exclude leaves out files of a folder" in ran.err
    (tmp_path / "satcheck.toml").write_text('exclude = ["*.3mf"]\n')
    assert satcheck("suggest", "kit/table.glb", cwd=tmp_path).code == 0


@pytest.mark.parametrize("command", [(), ("suggest",)])
def test_a_stored_report_is_no_input(command: tuple[str, ...], tmp_path: Path) -> None:
    name = table(tmp_path, 0.002)
    assert satcheck(name, "-o", "report.json", cwd=tmp_path).code == 1
    ran = satcheck(*command, "report.json", cwd=tmp_path)
    assert ran.code == 2
    assert "it is a result of satcheck, so give the files that it is about" in ran.err


@pytest.mark.parametrize("more", [("--format", "srdf"), ("--sample", "3")])
def test_a_robot_in_a_folder_has_one_pose(more: tuple[str, ...], tmp_path: Path) -> None:
    table(tmp_path, 0.002)
    ran = satcheck("suggest", ".", *more, cwd=tmp_path)
    assert ran.code == 2
    assert "give it alone" in ran.err


def test_an_asset_that_cannot_be_read_is_an_error(tmp_path: Path) -> None:
    table(tmp_path, 0.002)
    (tmp_path / "broken.obj").write_text("v 0 0 nan\nf 1 1 1\n")
    ran = satcheck("suggest", ".", cwd=tmp_path)
    assert ran.code == 2
    assert "broken.obj" in ran.err
    assert [rule["b"] for rule in tomllib.loads(ran.out)["rules"]] == ["leg.*"]


def test_a_rule_about_no_body_is_a_warning(tmp_path: Path) -> None:
    """As of a scene: the rest is checked."""
    rule = '[[rules]]\na = "bok"\nb = "cube"\nallowed = true\nreason = "a slip"\n'
    (tmp_path / "rules.toml").write_text(f'schema = "satcheck.scene/1"\nbodies = []\n{rule}')
    ran = satcheck(*JSON, "box.obj", str(tmp_path / "rules.toml"), "cube.off")
    assert ran.code == 0
    (issue,) = ran.document["issues"]
    assert (issue["code"], issue["severity"]) == ("unused-rule", "warning")
    assert ran.document["settings"]["depth"] is True


@pytest.mark.parametrize(
    ("inputs", "complaint"),
    [
        (("rules.toml",), "there is no body: give mesh files beside rules.toml"),
        (("rules.toml", "cube.obj"), "one body alone cannot collide: give two or more mesh files"),
        (("cube.obj", "rules.toml", "--split", "components"), "cube.obj is one piece"),
    ],
)
def test_rules_are_no_second_body(inputs: tuple[str, ...], complaint: str, tmp_path: Path) -> None:
    (tmp_path / "rules.toml").write_text('schema = "satcheck.scene/1"\nrules = []\n')
    (tmp_path / "cube.obj").write_bytes(files.obj())
    ran = satcheck(*inputs, cwd=tmp_path)
    assert ran.code == 2
    assert complaint in " ".join(ran.err.split())


def test_a_scene_is_resolved_beside_its_rules(tmp_path: Path) -> None:
    """The pair that a rule allows stays; the scene that is written states the rules."""
    given = toml_scene(tmp_path)
    rule = '[[rules]]\na = "plain"\nb = "two words"\nallowed = true\nreason = "meant"\n'
    (tmp_path / "rules.toml").write_text(f'schema = "satcheck.scene/1"\nbodies = []\n{rule}')
    ran = satcheck("resolve", *given, "rules.toml", "-o", "moved.toml", cwd=tmp_path)
    assert ran.code == 0, ran.err
    assert satcheck("moved.toml", cwd=tmp_path).code == 0


def test_rules_go_to_a_file_whose_name_says_so(tmp_path: Path) -> None:
    ran = satcheck("suggest", str(SAMPLES / "gripper.glb"), "-o", "rules.yaml", cwd=tmp_path)
    assert (ran.code, (tmp_path / "rules.yaml").exists()) == (2, False)
    assert "this command writes .toml, .json or .srdf" in ran.err
