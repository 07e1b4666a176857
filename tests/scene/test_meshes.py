"""Meshes in memory become bodies with the precision and the words of their arrays."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import trimesh

from satcheck.core import Mesh
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from satcheck.scene.meshes import Mesh as Prepared
from satcheck.scene.meshes import scene_of_meshes

CUBE = trimesh.creation.box((2.0, 2.0, 2.0))
VERTICES = np.asarray(CUBE.vertices)
FACES = np.asarray(CUBE.faces)
FLOATS = ("float16", "float32", "float64", "longdouble", ">f4", ">f8")
INTEGERS = ("int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", ">i4")


def file_of(mesh: Any) -> Any:
    (body,) = scene_of_meshes({"cube": mesh}).bodies
    return body.file


def read_only(array: Any) -> Any:
    array = array.copy()
    array.flags.writeable = False
    return array


class Rows:
    """Not an array, but one of numbers, like the vectors of Open3D."""

    def __init__(self, values: Any) -> None:
        self._values = values

    def __len__(self) -> int:
        return len(self._values)

    def __getitem__(self, index: int) -> Any:
        return self._values[index]


@pytest.mark.parametrize(
    "mesh",
    [
        pytest.param(CUBE, id="trimesh"),
        pytest.param((VERTICES, FACES), id="pair"),
        pytest.param([VERTICES.tolist(), FACES.tolist()], id="lists"),
        pytest.param(Mesh(VERTICES, FACES), id="core"),
        pytest.param(SimpleNamespace(vertices=Rows(VERTICES), triangles=Rows(FACES)), id="open3d"),
        pytest.param((read_only(VERTICES), read_only(FACES)), id="read-only"),
        pytest.param((np.asfortranarray(VERTICES), np.asfortranarray(FACES)), id="columns"),
        pytest.param((VERTICES.repeat(2, 1)[:, ::2], FACES.repeat(2, 0)[::2]), id="strided"),
    ],
)
def test_every_form_of_a_mesh_is_the_same_body(mesh: Any) -> None:
    file = file_of(mesh)
    assert file.health.solid
    assert file.health.volume == 8.0
    assert file.resolution == 2.0**-49


@pytest.mark.parametrize("dtype", FLOATS)
def test_float_vertices_are_as_precise_as_their_type(dtype: str) -> None:
    steps = {2: 2.0**-10, 4: 2.0**-23}
    file = file_of((VERTICES.astype(dtype), FACES))
    assert file.health.volume == 8.0
    assert file.resolution == steps.get(np.dtype(dtype).itemsize, 2.0**-49)


@pytest.mark.parametrize("dtype", INTEGERS)
def test_integers_are_vertices_and_faces(dtype: str) -> None:
    file = file_of(((VERTICES + 1.0).astype(dtype), FACES.astype(dtype)))
    assert file.health.volume == 8.0
    assert file.resolution == 2.0 * 2.0**-49


@pytest.mark.parametrize("dtype", ["<f4", "<f8"])
def test_arrays_are_as_precise_as_a_file_that_holds_them(dtype: str, tmp_path: Any) -> None:
    vertices = (VERTICES * 0.7).astype(dtype)
    kind = {"<f4": "float", "<f8": "double"}[dtype]
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property {kind} {axis}" for axis in "xyz"]
    lines += [f"element face {len(FACES)}", "property list uchar int vertex_indices", "end_header"]
    rows = np.zeros(len(FACES), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, FACES
    path = tmp_path / "cube.ply"
    path.write_bytes("\n".join([*lines, ""]).encode() + vertices.tobytes() + rows.tobytes())
    (body,) = load_scene([path]).bodies
    file = file_of((vertices, FACES))
    assert file.resolution == body.file.resolution
    assert file.mesh.to_bytes() == body.file.mesh.to_bytes()
    assert file.health == body.file.health


@pytest.mark.parametrize("scale", [1e46, 1e300, 1e-46, 5e-324])
def test_a_mesh_out_of_range_is_refused_by_its_name(scale: float) -> None:
    with pytest.raises(SatcheckError, match="out of range") as caught:
        scene_of_meshes({"cube": (VERTICES * scale, FACES), "other": (VERTICES, FACES)})
    assert (caught.value.code, caught.value.body) == ("out-of-range", "cube")


QUARTER = np.array([[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]])


@pytest.mark.parametrize("pose", [QUARTER, QUARTER.tolist(), QUARTER.astype("float32")])
def test_a_pose_places_the_body(pose: Any) -> None:
    (body,) = scene_of_meshes({"cube": (VERTICES, FACES)}, {"cube": pose}).bodies
    assert body.world_mesh().bounds == ((4.0, 5.0, 6.0), (6.0, 7.0, 8.0))


def test_a_pose_is_as_precise_as_its_type() -> None:
    """A float32 pose puts a coordinate of 1 + 5 where float32 can tell, not float64."""

    def resolution(dtype: str) -> float:
        poses = {"cube": QUARTER.astype(dtype)}
        (body,) = scene_of_meshes({"cube": (VERTICES, FACES)}, poses).bodies
        return body.resolution_world

    assert resolution("float64") < 2.0**-44
    assert resolution("float32") > 2.0**-23


def test_the_identity_leaves_a_body_as_it_is() -> None:
    for pose in (None, np.eye(4)):
        (body,) = scene_of_meshes({"cube": (VERTICES, FACES)}, {"cube": pose}).bodies
        assert body.transform is None


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        ("cube.obj", "vertices and faces, or a pair .*, got str .satcheck.check takes paths, "),
        (None, "an object with vertices and faces, or a pair .vertices, faces., got NoneType"),
        ((VERTICES,), "got tuple"),
        ((VERTICES, FACES[:, :2]), r"faces: three integers a row, got shape \(12, 2\)"),
        ((VERTICES, FACES.ravel()), r"faces: three integers a row, got shape \(36,\)"),
        ((VERTICES[:, :2], FACES), r"vertices: three numbers a row, got shape \(8, 2\)"),
        (([], []), "vertices: empty"),
        ((np.zeros((0, 3)), FACES), "vertices: empty"),
        ((VERTICES, np.zeros((0, 3), int)), "faces: empty"),
        ((VERTICES, FACES.astype(float)), "faces: integers, got float64"),
        ((VERTICES, FACES > 3), "faces: integers, got bool"),
        ((VERTICES > 0, FACES), "vertices: integers or floats, got bool"),
        ((VERTICES.astype(complex), FACES), "vertices: integers or floats, got complex128"),
        (([["a", "b", "c"]], FACES), "vertices: integers or floats, got <U1"),
        (([[1, 2, 3], [4]], FACES), "vertices: not an array of numbers: setting an array"),
        ((VERTICES, FACES + 1), "faces: row 4 has the index 8: there are 8 vertices"),
        ((VERTICES, -FACES), "faces: row 0 has the index -1: there are 8 vertices"),
        ((VERTICES, FACES.astype("u8") + 2**63), "has the index 92233720368547758"),
        ((np.where(VERTICES > 0, np.nan, 0.5), FACES), "vertices: row . is not finite: .*nan"),
        ((np.full((8, 3), np.inf), FACES), "vertices: row 0 is not finite: .inf, inf, inf"),
        ((np.full((8, 3), 2**53 + 1), FACES), "integers up to 2..53, .* got 9007199254740993"),
    ],
)
def test_what_is_no_mesh_is_refused_in_words(mesh: Any, words: str) -> None:
    with pytest.raises(SatcheckError, match=f"^body 'cube': .*{words}") as refused:
        scene_of_meshes({"cube": mesh})
    assert refused.value.code == "bad-argument"


@pytest.mark.parametrize("given", ["cube.obj", SimpleNamespace(vertices=VERTICES, faces=FACES)])
def test_a_mesh_takes_arrays_and_names_what_takes_the_rest(given: Any) -> None:
    with pytest.raises(SatcheckError, match=r"Mesh\.of takes an object .*; Mesh\.read a file"):
        Prepared(given)


def test_a_mesh_that_a_file_could_not_hold_either_has_the_code_of_the_file() -> None:
    with pytest.raises(SatcheckError, match="only degenerate triangles") as refused:
        scene_of_meshes({"cube": (VERTICES * 0.0, FACES)})
    assert refused.value.code == "only-degenerate"


def with_entry(row: int, column: int, value: float) -> Any:
    pose = np.eye(4)
    pose[row, column] = value
    return pose


TRANSLATION = with_entry(0, 3, 2.0)
SHEAR = with_entry(0, 1, 0.1)


@pytest.mark.parametrize(
    ("pose", "words"),
    [
        (np.eye(3), r"a 4x4 matrix, got shape \(3, 3\)"),
        ("turned", "integers or floats, got <U6"),
        (with_entry(1, 3, np.nan), "row 1 is not finite"),
        (TRANSLATION.T, r"the last row is \(2, 0, 0, 1\), not \(0, 0, 0, 1\) .is it transposed"),
        (2.0 * np.eye(4), r"the last row is \(0, 0, 0, 2\), not \(0, 0, 0, 1\)$"),
        (SHEAR, "not rigid: it shears: its axes are not at right angles"),
        (np.diag([2, 2, 2, 1]), r"not rigid: it scales by \(2, 2, 2\); scale the vertices"),
        (np.diag([1, 1, 1.0001, 1]), r"not rigid: it scales by \(1, 1, 1.0001\)"),
        (np.diag([1, 1, 0, 1]), r"not rigid: it scales by \(1, 1, 0\)"),
        (np.diag([1e300, 1, 1, 1]), r"not rigid: it scales by \(1e\+300, 1, 1\)"),
        (with_entry(0, 1, 1e200), "not rigid: it shears"),
        (np.diag([1, 1, -1, 1]), "not rigid: it mirrors"),
    ],
)
def test_a_pose_that_is_not_rigid_is_refused_in_words(pose: Any, words: str) -> None:
    with pytest.raises(SatcheckError, match=f"^body 'cube': pose: .*{words}") as refused:
        scene_of_meshes({"cube": (VERTICES, FACES)}, {"cube": pose})
    assert refused.value.code == "bad-argument"


def test_a_pose_for_no_mesh_is_refused() -> None:
    with pytest.raises(SatcheckError, match="poses: no mesh has the id 'ball'"):
        scene_of_meshes({"cube": CUBE}, {"ball": np.eye(4)})


def test_an_id_that_is_no_text_is_refused() -> None:
    meshes: Any = {0: CUBE, "b": CUBE}
    with pytest.raises(SatcheckError, match="an id is a text, got 0"):
        scene_of_meshes(meshes)


def test_a_long_chain_of_float32_rotations_is_rigid() -> None:
    angle = np.float32(0.3)
    turn = np.eye(4, dtype="float32")
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    pose = np.linalg.matrix_power(turn, 30)
    assert np.abs(pose[:3, :3].T.astype(float) @ pose[:3, :3] - np.eye(3)).max() > 0
    scene_of_meshes({"cube": CUBE}, {"cube": pose})


def test_the_nodes_of_a_scene_of_trimesh_are_bodies_where_it_places_them() -> None:
    made = trimesh.Scene()
    made.add_geometry(CUBE, node_name="near", geom_name="cube")
    away = trimesh.transformations.translation_matrix((5.0, 0.0, 0.0))
    made.add_geometry(CUBE, node_name="far", geom_name="cube", transform=away)
    bodies = {body.id: body.world_mesh().bounds for body in scene_of_meshes(made).bodies}
    assert bodies == {"near": ((-1, -1, -1), (1, 1, 1)), "far": ((4, -1, -1), (6, 1, 1))}
    with pytest.raises(SatcheckError, match=r"a mapping or a trimesh\.Scene"):
        scene_of_meshes([CUBE])  # type: ignore[arg-type]
