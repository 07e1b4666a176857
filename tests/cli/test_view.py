"""`satcheck view` as a whole process: the report and its mesh files become the same page."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.cli.process import PUSHED, SAMPLES, satcheck
from tests.cli.test_picture import page_data


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in (*PUSHED, "cell.toml", "workcell.json", "rack.3mf", "l_bracket.obj"):
        shutil.copy(SAMPLES / name, tmp_path)
    return tmp_path


@pytest.mark.parametrize("scene", [PUSHED, ("rack.3mf",), ("--split", "components", "rack.3mf")])
def test_the_page_is_that_of_the_check(folder: Path, scene: tuple[str, ...]) -> None:
    satcheck(*scene, "-o", "direct.html", cwd=folder)
    satcheck("--contacts", *scene, "-o", "report.json", cwd=folder)
    ran = satcheck("view", "report.json", "-o", "later.html", cwd=folder)
    assert (ran.code, ran.out, ran.err) == (0, "", "")
    assert (folder / "later.html").read_text() == (folder / "direct.html").read_text()


def test_shapes_of_a_scene_are_drawn_from_their_sizes(folder: Path) -> None:
    assert satcheck("workcell.json", "-o", str(folder / "report.json")).code != 2
    ran = satcheck("view", "report.json", "-o", "out.html", "--root", str(SAMPLES), cwd=folder)
    assert ran.code == 0
    assert page_data((folder / "out.html").read_text())["drawn"]


def test_without_a_display_the_page_is_named(folder: Path) -> None:
    satcheck(*PUSHED, "-o", "report.json", cwd=folder)
    env = {"DISPLAY": "", "WAYLAND_DISPLAY": ""}
    ran = satcheck("view", "report.json", cwd=folder, env=env)
    assert ran.code == 0
    page = Path(ran.out.strip())
    assert page_data(page.read_text())["findings"]
    shutil.rmtree(page.parent)


def test_the_page_goes_to_standard_output(folder: Path) -> None:
    satcheck(*PUSHED, "-o", "report.json", cwd=folder)
    ran = satcheck("view", "report.json", "-o", "-", cwd=folder)
    assert (ran.code, ran.err) == (0, "")
    assert page_data(ran.out)["findings"]


def test_a_changed_file_is_named_and_drawn_as_it_is_now(folder: Path) -> None:
    satcheck(*PUSHED, "-o", "report.json", cwd=folder)
    shutil.copy(SAMPLES / "l_bracket.obj", folder / "box.obj")
    ran = satcheck("view", "report.json", "-o", "out.html", cwd=folder)
    assert ran.code == 3
    assert "box.obj has changed since the report was made" in ran.err
    data = page_data((folder / "out.html").read_text())
    assert any("has changed" in issue for issue in data["issues"])
    assert [finding["a"] for finding in data["findings"]] == [0]


def test_a_missing_file_leaves_its_findings_as_text(folder: Path) -> None:
    satcheck(*PUSHED, "-o", "report.json", cwd=folder)
    (folder / "box.obj").unlink()
    ran = satcheck("view", "report.json", "-o", "out.html", cwd=folder)
    assert ran.code == 3
    assert "not drawn" in ran.err
    (finding,) = page_data((folder / "out.html").read_text())["findings"]
    assert (finding["a"], finding["b"]) == (None, 0)


def test_one_asset_of_many(folder: Path) -> None:
    satcheck("each", "rack.3mf", "box.obj", "-o", "report.json", cwd=folder)
    assert satcheck("view", "report.json", "-o", "out.html", cwd=folder).code == 2
    ran = satcheck("view", "report.json", "--asset", "rack.3mf", "-o", "out.html", cwd=folder)
    assert ran.code == 0


@pytest.mark.parametrize("text", ["{}", "[]", "not JSON", '{"schema": "satcheck.samples/1"}'])
def test_what_is_no_report_is_refused(folder: Path, text: str) -> None:
    (folder / "report.json").write_text(text)
    ran = satcheck("view", "report.json", "-o", "out.html", cwd=folder)
    assert ran.code == 2
    assert "report.json" in ran.err
    assert not (folder / "out.html").exists()


def test_other_endings_are_refused(folder: Path) -> None:
    satcheck(*PUSHED, "-o", "report.json", cwd=folder)
    assert satcheck("view", "report.json", "-o", "out.txt", cwd=folder).code == 2
