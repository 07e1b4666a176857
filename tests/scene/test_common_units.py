"""Inputs in several units: converted where each is known, and never mixed where one is not."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import Scene, load_scene
from satcheck.scene.units import MICROMETRES, ratio, stated_unit, unit_in, unit_of
from tests.scene import files
from tests.scene.robot.robots import link, robot_of
from tests.scene.scene_file.scenes import scene_of, toml_document

ROWS = [[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A unit cube in every kind of file: metres, inches (3MF), a unit of its own (DAE), none."""
    dae = files.collada().decode().replace('name="meter" meter="1"', 'name="x" meter="0.01"')
    contents = {
        "m.glb": files.glb(),
        "in.3mf": files.threemf(),
        "cm.dae": dae.encode(),
        "none.stl": files.binary_stl(),
        "none.obj": files.obj(),
    }
    for name, content in contents.items():
        (tmp_path / name).write_bytes(content)
    return tmp_path


def load(folder: Path, *names: str, units: str | None = None) -> Scene:
    return load_scene([folder / name for name in names], units=units)


def write_scene(folder: Path, *bodies: dict[str, object], **keys: object) -> None:
    (folder / "cell.toml").write_text(toml_document(scene_of(*bodies) | keys), encoding="utf-8")


def extents(scene: Scene) -> dict[str, float]:
    """From the origin to the farthest corner along x."""
    return {body.id: body.world_mesh().bounds[1][0] for body in scene.bodies}


def codes(scene: Scene) -> list[str]:
    return [issue.code for issue in scene.issues if issue.code.startswith("units")]


def test_factors_are_exact_or_rounded_once() -> None:
    assert ratio("m", "mm") == 1000.0
    assert ratio("in", "um") == 25400.0
    assert ratio("mm", "m") == 0.001
    for name in MICROMETRES:
        assert unit_in("mm", ratio(name, "mm")) == name


@pytest.mark.parametrize(
    ("declared", "unit"),
    [
        ("meters", "m"),
        ("0.0254 * meters", "in"),
        ("0.01 * meters", "cm"),
        ("1e-3 * meters", "mm"),
        ("0.3 * meters", None),
        ("x * meters", None),
    ],
)
def test_a_factor_of_metres_is_a_unit(declared: str, unit: str | None) -> None:
    assert unit_of(declared) == unit


def test_a_remark_after_the_unit_does_not_hide_it() -> None:
    assert stated_unit("mm (assumed)") == "mm"
    assert stated_unit("") is None


def test_files_that_state_their_units_are_converted(folder: Path) -> None:
    """To the smallest of them, whichever comes first."""
    for names in (("m.glb", "in.3mf", "cm.dae"), ("cm.dae", "in.3mf", "m.glb")):
        scene = load(folder, *names)
        assert scene.units == "cm"
        assert extents(scene) == {"m": 100.0, "in": 2.54, "cm": 1.0}
        assert {body.id: body.unit_scale for body in scene.bodies} == {
            "m": 100.0,
            "in": 2.54,
            "cm": None,
        }
        assert {body.units for body in scene.bodies} == {"cm"}
        assert codes(scene) == ["units-converted", "units-converted"]


def test_nodes_are_converted_with_their_places(tmp_path: Path) -> None:
    document, buffer = files.gltf_document()
    document["nodes"] = [{"mesh": 0, "name": "far", "translation": [2, 0, 0]}]
    (tmp_path / "m.glb").write_bytes(files.glb(document, buffer))
    (tmp_path / "in.3mf").write_bytes(files.threemf())
    scene = load_scene([tmp_path / "m.glb", tmp_path / "in.3mf"], split="nodes")
    far = scene.bodies[0]
    assert far.id == "m/far"
    assert far.world_mesh().bounds[1][0] == pytest.approx(3 / 0.0254, rel=1e-15)


@pytest.mark.parametrize(
    ("names", "units"),
    [
        (("none.stl", "none.obj"), None),
        (("m.glb", "m.glb"), "meter"),
        (("in.3mf", "in.3mf"), "inch"),
        (("m.glb",), "meter"),
    ],
)
def test_of_one_unit_or_none_nothing_changes(
    folder: Path, names: tuple[str, ...], units: str | None
) -> None:
    scene = load(folder, *names)
    assert (scene.units, codes(scene)) == (units, [])
    assert {body.unit_scale for body in scene.bodies} == {None}
    assert set(extents(scene).values()) == {1.0}


def test_what_states_no_unit_has_no_frame_with_what_does(folder: Path) -> None:
    scene = load(folder, "m.glb", "none.stl", "none.obj")
    assert scene.units is None
    assert [body.units for body in scene.bodies] == ["m", None, None]
    (issue,) = [issue for issue in scene.issues if issue.code == "units-unknown"]
    assert issue.severity == "warning"
    assert "none.stl" in issue.message
    assert "--units" in issue.message
    with pytest.raises(SatcheckError, match="State the unit"):
        scene.require_one_unit()


def test_units_given_are_those_of_what_states_none(folder: Path) -> None:
    scene = load(folder, "m.glb", "none.stl", units="millimetres")
    assert (scene.units, codes(scene)) == ("mm", ["units-converted"])
    assert extents(scene) == {"m": 1000.0, "none": 1.0}
    scene = load(folder, "none.obj", "none.stl", units="mm")
    assert (scene.units, codes(scene)) == ("mm", [])
    with pytest.raises(SatcheckError, match="one of um, mm"):
        load(folder, "none.obj", "none.stl", units="furlong")


