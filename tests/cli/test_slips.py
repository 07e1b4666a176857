"""Typical slips: each is answered with a command that works when it is copied."""

from __future__ import annotations

import shlex
import shutil
from pathlib import Path

import pytest

from tests.cli.process import SAMPLES, satcheck
from tests.plugin_marks import needs

MESHES = ("box.obj", "box_flush.stl", "box_pushed.stl", "cube.off", "ring.glb")
NOTHING_CHECKED = "ERROR: no pair could be checked: {} input{} could not be used.\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in MESHES:
        shutil.copy(SAMPLES / name, tmp_path / name)
    parts = tmp_path / "my parts"
    parts.mkdir()
    for name in ("box.obj", "kettle.obj"):
        shutil.copy(SAMPLES / name, parts / name)
    level = tmp_path / "level"
    level.mkdir()
    shutil.copy(SAMPLES / "cube.off", level / "cube.off")
    return tmp_path


def expanded(command: str, folder: Path) -> list[str]:
    """As a POSIX shell does it: a pattern that is not quoted stands for files."""
    words = []
    for word in shlex.split(command):
        is_quoted = shlex.quote(word) in command
        matches = [] if is_quoted else sorted(folder.glob(word))
        words += [str(path.relative_to(folder)) for path in matches] or [word]
    return words


@pytest.mark.parametrize(
    ("typed", "instead"),
    [
        (["my parts"], ["batch 'my parts'", "'my parts'/*.obj"]),
        (
            ["--clearance", "2", "."],
            ["batch --clearance 2 .", "--clearance 2 *.glb *.obj *.off *.stl"],
        ),
        (["my parts/box.obj", "my parts"], ["batch 'my parts'", "'my parts'/*.obj"]),
        (["box.obj"], ["batch box.obj", "box.obj box_flush.stl"]),
        (["check", "box.obj", "cube.off"], ["box.obj cube.off"]),
        (["help"], ["--help"]),
        (["help", "resolve"], ["resolve --help"]),
        (["--json", "box.obj", "cube.off"], ["--format json box.obj cube.off"]),
        (["box.obj", "cube.off", "--html"], ["box.obj cube.off -o report.html"]),
        (["box.obj", "cube.off", "--csv", "a.csv"], ["box.obj cube.off -o a.csv"]),
        (["box.obj", "cube.off", "--picture=a.png"], ["box.obj cube.off -o a.png"]),
        (["box.obj", "cube.off", "--image"], ["box.obj cube.off -o picture.png"]),
        (["box.obj", "--max-overlap", "1", "cube.off"], ["box.obj --max-thickness 1 cube.off"]),
        (["box.obj", "cube.off", "--output-format", "json"], ["box.obj cube.off --format json"]),
        (["level", "my parts"], ["batch level 'my parts'"]),
        (["bach", "my parts"], ["batch 'my parts'"]),
        (["box.obj", "cube.off", "--formt=json"], ["box.obj cube.off --format json"]),
        pytest.param(
            ["box.obj", "--time", "3", "cube.off"],
            ["box.obj --read time=3 cube.off"],
            marks=needs("usd"),
        ),
        pytest.param(
            ["box.obj", "--mesh-hulls", "cube.off"],
            ["box.obj --read mesh-hulls=true cube.off"],
            marks=needs("mjcf"),
        ),
        (["batch", "level", "--sample", "5"], []),
        (["box.obj", "--exclude", "a*", "cube.off"], ["batch box.obj --exclude 'a*' cube.off"]),
        (["box.obj", "cube.off", "--pin", "box"], ["resolve box.obj cube.off --pin box"]),
        (["*.glb"], ["ring.glb", "batch '*.glb'"]),
        (["*.stl"], ["box_flush.stl box_pushed.stl", "batch '*.stl'"]),
        (["*.dae"], ["*.glb *.obj *.off *.stl"]),
        (["box", "Cube.off"], ["box.obj cube.off"]),
        (["box.obj", "boxflush.stl", "gone.ply"], ["box.obj box_flush.stl gone.ply"]),
        (["box.obj", "box.obj"], ["--split components box.obj"]),
        (["resolve", "--pin", "box", "my parts"], ["resolve --pin box 'my parts'/*.obj"]),
    ],
)
def test_a_slip_is_answered_with_a_command(
    typed: list[str], instead: list[str], folder: Path
) -> None:
    ran = satcheck(*typed, cwd=folder)
    assert "Traceback" not in ran.err
    advised = [line.strip() for line in ran.err.splitlines() if line.startswith("  satcheck ")]
    assert advised == [f"satcheck {words}" for words in instead]
    if typed != ["box.obj", "box.obj"]:
        assert ran.code == 2
        assert ran.out in ("", NOTHING_CHECKED.format(1, ""), NOTHING_CHECKED.format(2, "s"))


