"""`satcheck suggest --surface-tolerance`: what to type, with the evidence."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from trimesh import creation

from satcheck.cli.formats.schema import text
from tests.cli.process import satcheck


@pytest.fixture
def files(tmp_path: Path) -> dict[str, str]:
    """A pin and a bush of radius 5 with 24 facets, and a nut with 6."""
    meshes = {
        "pin": creation.cylinder(5, 20, sections=24),
        "bush": creation.annulus(5, 8, 20, sections=24),
        "nut": creation.cylinder(5, 20, sections=6),
    }
    for name, mesh in meshes.items():
        mesh.export(tmp_path / f"{name}.obj")
    return {name: str(tmp_path / f"{name}.obj") for name in meshes}


def test_what_to_type_and_why(files: dict[str, str]) -> None:
    ran = satcheck("suggest", "--surface-tolerance", files["bush"], files["nut"], "box.obj")
    assert ran.code == 0, ran.err
    bush, hole, outside, nut, left_out, box, whole = ran.out.splitlines()
    assert bush == "bush: --surface-tolerance 0.0428"
    assert outside.startswith("  24 convex facets: radius 8, ")
    assert hole.startswith(
        "  24 concave facets: radius 5, turning by 15 degrees over a facet, sagitta 0.0428, as at ("
    )
    assert nut == "nut: no curved surface is seen"
    assert left_out == (
        "  left out, perhaps a prism: 6 convex facets; if a curve, radius 5, "
        "turning by 60 degrees over a facet, sagitta 0.67"
    )
    assert box == "box: no curved surface is seen"
    assert whole == "whole input: --surface-tolerance 0.0428"
    assert "up to 40 degrees count as a curve" in ran.err


def test_no_curve(files: dict[str, str]) -> None:
    ran = satcheck("suggest", "--surface-tolerance", files["nut"])
    assert ran.code == 0, ran.err
    assert ran.out.endswith("whole input: no tolerance is proposed, no curved surface is seen\n")


def test_a_curve_that_explains_no_overlap(files: dict[str, str]) -> None:
    ran = satcheck("suggest", "--surface-tolerance", files["pin"])
    assert ran.code == 0, ran.err
    first, evidence, whole = ran.out.splitlines()
    assert first == "pin: its facets are inside the curves, and explain no overlap"
    assert evidence.startswith("  24 convex facets: radius 5, ")
    assert whole == "whole input: no tolerance is proposed, all facets are inside the curves"


def test_copies_are_told_of_once(files: dict[str, str]) -> None:
    ran = satcheck("suggest", "--surface-tolerance", *3 * [files["bush"]])
    assert ran.out.startswith("bush and 2 more bodies: --surface-tolerance 0.0428\n")


def test_json_follows_its_schema(files: dict[str, str], tmp_path: Path) -> None:
    path = tmp_path / "tolerances.json"
    ran = satcheck("suggest", "--surface-tolerance", files["bush"], "box.obj", "-o", str(path))
    assert ran.code == 0, ran.err
    document = json.loads(path.read_text())
    Draft202012Validator(json.loads(text("surface-tolerances"))).validate(document)
    assert document["surface_tolerance"] == 0.0428
    assert [body["surface_tolerance"] for body in document["bodies"]] == [0.0428, None]


@pytest.mark.parametrize("more", [("--never",), ("--format", "toml"), ("--planar", "xy")])
def test_wrong_usage(more: tuple[str, ...]) -> None:
    ran = satcheck("suggest", "--surface-tolerance", "box.obj", *more)
    assert ran.code == 2
    assert "--surface-tolerance is about meshes alone" in ran.err


def test_an_unreadable_body_is_an_error(tmp_path: Path) -> None:
    ran = satcheck("suggest", "--surface-tolerance", "box.obj", str(tmp_path / "gone.obj"))
    assert ran.code == 2
    assert "box: no curved surface is seen" in ran.out


def test_prose_is_not_written_into_a_file_of_rules(tmp_path: Path) -> None:
    path = tmp_path / "t.toml"
    ran = satcheck("suggest", "--surface-tolerance", "box.obj", "-o", str(path))
    assert (ran.code, path.exists()) == (2, False)
    assert "--surface-tolerance writes text or JSON" in ran.err
