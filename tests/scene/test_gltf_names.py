"""What a glTF file holds is read, harmless, or blocks a pass; colliders are bodies on request."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from satcheck.scene import load_scene
from satcheck.scene.bodies import Scene
from satcheck.scene.errors import Refused
from satcheck.scene.files.gltf_document import read_document
from satcheck.scene.files.readers import GeometryKind
from satcheck.scene.vocabulary import UnknownNames
from tests.scene import files
from tests.scene.loading import refusal

Json = dict[str, Any]


def document() -> Json:
    """Two nodes with the unit cube."""
    made, _ = files.gltf_document()
    made["nodes"] = [{"name": "a", "mesh": 0}, {"name": "b", "mesh": 0, "translation": [3, 0, 0]}]
    made["scenes"] = [{"nodes": [0, 1]}]
    return made


def read(folder: Path, made: Json, geometry: GeometryKind | None = None) -> Scene:
    path = folder / "s.glb"
    path.write_bytes(files.glb(made, files.gltf_document()[1]))
    return load_scene([path], geometry=geometry)


def refused(folder: Path, made: Json) -> tuple[str, str]:
    """The code and the message."""
    return refusal(folder, "s.glb", files.glb(made, files.gltf_document()[1]))


def codes(scene: Scene) -> list[str]:
    return [issue.code for issue in scene.issues]


MISSPELT: dict[str, Callable[[Json], object]] = {
    "translaton": lambda made: made["nodes"][1].update(translaton=[0, 0, 0]),
    "childrn": lambda made: made["nodes"][0].update(childrn=[1]),
    "skn": lambda made: made["nodes"][0].update(skn=0),
    "scne": lambda made: made.update(scne=0),
    "extensionsRequird": lambda made: made.update(extensionsRequird=["X"]),
    "sparce": lambda made: made["accessors"][0].update(sparce={}),
    "byteOfset": lambda made: made["bufferViews"][0].update(byteOfset=4),
    "indces": lambda made: made["meshes"][0]["primitives"][0].update(indces=1),
    "POSITON": lambda made: made["meshes"][0]["primitives"][0].update(targets=[{"POSITON": 0}]),
    "EXT_mesh_gp_instancing": lambda made: made["nodes"][1].update(
        extensions={"EXT_mesh_gp_instancing": {}}
    ),
    "ROTATON": lambda made: made["nodes"][1].update(
        extensions={"EXT_mesh_gpu_instancing": {"attributes": {"ROTATON": 0}}}
    ),
}


@pytest.mark.parametrize("name", MISSPELT)
def test_a_misspelt_name_is_refused(tmp_path: Path, name: str) -> None:
    made = document()
    MISSPELT[name](made)
    code, message = refused(tmp_path, made)
    assert code == "misspelt"
    assert name in message


UNREAD: dict[str, Callable[[Json], object]] = {
    "of a node": lambda made: made["nodes"][1].update(offset=[0, 0, 0]),
    "of a mesh": lambda made: made["meshes"][0].update(instances=[]),
    "of a primitive": lambda made: made["meshes"][0]["primitives"][0].update(displacement=1),
    "extension that is used": lambda made: made.update(extensionsUsed=["FOO_bar"]),
    "extension of a node": lambda made: made["nodes"][1].update(extensions={"FOO_bar": {}}),
    "extension of the file": lambda made: made.update(extensions={"KHR_interactivity": {}}),
    "extension of a material": lambda made: made.update(
        materials=[{"extensions": {"KHR_materials_displacement": {}}}]
    ),
    "extension at another place": lambda made: made["meshes"][0].update(
        extensions={"EXT_mesh_gpu_instancing": {}}
    ),
    "levels of detail": lambda made: made["nodes"][1].update(extensions={"MSFT_lod": {"ids": [0]}}),
    "vertex shader": lambda made: made.update(extensionsUsed=["KHR_techniques_webgl"]),
    "attribute": lambda made: made["meshes"][0]["primitives"][0]["attributes"].update(RADIUS=0),
    "which of two scenes": lambda made: (made.pop("scene", None), made["scenes"].append({})),
    "instances of a group": lambda made: made["nodes"].append(
        {"extensions": {"EXT_mesh_gpu_instancing": {"attributes": {}}}}
    ),
}


@pytest.mark.parametrize("name", UNREAD)
def test_what_nobody_knows_blocks_a_pass(tmp_path: Path, name: str) -> None:
    made = document()
    UNREAD[name](made)
    scene = read(tmp_path, made)
    assert codes(scene) == ["unread"]
    assert len(scene.bodies) == 2


def test_a_name_that_many_nodes_have_is_one_issue(tmp_path: Path) -> None:
    made = document()
    for node in made["nodes"]:
        node["offset"] = [0, 0, 0]
    (issue,) = read(tmp_path, made).issues
    assert issue.message == "node 0: offset is not read; it may hold or move a body (2 times)"


HARMLESS = (
    "KHR_materials_clearcoat",
    "KHR_texture_basisu",
    "KHR_lights_punctual",
    "KHR_xmp",
    "KHR_node_selectability",
    "KHR_implicit_shapes",
    "OMI_physics_joint",
    "NV_materials_mdl",
    "ADOBE_materials_thin_transparency",
    "FB_ngon_encoding",
    "EXT_mesh_manifold",
    "3DTILES_content_gltf",
    "EXT_structural_metadata",
    "MSFT_texture_dds",
)


@pytest.mark.parametrize("name", HARMLESS)
def test_an_extension_without_geometry_may_be_required(tmp_path: Path, name: str) -> None:
    made = {**document(), "extensionsUsed": [name], "extensionsRequired": [name]}
    made["nodes"][0] |= {"extras": {"translaton": 1}, "camera": 0}
    assert not read(tmp_path, made).issues


@pytest.mark.parametrize(
    "name", ["KHR_materials_displacement", "KHR_techniques_webgl", "KHR_texture_displacement"]
)
def test_an_extension_with_geometry_may_not_be_required(tmp_path: Path, name: str) -> None:
    made = {**document(), "extensionsRequired": [name]}
    assert refused(tmp_path, made)[0] == "unsupported-feature"


def test_a_file_for_a_later_version_is_refused(tmp_path: Path) -> None:
    made = document()
    made["asset"]["minVersion"] = "2.1"
    assert "2.1" in refused(tmp_path, made)[1]


def test_what_no_scene_holds_is_a_note(tmp_path: Path) -> None:
    made = document()
    made["nodes"].append({"mesh": 0})
    made["meshes"].append(made["meshes"][0])
    (issue,) = read(tmp_path, made).issues
    assert (issue.code, issue.severity) == ("left-out", "note")
    assert issue.message == "node 2 outside of the scene; mesh 1 without a node"


KHR, OMI = "KHR_physics_rigid_bodies", "OMI_physics_body"
SHAPES = [
    {"type": "box", "box": {"size": [1, 2, 3]}},
    {"type": "capsule", "capsule": {"height": 2, "radiusBottom": 0.5, "radiusTop": 0.5}},
    {"type": "capsule", "capsule": {"height": 2, "radiusBottom": 0.5, "radiusTop": 0.1}},
]


def collider(name: str, shape: int, **more: Any) -> Json:
    place = {"shape": shape} if name == OMI else {"geometry": {"shape": shape}}
    return {"extensions": {name: {"collider": place, **more}}}


def with_colliders(name: str, *shapes: int) -> Json:
    made = document()
    holder = "OMI_physics_shape" if name == OMI else "KHR_implicit_shapes"
    made["extensions"] = {holder: {"shapes": SHAPES}}
    for number, shape in enumerate(shapes):
        made["nodes"][number] |= collider(name, shape)
    return made


@pytest.mark.parametrize("name", [KHR, OMI])
def test_colliders_are_bodies_on_request(tmp_path: Path, name: str) -> None:
    made = with_colliders(name, 0, 1)
    assert codes(read(tmp_path, made)) == ["unread"]
    assert codes(read(tmp_path, made, "visual")) == ["left-out"]
    scene = read(tmp_path, made, "collision")
    assert codes(scene) == ["left-out"]
    box, capsule = scene.bodies
    assert box.world_mesh().bounds == ((-0.5, -1.0, -1.5), (0.5, 1.0, 1.5))
    low, high = capsule.world_mesh().bounds
    assert (low[1], high[1]) == (-1.5, 1.5)


def test_a_collider_that_is_not_read_is_a_body_that_cannot_be_checked(tmp_path: Path) -> None:
    scene = read(tmp_path, with_colliders(KHR, 0, 2), "collision")
    (lost,) = scene.unreadable
    assert (lost.id, lost.issue.code) == ("b", "unsupported-feature")


def test_a_shape_with_sizes_of_another_kind_cannot_be_checked(tmp_path: Path) -> None:
    made = with_colliders(KHR, 0, 1)
    made["extensions"]["KHR_implicit_shapes"]["shapes"] = [SHAPES[0], {**SHAPES[0], "sphere": {}}]
    (lost,) = read(tmp_path, made, "collision").unreadable
    assert (lost.id, "a sphere" in lost.issue.message) == ("b", True)


@pytest.mark.parametrize("name", ["colider", "colliders"])
def test_a_misspelt_collider_is_refused(tmp_path: Path, name: str) -> None:
    made = with_colliders(KHR, 0, 1)
    made["nodes"][1]["extensions"][KHR] = {name: {}}
    assert refused(tmp_path, made)[0] == "misspelt"


def test_a_node_with_a_negative_mesh_is_refused(tmp_path: Path) -> None:
    made = document()
    made["nodes"][1]["mesh"] = -1
    assert refused(tmp_path, made)[0] == "bad-record"


@pytest.mark.parametrize("number", [[0], {}, None, "0", True, 0.0])
def test_a_number_of_another_type_is_refused(tmp_path: Path, number: Any) -> None:
    made = document()
    (whole,) = made["meshes"][0]["primitives"]
    made["meshes"].append({"primitives": [{**whole, "attributes": {"POSITION": number}}]})
    made["nodes"][1]["mesh"] = 1
    (lost,) = read(tmp_path, made).unreadable
    assert (lost.id, lost.issue.code) == ("b", "bad-record")


def test_shapes_that_are_no_list_cannot_be_checked(tmp_path: Path) -> None:
    made = with_colliders(KHR, 0, 1)
    made["extensions"]["KHR_implicit_shapes"]["shapes"] = 1
    assert {lost.issue.code for lost in read(tmp_path, made, "collision").unreadable} == {
        "bad-record"
    }


def test_a_mesh_without_primitives_cannot_be_checked(tmp_path: Path) -> None:
    made = document()
    made["meshes"].append({"name": "lost"})
    made["nodes"][1]["mesh"] = 1
    (lost,) = read(tmp_path, made).unreadable
    assert (lost.id, lost.issue.code) == ("b", "bad-record")


def test_colliders_of_one_rigid_body_may_touch(tmp_path: Path) -> None:
    made = with_colliders(KHR, 0, 0)
    made["nodes"][0]["extensions"][KHR]["motion"] = {}
    made["nodes"][0]["children"] = [1]
    made["scenes"][0]["nodes"] = [0]
    scene = read(tmp_path, made, "collision")
    (rule,) = scene.rules
    assert rule.allowed
    assert rule.reason == "colliders of one rigid body"


def test_a_trigger_is_no_body(tmp_path: Path) -> None:
    made = document()
    made["nodes"][0]["extensions"] = {KHR: {"trigger": {"geometry": {"shape": 0}}}}
    assert not read(tmp_path, made).issues


def test_a_key_given_twice_is_refused() -> None:
    made = json.dumps(document()).replace(
        '"mesh": 0, "tr', '"translation": [0, 0, 0], "mesh": 0, "tr'
    )
    with pytest.raises(Refused, match="'translation' occurs twice") as error:
        read_document(memoryview(made.encode()), UnknownNames())
    assert error.value.code == "bad-record"


def test_many_keys_before_one_given_twice_take_no_time_of_their_own() -> None:
    """They are counted in one pass: looking back from each key would take hours."""
    keys = ", ".join(f'"{number}": 0' for number in [*range(300_000), 299_999])
    with pytest.raises(Refused, match="'299999' occurs twice"):
        read_document(memoryview(f'{{"extras": {{{keys}}}}}'.encode()), UnknownNames())


@pytest.mark.parametrize(
    ("name", "code"),
    [("upAxis", "unread"), ("minversion", "misspelt"), ("author", None), ("extras", None)],
)
def test_what_nobody_reads_in_the_asset_is_named(
    tmp_path: Path, name: str, code: str | None
) -> None:
    made, buffer = files.gltf_document()
    made["asset"][name] = "2.1"
    (tmp_path / "a.glb").write_bytes(files.glb(made, buffer))
    issues = load_scene([tmp_path / "a.glb"]).issues
    assert [issue.code for issue in issues] == ([code] if code else [])


def test_an_unknown_extension_of_the_asset_blocks_a_pass(tmp_path: Path) -> None:
    made = document()
    made["asset"]["extensions"] = {"KHR_xmp_json_ld": {}}
    assert codes(read(tmp_path, made)) == []
    made["asset"]["extensions"] = {"FOO_units": {}}
    assert codes(read(tmp_path, made)) == ["unread"]


@pytest.mark.parametrize("given", [[{"EXT_x": {}}], "EXT_x", {"EXT_mesh_gpu_instancing": []}])
def test_extensions_that_are_no_objects_are_refused(tmp_path: Path, given: Any) -> None:
    made = document()
    made["nodes"][0]["extensions"] = given
    (code,) = {body.issue.code for body in read(tmp_path, made).unreadable}
    assert code == "bad-record"
