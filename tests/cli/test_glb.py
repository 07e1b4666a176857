"""The 3-D model of a report, as trimesh reads it."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from satcheck.cli.formats.picture.glb import MET, OVERLAP, PART
from satcheck.core import Mesh
from satcheck.scene.written_meshes import Node, glb
from tests.cli.process import PUSHED, satcheck


def model(path: Path, *arguments: str) -> Any:
    ran = satcheck(*arguments, "-o", str(path))
    assert ran.code in (0, 1, 3), ran.err
    return trimesh.load_scene(path)


def placed(scene: Any, name: str) -> Any:
    transform, geometry = scene.graph[name]
    mesh = scene.geometry[geometry].copy()
    mesh.apply_transform(transform)
    mesh.merge_vertices()
    return mesh


def test_bodies_overlap_way_out_and_thickness(tmp_path: Path) -> None:
    """The box of 4, and the box of 3 that reaches 1 into it."""
    scene = model(tmp_path / "out.glb", *PUSHED)
    pair = "box and box_pushed"
    names = {"box", "box_pushed", f"overlap: {pair}", f"way out: {pair}", f"thickness: {pair}"}
    assert set(scene.graph.nodes_geometry) == names
    a, b, common = (placed(scene, n) for n in ("box", "box_pushed", f"overlap: {pair}"))
    low, high = np.maximum(a.bounds[0], b.bounds[0]), np.minimum(a.bounds[1], b.bounds[1])
    assert common.bounds == pytest.approx(np.array([low, high]), abs=1e-6)
    assert common.is_watertight
    assert common.volume == pytest.approx(np.prod(high - low))
    ball = placed(scene, f"thickness: {pair}")
    assert ball.extents == pytest.approx([1.0, 1.0, 1.0], rel=1e-6)
    arrow = placed(scene, f"way out: {pair}")
    assert arrow.extents.max() == pytest.approx(1.0, rel=1e-6)  # as long as the depth
    red = scene.geometry[scene.graph[f"overlap: {pair}"][1]].visual.material
    assert red.baseColorFactor[0] > 2 * red.baseColorFactor[2]


def test_a_report_with_parts_has_a_node_for_each(tmp_path: Path) -> None:
    """Of the bracket one part overlaps the peg, and the other one does not."""
    scene = model(tmp_path / "out.glb", "--parts", "l_bracket.obj", "peg_in_arm.ply")
    names = {"l_bracket-1", "l_bracket-2", "peg_in_arm-1"}
    assert names <= set(scene.graph.nodes_geometry)
    assert not {"l_bracket", "peg_in_arm"} & set(scene.graph.nodes_geometry)
    materials = {name: scene.geometry[scene.graph[name][1]].visual.material.name for name in names}
    assert sorted(materials.values()) == [MET.name, PART.name, PART.name]
    assert materials["peg_in_arm-1"] == PART.name
    for name in names:
        part = placed(scene, name)
        assert part.is_watertight
        assert part.is_convex


def test_copies_share_a_mesh_and_lie_in_metres(tmp_path: Path) -> None:
    scene = model(tmp_path / "out.glb", "rack.3mf")
    posts = [name for name in scene.graph.nodes_geometry if "post" in name]
    assert len(posts) == 2
    assert len({scene.graph[name][1] for name in posts}) == 1
    assert scene.extents == pytest.approx([0.004, 0.004, 0.0055], rel=1e-6)


def test_a_body_that_is_not_closed_has_no_overlap_and_that_is_said(tmp_path: Path) -> None:
    scene = model(tmp_path / "out.glb", "open_box.off", "l_bracket.obj")
    assert not [name for name in scene.graph.nodes_geometry if name.startswith("overlap")]
    (remark,) = scene.metadata["remarks"]
    assert "open_box is not closed" in remark


def test_nodes_may_have_one_name_and_materials_keep_theirs() -> None:
    tetrahedron = Mesh(np.eye(4, 3), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    nodes = [Node("part", tetrahedron, None, material) for material in (MET, OVERLAP, None)]
    content = glb(nodes, "mm", ["a", "b"])
    (length,) = struct.unpack("<I", content[12:16])
    tree = json.loads(content[20 : 20 + length])
    assert [node["name"] for node in tree["nodes"]] == ["part"] * 3
    assert sorted(node["mesh"] for node in tree["nodes"]) == [0, 1, 2]
    assert len(tree["accessors"]) == 2  # the vertices and the triangles, once each
    translucent, opaque = tree["materials"]
    assert (translucent["name"], translucent["alphaMode"]) == (MET.name, "BLEND")
    assert (opaque["name"], "alphaMode" in opaque) == (OVERLAP.name, False)
    colours = [each["pbrMetallicRoughness"]["baseColorFactor"] for each in (translucent, opaque)]
    assert colours == [pytest.approx(each.colour, abs=0.5 / 255) for each in (MET, OVERLAP)]
    assert tree["scenes"][0]["extras"] == {"remarks": ["a", "b"]}
    assert glb(nodes, "mm", ["a", "b"]) == content


def test_view_writes_the_same_model(tmp_path: Path) -> None:
    report, glb = tmp_path / "report.json", tmp_path / "later.glb"
    model(tmp_path / "out.glb", *PUSHED)
    satcheck("--contacts", *PUSHED, "-o", str(report))
    assert satcheck("view", str(report), "-o", str(glb)).code == 0
    assert glb.read_bytes() == (tmp_path / "out.glb").read_bytes()


def test_it_can_be_checked_again(tmp_path: Path) -> None:
    """Each node is a body; the way out starts in the overlap."""
    model(tmp_path / "out.glb", *PUSHED)
    ran = satcheck(str(tmp_path / "out.glb"), "--format", "json")
    relations = {(f["a"], f["b"]): f["relation"] for f in ran.document["findings"]}
    assert relations["box", "box_pushed"] == "penetrating"
