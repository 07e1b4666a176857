"""`--planar`: drawings and meshes as outlines, from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.process import satcheck

LAYOUT = """<svg xmlns="http://www.w3.org/2000/svg"
 width="210mm" height="297mm" viewBox="0 0 210 297">
<path id="frame" d="M0,0 h100 v100 h-100 z M20,20 v60 h60 v-60 z" fill-rule="evenodd"/>
<circle id="in_hole" cx="50" cy="50" r="29"/>
<rect id="beside" x="100" y="0" width="10" height="10"/>
<rect id="over" x="105" y="5" width="10" height="10"/>
<path id="crossing" fill-rule="evenodd" d="M150,0 h9 v9 h-9 z M155,5 h9 v9 h-9 z"/>
</svg>"""


@pytest.fixture
def layout(tmp_path: Path) -> Path:
    path = tmp_path / "layout.svg"
    path.write_text(LAYOUT)
    return path


def relations(*arguments: object) -> dict[tuple[str, str], str]:
    ran = satcheck(*map(str, arguments), "--format", "json")
    report = json.loads(ran.out)
    return {(f["a"], f["b"]): f["relation"] for f in report["findings"]}


def test_the_shapes_of_a_drawing_are_bodies(layout: Path) -> None:
    ran = satcheck(str(layout), "--planar", "xy", "--format", "json")
    report = json.loads(ran.out)
    assert ran.code == 2  # one shape cannot be read
    assert report["units"] == "mm"
    assert report["settings"]["planar"] == "xy"
    found = {(f["a"], f["b"]): f for f in report["findings"]}
    assert found["frame", "in_hole"]["relation"] == "separated"
    assert found["frame", "beside"]["relation"] == "touching"
    assert found["beside", "over"]["relation"] == "penetrating"
    # One shape that cannot be read does not stop the others.
    assert found["frame", "crossing"]["relation"] == "indeterminate"
    assert "unsupported-feature" in {issue["code"] for issue in report["issues"]}


def test_several_files_are_a_body_each(layout: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.svg"
    other.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><rect x="45" y="45" width="9" height="9"/>'
        '<rect x="106" y="6" width="2" height="2"/></svg>'
    )
    layout.write_text(LAYOUT.replace('<path id="crossing"', '<path display="none" id="crossing"'))
    plane = ("--planar", "xy", "--units", "mm")  # the second file states no unit
    assert relations(layout, other, *plane) == {("layout", "other"): "contains"}


def test_a_drawing_needs_a_plane(layout: Path) -> None:
    ran = satcheck(str(layout))
    assert ran.code == 2
    assert "--planar xy" in ran.err


def test_meshes_are_seen_along_an_axis() -> None:
    pair = ("box.obj", "box_pushed.stl")
    assert relations(*pair, "--planar", "xy") == {("box", "box_pushed"): "penetrating"}
    ran = satcheck(*pair, "--planar", "xy", "--volume")
    assert ran.code == 2
    assert "planar" in ran.err


@pytest.mark.parametrize("backwards", [False, True])
def test_shapes_of_a_file_that_run_different_ways_round_do_not_cancel(
    tmp_path: Path, backwards: bool
) -> None:
    both, within = tmp_path / "both.svg", tmp_path / "within.svg"
    head = '<svg xmlns="http://www.w3.org/2000/svg">'
    both.write_text(f'{head}<path d="M0 0H4V4H0Z"/><path d="M2 0V4H6V0Z"/></svg>')
    within.write_text(f'{head}<rect x="2.5" y="1" width="1" height="1"/></svg>')
    files = (within, both) if backwards else (both, within)
    found = set(relations(*files, "--planar", "xy").values())
    assert found == {"inside" if backwards else "contains"}


def test_what_a_drawing_leaves_out_is_said_once(layout: Path) -> None:
    layout.write_text(LAYOUT.replace("</svg>", "<text>T</text></svg>"))
    report = json.loads(satcheck(str(layout), "--planar", "xy", "--format", "json").out)
    codes = [issue["code"] for issue in report["issues"]]
    assert codes.count("ignored-geometry") == 1


@pytest.mark.parametrize("command", [[], ["suggest"], ["resolve"], ["tradeoff"]])
def test_no_command_takes_a_drawing_for_bodies_in_space(command: list[str], tmp_path: Path) -> None:
    paths = []
    for name, x in (("one", 0), ("two", 5)):
        path = tmp_path / f"{name}.svg"
        path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg"><circle cx="{x}" r="3"/></svg>')
        paths.append(str(path))
    ran = satcheck(*command, *paths)
    assert ran.code == 2
    assert "[planar-only]" in ran.err
    assert "one.svg: a drawing is flat" in ran.err
    assert ("--planar" in ran.err) is (command in ([], ["suggest"]))
