"""`satcheck tradeoff` as a whole process: its documents, its plot and its exit codes."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner
from jsonschema import Draft202012Validator
from matplotlib.colors import to_hex
from matplotlib.image import imread

from satcheck.cli import plotting
from satcheck.cli.commands import tradeoff
from satcheck.cli.commands.schema import text
from satcheck.cli.plotting import LIGHT, WIDTH
from tests.cli.process import PUSHED, satcheck

SCHEMA = json.loads(text("tradeoff"))
RUNGS = ("aabb", "obb", "hull", "parts", "exact", "boolean")


def test_the_document_follows_its_schema() -> None:
    ran = satcheck("tradeoff", *PUSHED, "--format", "json")
    assert ran.code == 0, ran.err
    Draft202012Validator(SCHEMA).validate(ran.document)
    rungs = ran.document["rungs"]
    assert list(dict.fromkeys(row["rung"] for row in rungs)) == list(RUNGS)
    assert {row["cold"]["runs"] for row in rungs} == {5}


def test_a_spent_budget_is_a_document_too_and_exits_with_three(tmp_path: Path) -> None:
    plot = tmp_path / "plot.svg"
    out = tmp_path / "report.json"
    ran = satcheck(
        "tradeoff", *PUSHED, "--limit", "run-seconds=1e-9", "--plot", str(plot), "-o", str(out)
    )
    assert ran.code == 3, ran.err
    document = json.loads(out.read_text(encoding="utf-8"))
    Draft202012Validator(SCHEMA).validate(document)
    assert {row["state"] for row in document["rungs"]} == {"not run"}
    drawn = "".join(ElementTree.fromstring(plot.read_text(encoding="utf-8")).itertext())
    silent = "aabb, obb, hull, parts 0.5, parts 0.2, parts 0.1, parts 0.05, parts 0.02, parts 0.01"
    assert f"{silent}, exact, boolean: not run, budget" in " ".join(drawn.split())


def test_the_table_and_the_plot_have_every_rung(tmp_path: Path) -> None:
    plot = tmp_path / "plot.svg"
    ran = satcheck("tradeoff", *PUSHED, "--plot", str(plot))
    assert ran.code == 0, ran.err
    for said in (
        *RUNGS,
        "parts 0.01",
        "volume 2.62",
        "The default: settled by hull",
        "x exact",
        "settled by",
    ):
        assert said in ran.out
    drawn = "".join(ElementTree.parse(plot).getroot().itertext())
    for said in ("aabb", "hull", "boolean", "verdict only"):
        assert said in drawn


def test_a_plot_is_an_image(tmp_path: Path) -> None:
    plot = tmp_path / "plot.png"
    ran = satcheck("tradeoff", *PUSHED, "--limit", "run-seconds=1e-9", "--plot", str(plot))
    assert ran.code == 3, ran.err
    image = imread(plot)
    assert image.shape[1] == 2 * WIDTH
    assert to_hex(image[0, 0]) == LIGHT.paper


def test_without_matplotlib_nothing_runs_and_the_way_to_get_it_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(plotting, "find_spec", lambda _: None)
    plot = tmp_path / "plot.svg"
    ran = CliRunner().invoke(tradeoff.command, [*PUSHED, "--plot", str(plot)])
    assert ran.exit_code == 2
    assert "pip install matplotlib" in ran.output
    assert not plot.exists()


def test_the_schema_is_printed() -> None:
    assert satcheck("schema", "tradeoff").document == SCHEMA


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("box.obj",), "one body alone"),
        (("box.obj", "missing.obj"), "no such file"),
        (("box.obj", "cube.off", "--plot", "plot.jpg"), "drawn as .svg, .png or .pdf"),
        (("box.obj", "cube.off", "--format", "json", "-o", "cube.off"), "overwrite an input"),
    ],
)
def test_misuse_exits_with_two(arguments: tuple[str, ...], said: str) -> None:
    ran = satcheck("tradeoff", *arguments)
    assert ran.code == 2
    assert said in ran.err
    assert ran.out == ""
