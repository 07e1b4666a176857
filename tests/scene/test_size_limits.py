"""One rule for the size of what is opened, whoever names it: a share of the memory for reading one
file, known before a byte is read."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import Refused, load_scene
from satcheck.scene.access import NOTHING_ELSE, Context, Permitted
from satcheck.scene.opening import read_whole
from satcheck.scene.robot import read_poses
from tests.plugin_marks import needs
from tests.scene import files
from tests.scene.loading import refusal
from tests.scene.test_permitted import FORMATS, USD

MEBIBYTE = 1 << 20
ADVICE = "raise it with --limit megabytes=N"
INCLUDE = '<sdf version="1.9"><include><uri>inner.sdf</uri></include></sdf>'


def grown(path: Path, mebibytes: int) -> Path:
    """The file with a hole at its end, which takes no room on the disk."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("ab") as file:
        file.truncate(mebibytes * MEBIBYTE)
    return path


def refused(*paths: Path, **options: int) -> Refused:
    with pytest.raises(Refused) as caught:
        load_scene(paths, **options)
    assert caught.value.code == "too-large"
    assert ADVICE in caught.value.message
    return caught.value


@pytest.mark.parametrize("named_by", FORMATS)
def test_a_file_that_another_file_names(tmp_path, named_by):
    for name in ("a.bin", "a.usda", "a.obj"):
        grown(tmp_path / "parts" / name, 513)
    scene = load_scene([named_by(tmp_path, "parts")])
    (issue,) = (each for each in scene.issues if each.severity == "error")
    assert issue.code == "too-large"
    assert f"exceed the limit of {512 * MEBIBYTE} bytes" in issue.message
    assert ADVICE in issue.message


def test_a_scene_may_have_a_quarter_of_the_memory_for_a_file(tmp_path):
    (tmp_path / "a.obj").write_bytes(files.obj())
    scene = tmp_path / "a.json"
    document = {"schema": "satcheck.scene/1", "bodies": [{"id": "a", "mesh": "a.obj"}]}
    scene.write_text(json.dumps(document).ljust(2 * MEBIBYTE))
    assert len(load_scene([scene], megabytes_per_file=8).bodies) == 1
    assert "a.json" in str(refused(scene, megabytes_per_file=4))


def test_xml_that_becomes_a_tree_may_have_a_32nd(tmp_path):
    robot, rules = tmp_path / "r.urdf", tmp_path / "r.srdf"
    robot.write_text('<robot name="r"><link name="l"/></robot>')
    rules.write_text('<robot name="r"></robot>'.ljust(2 * MEBIBYTE))
    load_scene([robot, rules], megabytes_per_file=64)
    assert "a 32nd of the memory" in refused(robot, rules, megabytes_per_file=63).message
    robot.write_text('<robot name="r"><link name="l"/></robot>'.ljust(2 * MEBIBYTE))
    load_scene([robot], megabytes_per_file=64)
    assert "a 32nd of the memory" in refused(robot, megabytes_per_file=63).message


def test_a_file_that_is_included(tmp_path):
    grown(tmp_path / "inner.sdf", 65)
    (tmp_path / "a.sdf").write_text(INCLUDE)
    (issue,) = load_scene([tmp_path / "a.sdf"]).issues
    assert issue.code == "too-large"
    assert ADVICE in issue.message


def test_a_manifest_that_is_too_large_names_no_package(tmp_path):
    manifest = "<package><name>p</name></package>"
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "package.xml").write_text(manifest.ljust(2 * MEBIBYTE))
    (tmp_path / "other" / "a.obj").write_bytes(files.obj())
    mesh = '<collision><geometry><mesh filename="package://p/a.obj"/></geometry></collision>'
    path = tmp_path / "urdf" / "a.urdf"
    path.parent.mkdir()
    path.write_text(f'<robot name="r"><link name="l">{mesh}</link></robot>')
    assert load_scene([path], megabytes_per_file=64).bodies
    (issue,) = load_scene([path], megabytes_per_file=63).issues
    assert issue.code == "missing-resource"


def test_a_file_that_grows_after_its_size_was_looked_up(tmp_path, monkeypatch):
    monkeypatch.setattr("satcheck.scene.opening.size_of", lambda _: 0)
    path = grown(tmp_path / "a.txt", 2)
    with pytest.raises(Refused, match=ADVICE):
        read_whole(path, Permitted(megabytes=4).most)


def test_a_named_file_is_opened_with_its_size(tmp_path):
    (tmp_path / "a.bin").write_bytes(b"12345")
    with Context(tmp_path, NOTHING_ELSE).open("buffer file", "a.bin") as (file, size):
        assert (file.read(), size) == (b"12345", 5)


def test_zeros_that_no_file_holds_count_like_a_file(tmp_path):
    """Two accessors together, of which each might be."""
    document, binary = files.gltf_document()
    zeros = {"componentType": 5126, "type": "VEC3", "count": 90_000}
    sparse = {
        "count": 0,
        "indices": {"bufferView": 0, "componentType": 5121},
        "values": {"bufferView": 0},
    }
    for number in (0, 1):
        document["accessors"].append({**zeros, "sparse": sparse})
        primitive = {"attributes": {"POSITION": len(document["accessors"]) - 1}}
        document["meshes"].append({"name": f"m{number}", "primitives": [primitive]})
        document["nodes"].append({"mesh": len(document["meshes"]) - 1})
        document["scenes"][0]["nodes"].append(len(document["nodes"]) - 1)
    (tmp_path / "a.glb").write_bytes(files.glb(document, binary))
    codes = [each.code for each in load_scene([tmp_path / "a.glb"], megabytes_per_file=6).issues]
    assert codes.count("too-large") == 1


def test_a_list_of_poses_says_what_to_do(tmp_path):
    path = grown(tmp_path / "q.json", 1025)
    with pytest.raises(SatcheckError, match="write less") as caught:
        read_poses(str(path))
    assert caught.value.code == "too-large"


@needs("usd")
@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in this file system")
def test_a_pipe_is_no_layer(tmp_path):
    os.mkfifo(tmp_path / "b.usda")
    text = f'{USD}def "A" (references = @b.usda@) {{}}\n'
    code, message = refusal(tmp_path, "a.usda", text.encode())
    assert code == "not-a-file"
    assert "b.usda" in message
