"""The faces of a Mesh as triangles."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.scene import MeshFile
from tests.plugins.usd.files import cube, load, said, stage

# An L of area 3, extruded by 1; its ends are polygons of six corners with a notch.
L_SHAPE = """def Mesh "L" {
    int[] faceVertexCounts = [6, 6, 4, 4, 4, 4, 4, 4]
    int[] faceVertexIndices = [5,4,3,2,1,0, 6,7,8,9,10,11, 0,1,7,6, 1,2,8,7, 2,3,9,8, 3,4,10,9,
        4,5,11,10, 5,0,6,11]
    point3f[] points = [(0,0,0),(2,0,0),(2,1,0),(1,1,0),(1,2,0),(0,2,0),
        (0,0,1),(2,0,1),(2,1,1),(1,1,1),(1,2,1),(0,2,1)]
    uniform token subdivisionScheme = "none"
}"""


def file_of(folder: Path, prim: str) -> MeshFile:
    (body,) = load(folder, stage(prim)).bodies
    return body.file


def test_a_polygon_with_a_notch_is_covered_exactly(tmp_path: Path) -> None:
    health = file_of(tmp_path, L_SHAPE).health
    assert (health.closed, health.volume, health.inside_out) == (True, 3.0, False)


def test_a_left_handed_mesh_faces_outward(tmp_path: Path) -> None:
    left = cube("A", 'uniform token orientation = "leftHanded"')
    assert file_of(tmp_path, left).health.inside_out
    assert not file_of(tmp_path, cube("A")).health.inside_out


def test_faces_that_are_holes_are_open(tmp_path: Path) -> None:
    assert file_of(tmp_path, cube("A", "int[] holeIndices = [2]")).health.boundary_edges == 4


def test_a_subset_is_no_body(tmp_path: Path) -> None:
    subset = 'def GeomSubset "S" {\n uniform token elementType = "face"\n int[] indices = [0]\n}'
    assert len(load(tmp_path, stage(cube("A", subset))).bodies) == 1


def test_a_control_cage_is_named(tmp_path: Path) -> None:
    assert "control-cage" not in said(load(tmp_path, stage(cube("A"))))
    smooth = cube("A").replace('uniform token subdivisionScheme = "none"', "")
    assert "/A" in said(load(tmp_path, stage(smooth)))["control-cage"]


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("1,5,7,3]", "1,5,7,8]", "index-out-of-range"),
        ("1,5,7,3]", "1,5,7,-3]", "index-out-of-range"),
        ("1,5,7,3]", "1,5,7]", "count-mismatch"),
        ("(1,1,1)]", "(1,1,inf)]", "non-finite"),
        ("point3f[] points = [", "int[] points = [1, 2, 3]\npoint3f[] others = [", "bad-record"),
        ("int[] faceVertexCounts", "float[] faceVertexCounts", "bad-record"),
        ("[4, 4, 4, 4, 4, 4]", "[4, 4, 4, 4, 4, -4]", "count-mismatch"),
    ],
)
def test_a_broken_mesh_is_refused_and_the_others_are_checked(
    tmp_path: Path, old: str, new: str, code: str
) -> None:
    broken = cube("A").replace(old, new)
    assert broken != cube("A")
    scene = load(tmp_path, stage(broken, cube("B")))
    assert [body.id for body in scene.bodies] == ["/B"]
    assert [(body.id, body.issue.code) for body in scene.unreadable] == [("/A", code)]


def test_a_tetrahedron_has_its_outer_faces(tmp_path: Path) -> None:
    tetrahedron = """def TetMesh "T" {
        int4[] tetVertexIndices = [(0, 1, 2, 3)]
        point3f[] points = [(0,0,0),(6,0,0),(0,1,0),(0,0,1)]
    }"""
    health = file_of(tmp_path, tetrahedron).health
    assert (health.triangles, health.volume) == (4, 1.0)
