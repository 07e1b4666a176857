"""What `satcheck suggest` writes, given beside the same input: the suggested pairs are allowed."""

from __future__ import annotations

import json
import shutil
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
    *(meshes, glb, threemf, components, split_glb, nodes_of_two, toml_scene, json_scene),
    *(simple_scene, robot, outlines),
)


def pairs_of(ran: Ran, *relations: str) -> set[tuple[str, str]]:
    """Findings with one of these relations, or all of them."""
    findings = ran.document["findings"]
    return {(f["a"], f["b"]) for f in findings if not relations or f["relation"] in relations}


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_the_suggested_pairs_are_allowed_and_no_others(
    kind: Callable[[Path], tuple[str, ...]], tmp_path: Path
) -> None:
    given = kind(tmp_path)
    bare = satcheck(*JSON, *given, cwd=tmp_path)
    meet = pairs_of(bare, "penetrating", "touching")
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
        assert pairs_of(ran) == pairs_of(bare) - meet
        counted = ran.document["summary"]["pairs"]
        already = bare.document["summary"]["pairs"]["allowed"]
        assert counted["allowed"] == len(meet) + already
        assert "unused-rule" not in {issue["code"] for issue in ran.document["issues"]}
        assert ran.document["settings"] == bare.document["settings"]


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
