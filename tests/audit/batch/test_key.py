"""What a result depends on: a change of any of it, and of nothing else, calls for a new check."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable, Generator, Iterable, Sequence
from pathlib import Path
from typing import Any

import pytest

from satcheck.audit.batch import slot_server
from satcheck.audit.batch.key import digest, inputs_of
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.results import ResultsFile
from satcheck.audit.batch.run import run
from satcheck.audit.batch.slot_server import (
    Answer,
    Job,
    Wanted,
    answer_in,
    request_of,
    serve,
    text_of,
)
from satcheck.report.assets import InputFile
from satcheck.scene import mesh_files
from satcheck.scene.files.reading_children import ReadingChildren
from satcheck.scene.mesh_files import KnownMeshes
from tests.cli.process import SAMPLES, on_posix
from tests.plugin_marks import needs


@pytest.fixture(autouse=True)
def _no_ros(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    monkeypatch.chdir(tmp_path)


def checked(worlds: Sequence[World], options: CheckOptions | None = None) -> list[World]:
    """The worlds that a resumed run checks again, here and in no other process."""
    options = options or CheckOptions()
    done: list[World] = []

    def engine(waiting: Sequence[World]) -> Generator[list[Answer]]:
        done.extend(waiting)
        terms = text_of((options, Limits(), Wanted()))
        yield [answer_in(serve(request_of(Job(each), terms)), each) for each in waiting]

    with ResultsFile(Path("results.jsonl")) as results:
        run(worlds, options, Limits(), engine, results, lambda _: None)
    return done


def answer(world: World) -> Any:
    lines = map(json.loads, Path("results.jsonl").read_text().splitlines())
    return next(line["report"] for line in lines if tuple(line["files"]) == world)


def key_in(world: World, wanted: Wanted) -> str | None:
    terms = text_of((CheckOptions(), Limits(), wanted))
    line = answer_in(serve(request_of(Job(world), terms)), world).line
    key: str | None = json.loads(line)["key"]
    return key


def scene(name: str, *meshes: str) -> World:
    bodies = "".join(f'[[bodies]]\nid = "{mesh}"\nmesh = "{mesh}"\n' for mesh in meshes)
    Path(name).write_text(f'schema = "satcheck.scene/1"\n{bodies}')
    return (name,)


def copied(name: str, to: str | None = None) -> str:
    place = Path(to or name)
    place.parent.mkdir(exist_ok=True)
    shutil.copy(SAMPLES / name, place)
    return place.as_posix()


def _other_scene() -> World:
    return scene("other.toml", copied("cube.off"), copied("rod.stl"))


Change = Callable[[], object]


def a_mesh() -> tuple[World, Change]:
    return scene("s.toml", copied("box.obj")), lambda: copied("kettle.obj", "box.obj")


def a_mesh_that_goes() -> tuple[World, Change]:
    return scene("s.toml", copied("box.obj")), Path("box.obj").unlink


def a_mesh_that_comes() -> tuple[World, Change]:
    return scene("s.toml", "box.obj"), lambda: copied("box.obj")


def the_scene_file() -> tuple[World, Change]:
    return scene("s.toml", copied("box.obj")), lambda: scene("s.toml")


def the_second_file_of_a_world() -> tuple[World, Change]:
    world = (copied("box.obj"), copied("box_pushed.stl"))
    return world, lambda: copied("rod.stl", "box_pushed.stl")


def an_input_that_comes() -> tuple[World, Change]:
    return ("late.stl",), lambda: copied("rod.stl", "late.stl")


def a_file_that_a_child_reads() -> tuple[World, Change]:
    return scene("s.toml", copied("rack.3mf")), lambda: Path("rack.3mf").write_bytes(b"")


def a_pipe_in_the_place_of_a_mesh() -> tuple[World, Change]:
    os.mkfifo("pipe.stl")
    return ("pipe.stl",), Path("pipe.stl").unlink


def _gltf(buffer: str, *, packed: bool) -> World:
    """A triangle. packed: an extension that only a child process reads."""
    corners = Path(SAMPLES / "link_b.glb").read_bytes()[:36]
    Path(buffer).write_bytes(corners)
    primitive: dict[str, object] = {"attributes": {"POSITION": 0}}
    if packed:
        primitive["extensions"] = {
            "KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}
        }
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": buffer, "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [primitive]}],
        "nodes": [{"mesh": 0}],
    }
    Path("tri.gltf").write_text(json.dumps(document))
    return ("tri.gltf",)


def a_buffer_of_gltf() -> tuple[World, Change]:
    return _gltf("tri.bin", packed=False), Path("tri.bin").unlink


def a_buffer_of_gltf_that_a_child_reads() -> tuple[World, Change]:
    return _gltf("tri.bin", packed=True), lambda: Path("tri.bin").write_bytes(bytes(36))


def _robot(uri: str) -> World:
    Path("arm").mkdir(exist_ok=True)
    Path("arm/arm.urdf").write_text(
        f'<robot name="r"><link name="l"><collision><geometry><mesh filename="{uri}"/>'
        "</geometry></collision></link></robot>"
    )
    return ("arm/arm.urdf",)


def a_mesh_of_a_robot() -> tuple[World, Change]:
    world = _robot("box.obj")
    copied("box.obj", "arm/box.obj")
    return world, lambda: copied("kettle.obj", "arm/box.obj")


def a_package_that_comes() -> tuple[World, Change]:
    return _robot("package://parts/box.obj"), lambda: copied("box.obj", "parts/box.obj")


def a_file_in_a_package_that_comes() -> tuple[World, Change]:
    Path("parts").mkdir()
    return _robot("package://parts/box.obj"), lambda: copied("box.obj", "parts/box.obj")


def a_manifest_that_names_a_package() -> tuple[World, Change]:
    copied("box.obj", "renamed/box.obj")
    manifest = Path("renamed/package.xml")
    manifest.write_text("<package><name>other</name></package>")
    world = _robot("package://parts/box.obj")
    return world, lambda: manifest.write_text("<package><name>parts</name></package>")


def a_folder_with_a_manifest_that_comes() -> tuple[World, Change]:
    world = _robot("package://parts/box.obj")

    def come() -> None:
        copied("box.obj", "renamed/box.obj")
        Path("renamed/package.xml").write_text("<package><name>parts</name></package>")

    return world, come


def a_nearer_package() -> tuple[World, Change]:
    copied("box.obj", "parts/box.obj")
    world = _robot("package://parts/box.obj")
    return world, lambda: copied("kettle.obj", "arm/parts/box.obj")


def the_root_of_a_package_that_comes() -> tuple[World, Change]:
    copied("box.obj", "meshes/box.obj")
    world = _robot("../meshes/box.obj")
    return world, Path("arm/package.xml").touch


CASES = [
    a_mesh,
    a_mesh_that_goes,
    a_mesh_that_comes,
    the_scene_file,
    the_second_file_of_a_world,
    an_input_that_comes,
    a_file_that_a_child_reads,
    pytest.param(a_pipe_in_the_place_of_a_mesh, marks=on_posix),
    a_buffer_of_gltf,
    a_buffer_of_gltf_that_a_child_reads,
    a_mesh_of_a_robot,
    a_package_that_comes,
    a_file_in_a_package_that_comes,
    a_manifest_that_names_a_package,
    a_folder_with_a_manifest_that_comes,
    a_nearer_package,
    the_root_of_a_package_that_comes,
]


@pytest.mark.parametrize("case", CASES)
def test_a_change_calls_for_a_new_check_of_its_scene_alone(
    case: Callable[[], tuple[World, Change]],
) -> None:
    world, change = case()
    worlds = [world, _other_scene()]
    assert checked(worlds) == worlds
    before = answer(world)
    assert checked(worlds) == []
    change()
    assert checked(worlds) == [world]
    assert answer(world) != before
    assert checked(worlds) == []


def test_rules_count_for_all() -> None:
    rules = Path("rules.toml")
    rules.write_text('[[rules]]\na = "*"\nb = "*"\nallowed = true\nreason = "known"\n')
    options = CheckOptions(rules=("rules.toml",))
    worlds = [_other_scene()]
    assert checked(worlds, options) == worlds
    assert checked(worlds, options) == []
    rules.write_text('[[rules]]\na = "*"\nb = "*"\nclearance = 1\n')
    assert checked(worlds, options) == worlds


def test_the_search_path_of_packages_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    world = _robot("package://parts/box.obj")
    assert checked([world]) == [world]
    monkeypatch.setenv("ROS_PACKAGE_PATH", "elsewhere")
    assert checked([world]) == [world]


@needs("usd")
def test_an_answer_without_a_reader_does_not_hold(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Once the reader is installed, its files are read."""
    # A child of an earlier test has the library already (tests/conftest.py).
    monkeypatch.setattr(mesh_files, "ReadingChildren", ReadingChildren)
    monkeypatch.setattr(slot_server, "_meshes", KnownMeshes(0))
    (tmp_path / "pxr.py").write_text('raise ModuleNotFoundError("no pxr", name="pxr")')
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    worlds = [(copied("../docs/bench.usda", "bench.usda"),), _other_scene()]
    assert checked(worlds) == worlds
    assert [issue["code"] for issue in answer(worlds[0])["issues"]] == ["missing-extra"]
    assert checked(worlds) == worlds[:1]


