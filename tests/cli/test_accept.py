"""What nobody reads blocks a pass, until it is accepted by name."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from msgspec import convert

from satcheck.audit.acceptance import words_to_accept
from satcheck.report.report import Issue
from tests.cli.process import SAMPLES, satcheck
from tests.scene import files

ROBOT = """<robot name="r">
<link name="a"><collision><geometry><box size="1 1 1"/></geometry></collision><fence/></link>
<link name="b"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
<joint name="j" type="fixed"><parent link="a"/><child link="b"/><origin xyz="3 0 0"/></joint>
</robot>"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "r.urdf").write_text(ROBOT, encoding="utf-8")
    return tmp_path


def code_of(folder: Path) -> str:
    (issue,) = (
        issue
        for issue in satcheck("r.urdf", "--format", "json", cwd=folder).document["issues"]
        if issue["state"] == "blocking"
    )
    return str(issue["code"])


def test_what_is_not_read_blocks_a_pass_and_the_words_to_accept_it_are_told(robot: Path) -> None:
    ran = satcheck("r.urdf", cwd=robot)
    assert ran.code == 3
    assert f"Next: --accept {code_of(robot)}:r.urdf" in ran.out


@pytest.mark.parametrize("name", ["", ":r.urdf", ":*.urdf"])
def test_it_is_accepted_by_its_code_and_name(robot: Path, name: str) -> None:
    ran = satcheck("r.urdf", "--accept", code_of(robot) + name, cwd=robot)
    assert ran.code == 0
    assert "1 issue accepted" in ran.out


def test_another_name_accepts_nothing_and_is_named(robot: Path) -> None:
    text = f"{code_of(robot)}:other.urdf"
    ran = satcheck("r.urdf", "--accept", text, cwd=robot)
    assert ran.code == 3
    assert f'nothing is accepted by "{text}"' in ran.out


def test_rules_and_the_config_accept_too(robot: Path) -> None:
    code = code_of(robot)
    rules = f'accept = ["{code}"]\n[[rules]]\na = "a"\nb = "b"\nclearance = 0.1\n'
    (robot / "rules.toml").write_text(rules, encoding="utf-8")
    assert satcheck("r.urdf", "--rules", "rules.toml", cwd=robot).code == 0
    (robot / "satcheck.toml").write_text(f'accept = ["{code}"]\n', encoding="utf-8")
    assert satcheck("r.urdf", cwd=robot).code == 0
    assert satcheck("batch", "r.urdf", cwd=robot).code == 0


def test_a_scene_accepts_for_the_files_that_it_names_alone(robot: Path) -> None:
    tree, buffer = files.gltf_document()
    tree["extensionsUsed"] = ["NEW_bodies"]
    for name in ("own.glb", "other.glb"):
        (robot / name).write_bytes(files.glb(tree, buffer))
    scene = 'schema = "satcheck.scene/1"\nunits = "m"\naccept = ["unread"]\n'
    for x in (5, 9):
        scene += f'[[bodies]]\nid = "own{x}"\nmesh = "own.glb"\nposition = [{x}, 0, 0]\n'
    (robot / "scene.toml").write_text(scene, encoding="utf-8")

    def ran(*names: str) -> list[tuple[str, str]]:
        issues = satcheck(*names, "--format", "json", cwd=robot).document["issues"]
        return [(issue["file"], issue["state"]) for issue in issues if issue["code"] == "unread"]

    assert ran("scene.toml") == [("own.glb", "accepted")]
    assert ran("scene.toml", "other.glb") == [
        ("own.glb", "accepted"), ("other.glb", "blocking")
    ]  # fmt: skip


def test_an_acceptance_need_not_be_about_every_asset(robot: Path) -> None:
    shutil.copy(SAMPLES / "box.obj", robot)
    ran = satcheck("batch", ".", "--accept", f"{code_of(robot)}:r.urdf", cwd=robot)
    assert ran.code == 0
    assert "nothing is accepted" not in ran.out + ran.err
    ran = satcheck("batch", ".", "--accept", "unread:gone.urdf", cwd=robot)
    assert ran.code == 3
    assert 'nothing is accepted by "unread:gone.urdf"' in ran.out + ran.err
    assert "Next: satcheck r.urdf" in ran.out


def test_rules_that_allow_every_pair_do_not_hide_what_is_not_read(tmp_path: Path) -> None:
    """A collection of nodes with an extension that nobody reads."""
    shutil.copy(SAMPLES / "gripper.glb", tmp_path)
    data = (tmp_path / "gripper.glb").read_bytes()
    length = int.from_bytes(data[12:16], "little")
    document = json.loads(data[20 : 20 + length])
    rules = '[[rules]]\na = "*"\nb = "*"\nallowed = true\nreason = "glued"\n'
    (tmp_path / "rules.toml").write_text(rules, encoding="utf-8")
    asked = ("batch", "gripper.glb", "--rules", "rules.toml")
    assert satcheck(*asked, cwd=tmp_path).code == 0
    text = json.dumps(document | {"extensionsUsed": ["NEW_bodies"]}).encode()
    text += b" " * (-len(text) % 4)
    chunks = len(text).to_bytes(4, "little") + b"JSON" + text + data[20 + length :]
    size = (12 + len(chunks)).to_bytes(4, "little")
    (tmp_path / "gripper.glb").write_bytes(data[:8] + size + chunks)
    assert satcheck(*asked, cwd=tmp_path).code == 3


@pytest.mark.parametrize("command", [(), ("batch",)])
def test_an_error_is_not_accepted(robot: Path, command: tuple[str, ...]) -> None:
    ran = satcheck(*command, "r.urdf", "--accept", "misspelt", cwd=robot)
    assert (ran.code, ran.out) == (2, "")
    assert "mend the file" in ran.err


def test_a_code_that_blocks_nothing_is_refused(robot: Path) -> None:
    ran = satcheck("r.urdf", "--accept", "unraed", cwd=robot)
    assert ran.code == 2
    assert "did you mean 'unread'" in ran.err


def test_a_name_without_a_code_is_told_where_it_goes(robot: Path) -> None:
    ran = satcheck("batch", "r.urdf", "--accept", "statue.fbx", cwd=robot)
    assert ran.code == 2
    assert "A name follows a code: unread-file:statue.fbx" in ran.err


def test_no_name_is_no_name_of_everything(robot: Path) -> None:
    ran = satcheck("r.urdf", "--accept", "unread:", cwd=robot)
    assert ran.code == 2
    assert "names no file and no body" in ran.err


@pytest.mark.parametrize("name", ["d[1].urdf", "*.urdf"])
def test_the_words_to_accept_mean_the_file_and_no_other(robot: Path, name: str) -> None:
    (robot / "r.urdf").rename(robot / name)
    (robot / "d1.urdf").write_text(ROBOT, encoding="utf-8")
    (issue,) = (
        issue
        for issue in satcheck(name, "--format", "json", cwd=robot).document["issues"]
        if issue["state"] == "blocking"
    )
    words = words_to_accept(convert(issue, Issue)).split()
    assert satcheck(name, *words, cwd=robot).code == 0
    assert satcheck("d1.urdf", *words, cwd=robot).code == 3
