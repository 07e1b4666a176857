"""`--planar`: outlines of scenes and of meshes, from the command line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.cli.process import satcheck

SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
L_SHAPE = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]
TURNED = {"euler": [0, 0, 45]}
SIDE = 2**0.5 / 2  # from the middle of a turned square to its corners


def layout(folder: Path, **shapes: tuple[Any, dict[str, Any]]) -> str:
    """A scene of outlines, each with its placement."""
    bodies = [
        {"id": id_, "shape": {"type": "outline", "points": points}, **placement}
        for id_, (points, placement) in shapes.items()
    ]
    path = folder / "layout.json"
    path.write_text(json.dumps({"schema": "satcheck.scene/1", "bodies": bodies}), "utf-8")
    return str(path)


def at(x: float, y: float) -> dict[str, Any]:
    return {"position": [x, y, 0]}


def finding(*arguments: str) -> dict[str, Any]:
    ran = satcheck(*arguments, "--planar", "xy", "--format", "json")
    (found,) = json.loads(ran.out)["findings"]
    return {key: value for key, value in found.items() if key != "plan"}  # it has times


def test_squares_overlap_by_a_half(tmp_path: Path) -> None:
    found = finding(layout(tmp_path, a=(SQUARE, {}), b=(SQUARE, at(0.5, 0.25))), "--depth")
    assert (found["relation"], found["depth"], found["quality"]) == ("penetrating", 0.5, "exact")
    assert found["mtv"] == [-0.5, 0.0, 0.0]


@pytest.mark.parametrize(
    ("a", "b", "placement", "relation"),
    [
        (SQUARE, SQUARE, at(1.0, 0.5), "touching"),
        (SQUARE, SQUARE, at(1.0, 1.0), "touching"),
        (SQUARE, SQUARE, at(1.0 + 2.0**-50, 0.5), "separated"),
        (SQUARE, SQUARE, at(1.0 - 2.0**-50, 0.5), "penetrating"),
        (L_SHAPE, SQUARE, at(1.0, 1.0), "touching"),  # in its notch
        (L_SHAPE, SQUARE, at(1.25, 1.25), "separated"),
        (L_SHAPE, SQUARE, at(0.75, 0.75), "penetrating"),
        (L_SHAPE, [[0.25, 0.25], [1.75, 0.25], [0.25, 0.75]], {}, "contains"),
        ([[0.25, 0.25], [0.5, 0.25], [0.25, 0.5]], SQUARE, {}, "inside"),
        (SQUARE, SQUARE, {}, "coincident"),
        (SQUARE, SQUARE, {**TURNED, **at(1.0 + SIDE - 0.01, 0.0)}, "penetrating"),
        (SQUARE, SQUARE, {**TURNED, **at(1.0 + SIDE + 0.01, 0.0)}, "separated"),
    ],
)
def test_outlines_relate_exactly(
    a: Any, b: Any, placement: dict[str, Any], relation: str, tmp_path: Path
) -> None:
    given = layout(tmp_path, a=(a, {}), b=(b, placement))
    assert finding(given, "--tolerance", "0")["exact_relation"] == relation


def test_the_gap_of_outlines_and_their_clearance(tmp_path: Path) -> None:
    given = layout(tmp_path, a=(SQUARE, {}), b=(L_SHAPE, at(1.25, -0.5)))
    found = finding(given, "--clearance", "0.5")
    assert (found["relation"], found["distance"], found["severity"]) == ("near", 0.25, "error")
    assert finding(given, "--clearance", "0.25")["severity"] == "none"


@pytest.mark.parametrize("first", range(6))
@pytest.mark.parametrize("step", [1, -1])
def test_the_order_of_points_changes_no_answer(first: int, step: int, tmp_path: Path) -> None:
    given = {"a": (L_SHAPE, {}), "b": (SQUARE, at(0.75, 0.5))}
    expected = finding(layout(tmp_path, **given), "--depth")
    given["a"] = ((L_SHAPE[first:] + L_SHAPE[:first])[::step], {})
    assert finding(layout(tmp_path, **given), "--depth") == expected


def test_an_outline_beside_a_mesh(tmp_path: Path) -> None:
    given = layout(tmp_path, plate=(SQUARE, at(100.0, 100.0)))
    assert finding(given, "box.obj")["relation"] == "separated"


@pytest.mark.parametrize("command", [[], ["suggest"], ["resolve"], ["tradeoff"]])
def test_no_command_takes_an_outline_for_a_body_in_space(
    command: list[str], tmp_path: Path
) -> None:
    given = layout(tmp_path, one=(SQUARE, {}), two=(SQUARE, at(0.5, 0.0)))
    ran = satcheck(*command, given)
    assert ran.code == 2
    assert "[planar-only]" in ran.err
    assert "one is an outline, which is flat" in ran.err
    assert ("--planar" in ran.err) is (command in ([], ["suggest"]))


def test_an_outline_has_no_extent_across_its_plane(tmp_path: Path) -> None:
    given = layout(tmp_path, a=(SQUARE, {}), b=(SQUARE, at(0.5, 0.0)))
    ran = satcheck(given, "--planar", "yz")
    assert ran.code == 2
    assert "seen edge on [no-outline]" in ran.err


def test_meshes_are_seen_along_an_axis() -> None:
    pair = ("box.obj", "box_pushed.stl")
    assert finding(*pair)["relation"] == "penetrating"
    ran = satcheck(*pair, "--planar", "xy", "--volume")
    assert ran.code == 2
    assert "planar" in ran.err


@pytest.mark.parametrize("name", ["a.svg", "a.dxf"])
def test_drawings_are_no_known_format(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("<svg/>")
    ran = satcheck(str(tmp_path / name), "box.obj", "--planar", "xy")
    assert ran.code == 2
    assert "known are .3" in ran.err
