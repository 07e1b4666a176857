"""`satcheck suggest --surface-tolerance`: what to type, with the evidence."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from trimesh import creation

from satcheck.cli.report.schema import text
from tests.cli.process import satcheck


@pytest.fixture
def files(tmp_path: Path) -> dict[str, str]:
    """Cylinders of radius 5, by the number of their facets."""
    paths = {f"c{number}": tmp_path / f"c{number}.obj" for number in (6, 24)}
    for number, path in zip((6, 24), paths.values(), strict=True):
        creation.cylinder(5, 20, sections=number).export(path)
    return {name: str(path) for name, path in paths.items()}


def test_what_to_type_and_why(files: dict[str, str]) -> None:
    ran = satcheck("suggest", "--surface-tolerance", files["c24"], files["c6"], "box.obj")
    assert ran.code == 0, ran.err
    first, evidence, nut, left_out, box, whole = ran.out.splitlines()
    assert first == "c24: --surface-tolerance 0.0428"
    assert evidence.startswith(
        "  24 facets: radius 5, turning by 15 degrees over a facet, sagitta 0.0428, as at ("
    )
    assert nut == "c6: no curved surface is seen"
    assert left_out == (
        "  left out, perhaps a prism: 6 facets; if a curve, radius 5, "
        "turning by 60 degrees over a facet, sagitta 0.67"
    )
    assert box == "box: no curved surface is seen"
    assert whole == "whole input: --surface-tolerance 0.0428"
    assert "up to 40 degrees count as a curve" in ran.err


def test_no_curve(files: dict[str, str]) -> None:
    ran = satcheck("suggest", "--surface-tolerance", files["c6"])
    assert ran.code == 0, ran.err
    assert ran.out.endswith("whole input: no curved surface is seen, no tolerance is proposed\n")


def test_copies_are_told_of_once(files: dict[str, str]) -> None:
    ran = satcheck("suggest", "--surface-tolerance", files["c24"], files["c24"], files["c24"])
    assert ran.out.startswith("c24 and 2 more bodies: --surface-tolerance 0.0428\n")


def test_json_follows_its_schema(files: dict[str, str], tmp_path: Path) -> None:
    path = tmp_path / "tolerances.json"
    ran = satcheck("suggest", "--surface-tolerance", files["c24"], "box.obj", "-o", str(path))
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
