"""`satcheck axes` as a whole process: its documents, its plot and its exit codes."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest
from jsonschema import Draft202012Validator
from matplotlib.colors import to_hex
from matplotlib.image import imread

from satcheck.cli.commands.schema import text
from satcheck.cli.formats.axes_plot import MOST_LINES
from satcheck.cli.plotting import LIGHT, WIDTH
from tests.cli.process import APART, PUSHED, SAMPLES, satcheck

SCHEMA = Draft202012Validator(json.loads(text("axes")))
CONCAVE = ("kettle.obj", "snowflake.obj")


@pytest.mark.parametrize(
    "arguments",
    [
        PUSHED,
        APART,
        CONCAVE,
        (*PUSHED, "--planar", "xy"),
        ("cell.toml", "--pair", "crate", "fence"),
    ],
    ids=" ".join,
)
def test_the_document_follows_its_schema(arguments: tuple[str, ...]) -> None:
    ran = satcheck("axes", *arguments, "--format", "json")
    assert ran.code == 0, ran.err
    SCHEMA.validate(ran.document)
    gaps = [axis["gap"] for axis in ran.document["axes"]]
    assert gaps == sorted(gaps, reverse=True)
    assert len(gaps) == ran.document["counts"]["distinct"]
    assert satcheck("axes", *arguments, "--format", "json").out == ran.out


def test_a_table_says_why_two_boxes_are_apart() -> None:
    ran = satcheck("axes", *APART)
    assert ran.code == 0
    for said in (
        "A box and B cube: separated",
        "12 x 12 edge pairs = 156 candidates",
        "3 + 3 + 9 = 15",
        "face 0 of A",
        "gap 0.5",
        "stops at axis 1 of 3",
        "2 are not needed",
        "Separating axis: 1, the largest gap, 0.5.",
    ):
        assert said in ran.out


def test_a_table_shows_the_way_out_and_the_units() -> None:
    ran = satcheck("axes", *PUSHED, "--units", "mm")
    assert "smallest overlap, 1 mm: move A by (-1, 0, 0)" in ran.out
    assert "note:" not in ran.out


def test_a_concave_body_is_told() -> None:
    ran = satcheck("axes", *CONCAVE, "--top", "2")
    assert "kettle and snowflake are no convex solids" in ran.out
    assert "577 more axes" in ran.out
    assert len(satcheck("axes", *CONCAVE, "--top", "2", "--format", "json").document["axes"]) == 2


def test_a_depth_within_the_tolerance_is_told(tmp_path: Path) -> None:
    (tmp_path / "near.obj").write_text(
        "v 2.0000001 0 0\nv 3 0 0\nv 2.5 1 0\nv 2.5 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
    )
    assert "a check says touching" in satcheck("axes", "box.obj", str(tmp_path / "near.obj")).out


def test_what_hangs_on_a_curve_is_incomplete(tmp_path: Path) -> None:
    layout = tmp_path / "layout.toml"
    layout.write_text(
        'schema = "satcheck.scene/1"\nbodies = [\n'
        '{id = "a", shape = {type = "outline", points = [[0, 0], [2, 0], [2, 2], [0, 2]]}},\n'
        '{id = "b", shape = {type = "sphere", radius = 1}, position = [3, 1, 0]}]\n'
    )
    ran = satcheck("axes", str(layout), "--planar", "xy", "--top", "1")
    assert ran.code == 3
    assert "not known" in ran.out
    assert "INCOMPLETE" in ran.out


def test_a_robot_is_posed() -> None:
    pair = ("arm.urdf", "--pair", "fore/beam", "base")
    posed = satcheck("axes", *pair, "--pose", '{"shoulder": 0.5}', "--format", "json")
    assert posed.code == 0, posed.err
    assert posed.out != satcheck("axes", *pair, "--format", "json").out
    many = satcheck("axes", *pair, "--pose", "arm_poses.json")
    assert many.code == 2
    assert "one pose" in many.err


@pytest.mark.parametrize("pair", [APART, CONCAVE], ids=" ".join)
def test_a_plot_has_a_line_for_each_axis_up_to_some(tmp_path: Path, pair: tuple[str, str]) -> None:
    plot = tmp_path / "plot.svg"
    ran = satcheck("axes", *pair, "--plot", str(plot))
    assert ran.code == 0, ran.err
    drawn = "".join(ElementTree.parse(plot).getroot().itertext())
    assert "face 2 of" in drawn
    assert drawn.count(" of A") <= 2 * MOST_LINES
    assert ("separating" in drawn, "MTV" in drawn) == (pair == APART, pair == CONCAVE)
    again = tmp_path / "again.svg"
    satcheck("axes", *pair, "--plot", str(again))
    assert again.read_bytes() == plot.read_bytes()


def test_a_plot_is_an_image(tmp_path: Path) -> None:
    plot = tmp_path / "plot.png"
    assert satcheck("axes", *APART, "--plot", str(plot)).code == 0
    image = imread(plot)
    assert image.shape[1] == 2 * WIDTH
    assert to_hex(image[0, 0]) == LIGHT.paper


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("box.obj",), "one body alone"),
        (("box.obj", "missing.obj"), "no such file"),
        (("cell.toml",), "--pair A B"),
        (("cell.toml", "--pair", "crate", "nothing"), "there is no body 'nothing'"),
        (("box.obj", "cube.off", "--plot", "plot.jpg"), "drawn as .svg, .png or .pdf"),
        (("box.obj", "cube.off", "--top", "0"), "--top"),
        (("box.obj", "cube.off", "--format", "json", "-o", "cube.off"), "overwrite an input"),
    ],
)
def test_misuse_exits_with_two(arguments: tuple[str, ...], said: str) -> None:
    ran = satcheck("axes", *arguments)
    assert ran.code == 2
    assert said in ran.err
    assert ran.out == ""


def test_issues_of_the_inputs_are_told(tmp_path: Path) -> None:
    lacking = tmp_path / "lacking.obj"
    lines = (SAMPLES / "box.obj").read_text().splitlines()
    lacking.write_text("\n".join(lines[:-1]) + "\n")
    for command in ("axes", "tradeoff"):
        ran = satcheck(command, str(lacking), "box_pushed.stl", cwd=SAMPLES)
        assert "[not-closed]" in ran.err
