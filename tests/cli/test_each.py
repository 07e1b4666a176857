"""`satcheck each`: the assets of a folder, each a scene of its own."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from junitparser import JUnitXml

from satcheck.cli.report.schema import text
from tests.cli.process import SAMPLES, satcheck


@pytest.fixture
def assets(tmp_path: Path) -> Path:
    """A folder with one failing scene, one mesh, one file that is none, one hidden file."""
    folder = tmp_path / "assets"
    (folder / "props").mkdir(parents=True)
    (folder / ".cache").mkdir()
    shutil.copy(SAMPLES / "gripper.glb", folder)
    shutil.copy(SAMPLES / "box.obj", folder / "props")
    shutil.copy(SAMPLES / "box.obj", folder / ".cache")
    (folder / "package.json").write_text("{}")
    return folder


def verdicts(ran_out: str) -> dict[str, str]:
    document = json.loads(ran_out)
    Draft202012Validator(json.loads(text("assets"))).validate(document)
    return {Path(asset["file"]).name: asset["verdict"] for asset in document["assets"]}


def test_each_asset_of_a_folder_is_its_own_scene(assets: Path) -> None:
    ran = satcheck("each", str(assets), "--format", "json")
    assert ran.code == 1
    assert verdicts(ran.out) == {"gripper.glb": "fail", "box.obj": "pass"}


def test_an_unreadable_asset_leaves_the_others_their_answers(assets: Path) -> None:
    (assets / "broken.obj").write_text("f 1 2 3\n")
    (assets / "wrong.toml").write_text('format = "satcheck.scene/1"\nnonsense = 1\n')
    ran = satcheck("each", str(assets), "--format", "json")
    assert ran.code == 2
    assert verdicts(ran.out) == {
        "gripper.glb": "fail", "box.obj": "pass", "broken.obj": "error", "wrong.toml": "error"
    }  # fmt: skip


def test_patterns_and_names_from_standard_input(assets: Path) -> None:
    pattern = satcheck("each", f"{assets}/**/*.obj", "--format", "json")
    assert verdicts(pattern.out) == {"box.obj": "pass"}
    named = satcheck("each", "-", "--format", "json", stdin=f"{assets}/gripper.glb\n")
    assert verdicts(named.out) == {"gripper.glb": "fail"}


@pytest.mark.parametrize("name", ["empty", "*.glb"])
def test_nothing_to_check_is_an_error(name: str, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    ran = satcheck("each", name, cwd=tmp_path)
    assert ran.code == 2
    assert "no mesh, scene or robot is there" in ran.err


def test_junit_has_a_suite_for_each_asset(assets: Path) -> None:
    document = JUnitXml.fromstring(satcheck("each", str(assets), "--format", "junit").out.encode())
    suites = {Path(suite.name).name: (suite.tests, suite.failures) for suite in document}
    assert suites == {"gripper.glb": (6, 1), "box.obj": (1, 0)}


def test_the_table_ends_with_the_verdict(assets: Path) -> None:
    ran = satcheck("each", str(assets))
    assert ran.out.splitlines()[-1] == "FAIL: 2 assets: 1 fails, 1 passes."


def git(folder: Path, *arguments: str) -> None:
    identity = ("-c", "user.name=a", "-c", "user.email=a@b.c")
    subprocess.run(("git", *identity, *arguments), cwd=folder, check=True, capture_output=True)


def test_changed_since_a_revision(assets: Path) -> None:
    """A scene has changed when a mesh that it names has."""
    shutil.copy(SAMPLES / "ring.glb", assets / "ring.glb")
    (assets / "scene.toml").write_text(
        'schema = "satcheck.scene/1"\n'
        + "".join(
            f'[[bodies]]\nid = "{name}"\nmesh = "props/box.obj"\nposition = [{x}, 0, 0]\n'
            for name, x in (("a", 0), ("b", 10))
        )
    )
    git(assets, "init", "-q")
    git(assets, "add", ".")
    git(assets, "commit", "-q", "-m", "first")
    arguments = ("each", str(assets), "--changed-since", "HEAD", "--format", "json")
    unchanged = satcheck(*arguments)
    assert (unchanged.code, unchanged.out) == (0, "")
    with (assets / "props" / "box.obj").open("a") as file:
        file.write("# changed\n")
    shutil.copy(SAMPLES / "cube.off", assets / "new.off")
    assert verdicts(satcheck(*arguments).out) == {
        "box.obj": "pass", "new.off": "pass", "scene.toml": "pass"
    }  # fmt: skip


def test_an_unknown_revision_is_an_error(assets: Path) -> None:
    git(assets, "init", "-q")
    ran = satcheck("each", str(assets), "--changed-since", "nowhere")
    assert ran.code == 2
    assert "nowhere" in ran.err