def test_a_file_of_rules_states_them_as_well(folder: Path) -> None:
    rule = {"a": "m", "b": "none", "clearance": 3, "max_volume": 2}
    (folder / "rules.json").write_text(
        json.dumps({"schema": "satcheck.scene/1", "units": "in", "bodies": [], "rules": [rule]})
    )
    scene = load(folder, "m.glb", "rules.json", "none.stl")
    assert (scene.units, codes(scene)) == ("in", ["units-converted"])
    assert extents(scene)["none"] == 1.0
    scene = load(folder, "m.glb", "rules.json")
    assert extents(scene) == {"node0": 1.0}  # rules change no body
    assert scene.rules[0].clearance == 3 * 0.0254
    assert scene.rules[0].max_volume == pytest.approx(2 * 0.0254**3)


def test_a_scene_is_in_its_own_units(folder: Path) -> None:
    """Meshes that state none are in them, others are converted before they are placed."""
    write_scene(
        folder,
        {"id": "stl", "mesh": "none.stl", "position": [5, 0, 0]},
        {"id": "glb", "mesh": "m.glb", "position": [5, 0, 0], "scale": 2},
        {"id": "part", "mesh": "m.glb", "part": "node0", "position": [5, 0, 0]},
        {"id": "own", "mesh": "m.glb", "units": "mm", "position": [5, 0, 0]},
        {"id": "box", "shape": {"type": "box", "size": [1, 1, 1]}},
        units="mm",
    )
    scene = load(folder, "cell.toml")
    assert scene.units == "mm"
    wanted = {"stl": 6.0, "glb": 2005.0, "part": 1005.0, "own": 6.0, "box": 0.5}
    assert extents(scene) == wanted
    beside = load(folder, "cell.toml", "m.glb", "none.obj")
    assert extents(beside) == wanted | {"m": 1000.0, "none": 1.0}
    assert [body.id for body in beside.bodies if body.units is None] == ["none"]


def test_a_scene_without_units_is_in_those_of_its_meshes(folder: Path) -> None:
    write_scene(
        folder,
        {"id": "glb", "mesh": "m.glb", "position": [5, 0, 0]},
        {"id": "box", "shape": {"type": "box", "size": [1, 1, 1]}},
    )
    scene = load(folder, "cell.toml", "in.3mf")
    assert scene.units == "m"
    assert extents(scene) == {"glb": 6.0, "box": 0.5, "in": 0.0254}


@pytest.mark.parametrize("others", [["none.stl"], ["in.3mf"]])
def test_a_scene_without_units_of_unlike_meshes_is_not_understood(
    folder: Path, others: list[str]
) -> None:
    write_scene(folder, *({"id": name, "mesh": name} for name in ["m.glb", *others]))
    scene = load(folder, "cell.toml")
    assert (scene.units, codes(scene)) == (None, ["units-unknown"])
    assert "`units` in the scene" in scene.issues[-1].message
    assert load(folder, "cell.toml", units="m").units == "m"


def test_two_scenes_of_different_units(folder: Path) -> None:
    write_scene(
        folder,
        {"id": "a", "shape": {"type": "sphere", "radius": 1}, "position": [1, 0, 0]},
        units="in",
        rules=[{"a": "a", "b": "*", "max_depth": 2.0}],
        motion=[{"bodies": "a", "translation": [0, 0, 10]}],
    )
    (folder / "cell.toml").rename(folder / "inches.toml")
    write_scene(folder, {"id": "b", "mesh": "none.stl"}, units="mm")
    scene = load(folder, "inches.toml", "cell.toml", "none.obj", units="mm")
    assert scene.units == "mm"
    assert extents(scene)["a"] == pytest.approx(50.8)
    assert scene.rules[0].max_depth == 50.8
    assert scene.motions[0].path.vector == (0, 0, 254.0)  # type: ignore[union-attr]


def test_a_robot_is_in_metres(folder: Path) -> None:
    shape = '<collision><geometry><mesh filename="{}"/></geometry></collision>'
    links = [link(name, shape.format(name)) for name in ("none.stl", "cm.dae", "m.glb")]
    (folder / "r.urdf").write_text(robot_of(links[0]))
    scene = load(folder, "r.urdf", "in.3mf")
    assert (scene.units, extents(scene)) == ("m", {"none.stl": 1.0, "in": 0.0254})
    (folder / "r.urdf").write_text(robot_of(links[1]))
    assert extents(load(folder, "r.urdf")) == {"cm.dae": 0.01}
    (folder / "r.urdf").write_text(robot_of(links[2]))
    scene = load(folder, "r.urdf")
    assert (extents(scene), codes(scene)) == ({"m.glb": 1.0}, [])


def test_labels_are_those_of_the_inputs(folder: Path) -> None:
    write_scene(folder, {"id": "a", "mesh": "none.stl"}, units="furlong")
    assert load(folder, "cell.toml").units == "furlong"
    write_scene(folder, {"id": "a", "mesh": "none.stl"}, units="mm (assumed)")
    assert load(folder, "cell.toml").units == "mm (assumed)"
