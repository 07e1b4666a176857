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
    assert (ran.code, ran.out, ran.err) == (0, "", "Report: later.html\n")
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
    ran = satcheck("view", "report.json", "--format", "html", "-o", "-", cwd=folder)
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
    assert "no such file (--root names the folder where the check ran)" in ran.err
    (finding,) = page_data((folder / "out.html").read_text())["findings"]
    assert (finding["a"], finding["b"]) == (None, 0)


def test_one_asset_of_many(folder: Path) -> None:
    satcheck("batch", "rack.3mf", "box.obj", "-o", "report.json", cwd=folder)
    ran = satcheck("view", "report.json", "--asset", "rack.3mf", "-o", "out.html", cwd=folder)
    assert ran.code == 0
    assert page_data((folder / "out.html").read_text())["findings"]
    wrong = satcheck("view", "report.json", "--asset", "rack.3m", "-o", "out.html", cwd=folder)
    assert (wrong.code, "did you mean 'rack.3mf'" in wrong.err) == (2, True)


def test_of_many_assets_the_worst_opens_and_a_page_is_a_gallery(folder: Path) -> None:
    satcheck("batch", "rack.3mf", "box.obj", "-o", "report.json", "-o", "all.jsonl", cwd=folder)
    env = {"DISPLAY": "", "WAYLAND_DISPLAY": ""}
    for stored in ("report.json", "all.jsonl"):
        opened = satcheck("view", stored, cwd=folder, env=env)
        assert opened.code == 0
        assert "rack.3mf has the worst finding of 2 assets" in opened.err
        page = Path(opened.out.strip())
        assert page_data(page.read_text())["findings"]
        shutil.rmtree(page.parent)
        files = ("-o", "all.html", "-o", "worst.png", "-o", "all.xml")
        assert satcheck("view", stored, *files, cwd=folder).code == 1
        assert "data:image/png" in (folder / "all.html").read_text()
        assert (folder / "worst.png").read_bytes().startswith(b"\x89PNG")
        assert (folder / "all.xml").read_text().count("<testsuite ") == 2
    assert satcheck("view", "report.json", "--format", "table", cwd=folder).out.startswith("asset ")


def test_an_asset_that_cannot_be_read_is_not_drawn_in_place_of_an_overlap(folder: Path) -> None:
    (folder / "broken.glb").write_bytes(b"glTF")
    satcheck("batch", "rack.3mf", "broken.glb", "-o", "all.jsonl", cwd=folder)
    ran = satcheck("view", "all.jsonl", "-o", "worst.png", cwd=folder)
    assert "rack.3mf has the worst finding of 2 assets" in ran.err
    assert "Image of all bodies" not in ran.err
    part = satcheck("view", "all.jsonl", "--asset", "rack", "-o", "worst.png", cwd=folder)
    assert (part.code, "did you mean 'rack.3mf'" in part.err) == (2, True)


@pytest.mark.parametrize("output", [(), ("-o", "out.png")])
def test_files_without_a_result_are_an_error(folder: Path, output: tuple[str, ...]) -> None:
    satcheck(*PUSHED, "-o", "findings.jsonl", cwd=folder)
    ran = satcheck("view", "findings.jsonl", *output, cwd=folder)
    assert (ran.code, ran.out) == (2, "")
    assert "a check stores its report with -o report.json" in ran.err


def test_a_report_is_told_in_other_formats_with_the_code_of_its_check(folder: Path) -> None:
    satcheck(*PUSHED, "-o", "report.json", cwd=folder)
    ran = satcheck("view", "report.json", "--format", "csv", cwd=folder)
    assert (ran.code, ran.out) == (1, satcheck(*PUSHED, "--format", "csv", cwd=folder).out)
    assert satcheck("view", "report.json", "--format", "csv", "--exit-zero", cwd=folder).code == 0


@pytest.mark.parametrize("text", ["{}", "[]", "not JSON", '{"schema": "satcheck.samples/1"}'])
def test_what_is_no_report_is_refused(folder: Path, text: str) -> None:
    (folder / "report.json").write_text(text)
    ran = satcheck("view", "report.json", "-o", "out.html", cwd=folder)
    assert ran.code == 2
    assert "report.json" in ran.err
    assert not (folder / "out.html").exists()