@pytest.mark.parametrize(
    "typed",
    [
        ["my parts"],
        ["level", "my parts"],
        ["bach", "my parts"],
        ["box.obj"],
        ["--json", "box.obj", "cube.off"],
        ["*.stl"],
        ["*.dae"],
    ],
)
def test_what_is_advised_works(typed: list[str], folder: Path) -> None:
    said = satcheck(*typed, cwd=folder).err
    for line in said.splitlines():
        if line.startswith("  satcheck "):
            _, *words = expanded(line.strip(), folder)
            ran = satcheck(*words, cwd=folder)
            assert ran.code in (0, 1, 3), (line, ran.err)


def test_a_misspelt_command_is_one_error(folder: Path) -> None:
    said = satcheck("bacth", ".", cwd=folder).err
    assert said.count("error:") == 1
    assert said.startswith("satcheck: error: there is no command bacth\n")


def test_a_length_has_no_space(folder: Path) -> None:
    ran = satcheck("--clearance", "2", "mm", "box.obj", "cube.off", cwd=folder)
    assert ran.code == 2
    assert ran.err.endswith("no space:\n  satcheck --clearance 2mm box.obj cube.off\n")


def test_of_a_known_slip_no_other_option_is_proposed(folder: Path) -> None:
    said = satcheck("box.obj", "cube.off", "--html", cwd=folder).err
    assert "No such option '--html'.\n" in said
    assert "--help'?" not in said


def test_an_option_of_other_commands_says_whose_it_is(folder: Path) -> None:
    said = satcheck("batch", "--pose", "x.json", ".", cwd=folder).err
    assert "--pose is an option of satcheck A B, satcheck axes, satcheck resolve, " in said
    assert "--jobs" not in said
    said = satcheck("--pin", "a", "box.obj", "cube.off", cwd=folder).err
    assert said.endswith("of satcheck resolve:\n  satcheck resolve --pin a box.obj cube.off\n")


def test_a_file_named_like_a_word_of_other_programs_can_be_checked(folder: Path) -> None:
    shutil.copy(SAMPLES / "box.obj", folder / "check.obj")
    assert satcheck("check.obj", "cube.off", cwd=folder).code == 0


def test_an_error_names_a_file_once(folder: Path) -> None:
    said = satcheck("my parts/*.obj", cwd=folder).err
    assert said.startswith("satcheck: error: my parts/*.obj: no such file [file-not-found]\n")


def test_a_report_is_no_mesh(folder: Path) -> None:
    ran = satcheck("box.obj", "cube.off", "-o", "x.stl", cwd=folder)
    assert ran.code == 2
    assert not (folder / "x.stl").exists()
    assert "x.stl: this command writes" in ran.err


def test_files_that_stand_around_the_origin_may_be_assets(tmp_path: Path) -> None:
    """Parts of an assembly do not: they stand beside each other."""
    assets = tmp_path / "my props"
    assets.mkdir()
    for name in ("box.obj", "cube.off", "kettle.obj", "l_bracket.obj"):
        shutil.copy(SAMPLES / name, assets / name)
    names = [f"my props/{path.name}" for path in sorted(assets.iterdir())]
    first, second, *_ = satcheck("--no-depth", *names, cwd=tmp_path).err.splitlines()
    assert "files lie around the origin. If each file is an asset of its own:" in first
    assert second == "  satcheck batch 'my props'"
    for k in range(3):
        shutil.copy(SAMPLES / "box.obj", assets / f"box{k}.obj")
    names = [f"my props/{path.name}" for path in sorted(assets.iterdir())]
    last = satcheck("--no-depth", *names, cwd=tmp_path).out.splitlines()[-1]
    assert last.startswith("Next: satcheck batch checks each file by itself")
    for k in range(2):
        (assets / f"more{k}").mkdir()
    names = [f"my props/{path.name}" for path in sorted(assets.iterdir())]
    told = satcheck("--no-depth", *names, cwd=tmp_path).err
    assert "in the folders by itself:\n  satcheck batch 'my props'\n" in told
    names = names[:4]
    assert satcheck("--no-depth", *names[:3], cwd=tmp_path).err == ""
    for k in range(4):
        far = f"v {100 * k} 0 0\nv {100 * k + 1} 0 0\nv {100 * k} 1 0\nf 1 2 3\n"
        (tmp_path / f"part{k}.obj").write_text(far)
    assert satcheck(*(f"part{k}.obj" for k in range(4)), cwd=tmp_path).err == ""
