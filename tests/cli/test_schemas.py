"""Every document that a command prints follows its published schema."""

from __future__ import annotations

import itertools
import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from satcheck._version import __version__
from satcheck.audit import Settings, check
from satcheck.audit.settings import Accuracy
from satcheck.cli.commands.schema import DOCUMENTS, text
from satcheck.report.json import render
from satcheck.scene import load_scene
from tests.cli.process import PUSHED, SAMPLES, satcheck


def validator(name: str) -> Draft202012Validator:
    return Draft202012Validator(json.loads(text(name)))


SCHEMA = validator("report")
CERTIFIED = Settings(certificate=True, depth=True, clearance=0.5)
SHAPES: dict[str, dict[str, Any]] = {
    "box": {"type": "box", "size": [1, 1, 1]},
    "slab": {"type": "box", "size": [4, 4, 1]},
    "ball": {"type": "sphere", "radius": 0.5},
    "globe": {"type": "sphere", "radius": 2},
    "pill": {"type": "capsule", "radius": 0.25, "length": 1},
    "can": {"type": "cylinder", "radius": 0.5, "height": 1},
    "hat": {"type": "cone", "radius": 0.5, "height": 1},
    "egg": {"type": "ellipsoid", "radii": [0.5, 0.25, 0.75]},
}
# Apart, near, flush, within the tolerance, overlapping, concentric.
OFFSETS = (5.0, 1.25, 1.0, 1.0 - 1e-7, 0.75, 0.0)


def checked(folder: Path, settings: Settings, bodies: list[dict[str, Any]], **more: Any) -> Any:
    path = folder / "scene.json"
    path.write_text(
        json.dumps({"schema": "satcheck.scene/1", "bodies": bodies, **more}), encoding="utf-8"
    )
    return json.loads("".join(render(check(load_scene([path]), settings), timings=True)))


@pytest.mark.parametrize(
    ("turn", "offsets"),
    [({}, OFFSETS), ({"euler": [20, 30, 40]}, OFFSETS[1::2])],
    ids=["straight", "turned"],
)
def test_certificates_of_shapes(
    tmp_path: Path, turn: dict[str, Any], offsets: tuple[float, ...]
) -> None:
    """Pairs of primitives in every relation: `point` and `nested` prove curved shapes alone."""
    kinds = set()
    pairs = itertools.combinations_with_replacement(SHAPES, 2)
    for (one, other), offset in itertools.product(pairs, offsets):
        bodies = [
            {"id": "a", "shape": SHAPES[one]},
            {"id": "b", "shape": SHAPES[other], "position": [0, 0, offset], **turn},
        ]
        document = checked(tmp_path, CERTIFIED, bodies)
        SCHEMA.validate(document)
        certificate = document["findings"][0]["certificate"]
        kinds.add(certificate and certificate["relation"]["kind"])
    assert kinds >= {"axis", "point", "nested"}