def test_an_answer_without_a_solver_does_not_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "clarabel", None)
    world = _other_scene()
    text = Path(world[0]).read_text().replace("[[bodies]]", 'units = "m"\n[[bodies]]', 1)
    Path(world[0]).write_text(f'{text}[[rules]]\nbodies = "*"\nsupported = true\n')
    assert checked([world]) == [world]
    assert "missing-extra" in [issue["code"] for issue in answer(world)["issues"]]
    assert checked([world]) == [world]


def test_a_given_folder_counts_for_the_scenes_in_it() -> None:
    """What they may read depends on it."""
    Path("kit/sets").mkdir(parents=True)
    Path("kit/sets/s.toml").write_text(Path(scene("s.toml", "../box.obj")[0]).read_text())
    copied("box.obj", "kit/box.obj")
    world, other = ("kit/sets/s.toml",), _other_scene()
    assert checked([world, other]) == [world, other]
    assert [issue["code"] for issue in answer(world)["issues"]] == ["outside-path"]
    given = CheckOptions(folders=("kit",))
    assert checked([world, other], given) == [world]
    assert not answer(world)["issues"]
    assert checked([world, other], CheckOptions(folders=("kit", "else"))) == []
    assert checked([world, other]) == [world]


def test_options_without_effect_do_not_count() -> None:
    worlds = [_other_scene()]
    assert checked(worlds, CheckOptions(settings={"jobs": 1})) == worlds
    assert checked(worlds, CheckOptions(settings={"jobs": 2})) == []
    assert checked(worlds, CheckOptions(settings={"jobs": 2, "contacts": True})) == worlds