@pytest.mark.parametrize("name", ["out.html", "out.sarif", "out.csv"])
def test_a_report_in_another_format_is_refused_with_the_one_to_store(
    folder: Path, name: str
) -> None:
    satcheck(*PUSHED, "-o", name, cwd=folder)
    ran = satcheck("view", name, cwd=folder)
    assert ran.code == 2
    assert f"{name}: no JSON report: a check writes one with -o report.json" in ran.err


def test_other_endings_are_refused(folder: Path) -> None:
    satcheck(*PUSHED, "-o", "report.json", cwd=folder)
    assert satcheck("view", "report.json", "-o", "out.xlsx", cwd=folder).code == 2


def test_the_named_pose_is_drawn_and_said(tmp_path: Path) -> None:
    arm = ("arm.urdf", "arm.srdf", "--pose", '[{"elbow": 3}, {}, {"shoulder": 2.25}]')
    stored = str(tmp_path / "report.json")
    assert satcheck(*arm, "-o", stored).code == 1
    for pose in ("1", "3"):
        picture = str(tmp_path / "pose.png")
        ran = satcheck("view", stored, "--pose", pose, "-o", picture)
        assert ran.err == f"Image of pose {pose}: {picture}\n"


@pytest.mark.parametrize(
    ("given", "asked", "said"),
    [
        (("--pose", "[{}, {}]"), ("--pose", "1", "--format", "table"), "--pose is for pictures"),
        (("--path", "arm_poses.json"), ("--pose", "1"), "not about several poses"),
        (("--path", "arm_poses.json"), ("--pictures", "shots"), "-o picture.png draws it"),
    ],
)
def test_an_option_that_would_have_no_effect_is_refused(
    tmp_path: Path, given: tuple[str, ...], asked: tuple[str, ...], said: str
) -> None:
    stored = str(tmp_path / "report.json")
    satcheck("arm.urdf", "arm.srdf", *given, "-o", stored)
    ran = satcheck("view", stored, *asked)
    assert ran.code == 2
    assert said in ran.err


@pytest.mark.parametrize("missing", ["a part", "an asset", "all"])
def test_a_stored_report_of_a_batch_that_did_not_finish_passes_no_more_than_its_results(
    folder: Path, missing: str
) -> None:
    satcheck("batch", "box.obj", "l_bracket.obj", "-o", "all.jsonl", cwd=folder)
    results, options = "all.jsonl", list[str]()
    if missing == "a part":
        results = "all.jsonl.part"
        (folder / "all.jsonl").rename(folder / results)
    elif missing == "an asset":
        (folder / "all.txt").write_text("box.obj\nl_bracket.obj\nrack.3mf\n")
        options = ["--manifest", "all.txt"]
    else:
        (folder / "all.jsonl").write_text("")
    assert satcheck("view", results, *options, cwd=folder).code == (2 if missing == "all" else 3)
    assert satcheck("view", results, *options, "-o", "all.json", cwd=folder).code == 3
    said = {
        "table": "INCOMPLETE: ",
        "json": '"verdict": "incomplete"',
        "junit": 'errors="1"',
        "markdown": "**incomplete** ",
        "sarif": '"executionSuccessful": false',
    }
    for form, words in said.items():
        ran = satcheck("view", "all.json", "--format", form, cwd=folder)
        assert (ran.code, words in ran.out) == (3, True), form


def test_where_there_is_no_asset_nothing_is_drawn(folder: Path) -> None:
    (folder / "all.jsonl").write_text("")
    ran = satcheck("view", "all.jsonl", "-o", "worst.png", cwd=folder)
    assert (ran.code, "no asset" in ran.err) == (2, True)


def test_a_warning_that_blocks_no_pass_leaves_a_page_as_it_is(folder: Path) -> None:
    (folder / "unused.toml").write_text(
        'schema = "satcheck.scene/1"\nbodies = []\n'
        '[[rules]]\na = "nobody"\nb = "none"\nclearance = 1\n'
    )
    rules = ("--rules", "unused.toml")
    satcheck("batch", "box.obj", "l_bracket.obj", *rules, "-o", "all.json", cwd=folder)
    ran = satcheck("view", "all.json", cwd=folder)
    assert (ran.code, "unused-rule" in ran.err) == (0, True)