COMMANDS: dict[str, tuple[tuple[str, ...], str]] = {
    "axes": (("axes", *PUSHED), "axes"),
    "check": (
        ("--volume", "--contacts", "--components", "--cross-check", "--clearance", "1", *PUSHED),
        "report",
    ),
    "parts": (("--parts", "l_bracket.obj", "peg_in_arm.ply", "open_box.off"), "report"),
    "mesh files": (("--certificate", "l_bracket.obj", "peg_in_notch.ply", "cube.off"), "report"),
    "unreadable": (("box.obj", "cube.off", "{}/broken.obj"), "report"),
    "scene": (("cell.toml",), "report"),
    "planar": (("--planar", "xy", "box.obj", "box_pushed.stl", "cube.off"), "report"),
    "components": (("--split", "components", "rack.3mf"), "report"),
    "robot": (("arm.urdf", "arm.srdf", "--pose", '{"shoulder": 0.5}'), "report"),
    "samples": (("arm.urdf", "--sample", "3"), "samples"),
    "poses": (("arm.urdf", "--pose", "arm_poses.json", "--contacts"), "samples"),
    "boxes": (("--accuracy", "aabb", "workcell.json"), "report"),
    "resolve": (("resolve", *PUSHED), "resolution"),
    "suggest": (("suggest", "cell.toml"), "suggestions"),
    "tradeoff": (("tradeoff", "--limit", "run-seconds=2", *PUSHED), "tradeoff"),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_writes_what_its_schema_says(tmp_path: Path, name: str) -> None:
    """By -o and by standard output; with the name of its form and the version of the tool."""
    arguments, schema = COMMANDS[name]
    out = tmp_path / "out.json"
    (tmp_path / "broken.obj").write_text("v 0 0 nan\nf 1 1 1\n", encoding="utf-8")
    ran = satcheck(*(word.replace("{}", str(tmp_path)) for word in arguments), "-o", str(out))
    assert "internal" not in ran.err
    document = json.loads(out.read_text(encoding="utf-8"))
    validator(schema).validate(document)
    assert document["schema"] == f"satcheck.{schema}/1"
    assert document["tool"] == {"name": "satcheck", "version": __version__}
    published = satcheck("schema", schema).document["properties"]["schema"]
    assert published in ({"const": document["schema"]}, {"enum": [document["schema"]]})


@pytest.mark.parametrize("certified", [True, False])
def test_a_verification_follows_its_schema(tmp_path: Path, certified: bool) -> None:
    report, out = tmp_path / "report.json", tmp_path / "out.json"
    satcheck(*(["--certificate"] if certified else []), "-o", str(report), *PUSHED)
    ran = satcheck("verify", str(report), "-o", str(out))
    assert ran.code == (0 if certified else 2)
    document = json.loads(out.read_text(encoding="utf-8"))
    validator("verification").validate(document)
    assert document["accepted"] is certified
    assert document["tool"] == {"name": "satcheck", "version": __version__}
    assert satcheck("verify", str(report), "-o", str(report)).code == 2


@pytest.mark.parametrize("code", [0, 2, 3])
def test_a_decomposition_follows_its_schema(tmp_path: Path, code: int) -> None:
    """Of bodies with parts, of a file that cannot be read, of a body without parts."""
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    more = {0: (), 2: ("gone.obj",), 3: (str(tmp_path / "flat.obj"),)}[code]
    ran = satcheck("decompose", "--format", "json", *PUSHED, *more)
    assert ran.code == code
    validator("decomposition").validate(ran.document)
    assert ran.document["tool"] == {"name": "satcheck", "version": __version__}


@pytest.mark.parametrize("document", DOCUMENTS)
def test_each_schema_is_one(document: str) -> None:
    Draft202012Validator.check_schema(json.loads(text(document)))


MOTION = [{"bodies": "a", "translation": [0, 0, 4]}]
SCENES: dict[str, dict[str, Any]] = {
    "silenced": {"rules": [{"a": "*", "b": "*", "severity": "none"}]},
    "limited": {"rules": [{"a": "*", "b": "*", "max_depth": 0.1, "max_volume": 0.5}]},
    "near": {"rules": [{"a": "*", "b": "*", "clearance": 9}]},
    "allowed": {"rules": [{"a": "*", "b": "*", "allowed": True, "reason": "meant"}]},
    "moving": {"motion": MOTION},
    "moving and limited": {"motion": MOTION, "rules": [{"a": "*", "b": "*", "max_depth": 0.1}]},
    "ignored": {"ignore_within_groups": ["all"]},
}


@pytest.mark.parametrize("accuracy", ["aabb", "hull", "exact"])
@pytest.mark.parametrize("scene", SCENES)
def test_reports_of_scenes(tmp_path: Path, scene: str, accuracy: Accuracy) -> None:
    for name in ("l_bracket.obj", "open_box.off"):
        shutil.copy(SAMPLES / name, tmp_path)
    settings = Settings(accuracy=accuracy, certificate=accuracy == "exact", cache=False)
    for offset in OFFSETS:
        bodies: list[dict[str, Any]] = [
            {"id": "a", "mesh": "l_bracket.obj", "groups": ["all"]},
            {"id": "b", "shape": SHAPES["can"], "position": [4, 1, offset], "groups": ["all"]},
            {"id": "c", "mesh": "open_box.off", "position": [0, 5, offset], "groups": ["all"]},
            {"id": "d", "shape": SHAPES["box"], "position": [2, 7, 2 + offset], "groups": ["all"]},
        ]
        SCHEMA.validate(checked(tmp_path, settings, bodies, **SCENES[scene]))


def test_a_report_that_leaves_pairs_out(tmp_path: Path) -> None:
    bodies = [{"id": f"b{k}", "shape": SHAPES["box"], "position": [k, 0, 0]} for k in range(12)]
    document = checked(tmp_path, CERTIFIED, bodies)
    SCHEMA.validate(document)
    assert document["truncated"] is not None