@on_posix
def test_a_name_that_is_not_utf8() -> None:
    name = os.fsdecode(b"\xff.obj")
    shutil.copy(SAMPLES / "box.obj", name)
    assert checked([(name,)]) == [(name,)]
    assert checked([(name,)]) == []


def test_a_file_that_changes_during_its_check_is_checked_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = (copied("box.obj"),)

    def late(names: Iterable[str], digest: Callable[[str], str | None]) -> tuple[InputFile, ...]:
        copied("kettle.obj", "box.obj")
        return inputs_of(names, digest)

    with monkeypatch.context() as context:
        context.setattr("satcheck.audit.batch.slot_server.inputs_of", late)
        assert checked([world]) == [world]
    assert checked([world]) == [world]
    assert checked([world]) == []


def test_a_digest_tells_what_is_there(tmp_path: Path) -> None:
    empty = tmp_path / "empty"
    empty.touch()
    there = {digest(str(path)) for path in (empty, tmp_path, tmp_path / "none")}
    assert len(there) == 3
    before = digest(f"{tmp_path}/")
    (tmp_path / "file").touch()
    assert digest(f"{tmp_path}/") == before
    (tmp_path / "folder").mkdir()
    assert digest(f"{tmp_path}/") != before


def test_where_links_lead_counts_even_if_the_bytes_are_the_same() -> None:
    """A baseline and the names of packages depend on it."""
    for folder in ("one", "two"):
        copied("box.obj", f"{folder}/box.obj")
    Path("link").symlink_to("one")
    world = ("link/box.obj",)
    assert checked([world]) == [world]
    assert checked([world]) == []
    Path("link").unlink()
    Path("link").symlink_to("two")
    assert checked([world]) == [world]


def test_another_folder_counts(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The names of the folders above a robot may be those of its packages."""
    Path("before").mkdir()
    monkeypatch.chdir(tmp_path / "before")
    world = (copied("box.obj"),)
    assert checked([world]) == [world]
    (tmp_path / "before").rename(tmp_path / "after")
    monkeypatch.chdir(tmp_path / "after")
    assert checked([world]) == [world]
    assert checked([world]) == []


def test_where_a_link_to_a_file_leads_counts_too() -> None:
    for folder in ("one", "two"):
        copied("box.obj", f"{folder}/box.obj")
    Path("box.obj").symlink_to("one/box.obj")
    world = scene("s.toml", "box.obj", copied("rod.stl"))
    assert checked([world], CheckOptions(allow_outside=True)) == [world]
    assert checked([world], CheckOptions(allow_outside=True)) == []
    Path("box.obj").unlink()
    Path("box.obj").symlink_to("two/box.obj")
    assert checked([world], CheckOptions(allow_outside=True)) == [world]


def test_only_a_result_that_is_kept_has_a_key() -> None:
    """Its file is gone after the run, so no later one looks for it."""
    world = scene("a.toml", copied("box.obj"))
    assert key_in(world, Wanted(kept=True))
    assert key_in(world, Wanted(kept=False)) is None
