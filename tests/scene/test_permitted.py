"""The files that a file may name: in its own folder, and in a given folder that it lies in."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import Refused, Scene, load_scene
from satcheck.scene.access import NOTHING_ELSE, Context, Permitted
from tests.plugin_marks import needs
from tests.scene import files
from tests.scene.hostile import needs_links

NEAR = "../../parts"  # from where the files of these tests lie: not even the package of a robot
USD = '#usda 1.0\n(\n defaultPrim = "A"\n metersPerUnit = 1\n upAxis = "Z"\n)\n'


def _gltf(folder: Path, parts: str) -> Path:
    document, _ = files.gltf_document()
    document["buffers"][0]["uri"] = f"{parts}/a.bin"
    return _written(folder / "a.gltf", json.dumps(document))


def _usd(folder: Path, parts: str) -> Path:
    reference = f'def "A" (references = @{parts}/a.usda@) {{}}\n'
    return _written(folder / "a.usda", USD + reference)


def _urdf(folder: Path, parts: str) -> Path:
    mesh = f'<collision><geometry><mesh filename="{parts}/a.obj"/></geometry></collision>'
    return _written(folder / "a.urdf", f'<robot name="r"><link name="l">{mesh}</link></robot>')


def _sdf(folder: Path, parts: str) -> Path:
    mesh = f"<geometry><mesh><uri>{parts}/a.obj</uri></mesh></geometry>"
    link = f'<link name="l"><collision name="c">{mesh}</collision></link>'
    return _written(folder / "a.sdf", f'<sdf version="1.9"><model name="m">{link}</model></sdf>')


def _mjcf(folder: Path, parts: str) -> Path:
    pytest.importorskip("mujoco")
    body = '<body><geom type="mesh" mesh="a"/></body>'
    asset = f'<asset><mesh name="a" file="{parts}/a.obj"/></asset>'
    return _written(folder / "a.xml", f"<mujoco>{asset}<worldbody>{body}</worldbody></mujoco>")


def _scene(folder: Path, parts: str) -> Path:
    bodies = [{"id": "a", "mesh": f"{parts}/a.obj"}]
    document = {"schema": "satcheck.scene/1", "bodies": bodies}
    return _written(folder / "a.json", json.dumps(document))


FORMATS = [
    _gltf,
    pytest.param(_usd, marks=needs("usd")),
    _urdf,
    pytest.param(_sdf, marks=needs("sdf")),
    pytest.param(_mjcf, marks=needs("mjcf")),
    _scene,
]
Format = Callable[[Path, str], Path]


def _written(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


@pytest.fixture
def kit(tmp_path: Path) -> Path:
    """A folder with parts, and the folder of the files that name them."""
    kit = tmp_path / "kit"
    (kit / "sets" / "small").mkdir(parents=True)
    parts = kit / "parts"
    parts.mkdir()
    (parts / "a.obj").write_bytes(files.obj())
    (parts / "a.bin").write_bytes(files.gltf_document()[1])
    (parts / "a.usda").write_text(USD + 'def Cube "A" {}\n')
    return kit


def code(path: Path, *folders: Path, anywhere: bool = False) -> tuple[str, str]:
    """The first error, and its message; "": there is none."""
    try:
        scene: Scene = load_scene([path], folders=folders, allow_outside=anywhere)
    except SatcheckError as error:
        return error.code, error.message
    errors = [issue for issue in scene.issues if issue.severity == "error"]
    assert errors or len(scene.bodies) == 1
    return (errors[0].code, errors[0].message) if errors else ("", "")


@pytest.mark.parametrize("make", FORMATS)
def test_a_file_may_name_what_lies_in_the_given_folder(make: Format, kit: Path) -> None:
    path = make(kit / "sets" / "small", NEAR)
    assert code(path, kit) == ("", "")
    assert code(path, kit.parent / "kit" / "parts" / "..") == ("", "")
    for folders in ([], [kit / "sets"], [kit / "parts"]):
        found, message = code(path, *folders)
        assert found == "outside-path"
        assert "--allow-outside" in message
    assert code(path, anywhere=True) == ("", "")


@pytest.mark.parametrize("make", FORMATS)
def test_what_lies_outside_of_the_given_folder_is_refused(make: Format, kit: Path) -> None:
    shutil.move(kit / "parts", kit.parent / "parts")
    path = make(kit / "sets" / "small", f"../{NEAR}")
    found, message = code(path, kit)
    assert found == "outside-path"
    assert "--allow-outside" in message
    assert str(kit) in message


@needs_links
@pytest.mark.parametrize("make", FORMATS)
def test_a_link_that_leaves_the_given_folder_lies_outside(make: Format, kit: Path) -> None:
    shutil.move(kit / "parts", kit.parent / "parts")
    (kit / "parts").symlink_to(kit.parent / "parts")
    assert code(make(kit / "sets" / "small", NEAR), kit)[0] == "outside-path"


@needs_links
def test_a_given_folder_may_be_a_link(kit: Path) -> None:
    link = kit.parent / "link"
    link.symlink_to(kit)
    _gltf(kit / "sets" / "small", NEAR)
    assert code(link / "sets" / "small" / "a.gltf", link) == ("", "")


@needs("usd")
def test_no_text_of_a_file_outside_is_printed(kit: Path) -> None:
    (kit.parent / "secret.usda").write_text("#usda 1.0\npassword = 1234\n")
    path = kit / "sets" / "small" / "a.usda"
    path.write_text(USD + 'def Xform "A" (references = @../../../secret.usda@) {}\n')
    found, message = code(path, kit)
    assert found == "outside-path"
    assert "password" not in message


def test_only_folders_around_the_files_count(tmp_path: Path) -> None:
    """So that no answer depends on what else is checked in the same call."""
    mine, other = tmp_path / "mine", tmp_path / "other"
    around = Permitted.around([mine / "sub" / "a.usda"], [mine, other])
    assert around == Permitted((str(mine),))
    context = Context(mine / "sub", around)
    assert not context.permits(other / "a.usda")
    assert context.permits(mine / "b.usda")


def test_a_name_that_no_system_takes_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Refused, match="NUL") as caught:
        Context(tmp_path, NOTHING_ELSE).find("buffer file", "a\0.bin")
    assert caught.value.code == "bad-record"


@needs_links
def test_a_link_to_a_file_outside_beside_files_that_lie_inside(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "secret.bin").write_bytes(b"1")
    (tmp_path / "in" / "a.bin").write_bytes(b"1")
    (tmp_path / "in" / "b.bin").symlink_to(tmp_path / "secret.bin")
    (tmp_path / "in" / "c.bin").symlink_to(tmp_path / "in" / "a.bin")
    context = Context(tmp_path / "in", NOTHING_ELSE)
    assert context.find("a", "a.bin") == str(tmp_path / "in" / "a.bin")
    assert context.permits(tmp_path / "in" / "c.bin")
    for name in ("b.bin", "../secret.bin", "../in/../secret.bin"):
        with pytest.raises(Refused) as caught:
            context.find("it", name)
        assert caught.value.code == "outside-path"
