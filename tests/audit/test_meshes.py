"""check_meshes answers for arrays what a check answers for files that hold them."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from satcheck.audit import Settings, check
from satcheck.audit.body import SharedMesh
from satcheck.audit.meshes import check_meshes
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from satcheck.scene.meshes import Mesh, scene_of_meshes

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
KETTLE = trimesh.load_mesh(SAMPLES / "kettle.obj", process=False)
CUBE = trimesh.creation.box((2.0, 2.0, 2.0))


def moved(x: float) -> Any:
    return trimesh.transformations.translation_matrix([x, 0.0, 0.0])


def test_an_overlap_has_a_depth_and_a_way_out() -> None:
    result = check_meshes(CUBE, CUBE, pose_b=moved(1.5))
    assert (result.a, result.b) == ("a", "b")
    assert result.relation == "penetrating"
    assert result.depth == 0.5
    assert result.mtv == (-0.5, 0.0, 0.0)
    assert result.mtv_verified
    assert result.quality == "exact"


def test_a_gap_is_measured_up_to_the_clearance() -> None:
    apart = check_meshes(CUBE, CUBE, pose_b=moved(3.0))
    assert (apart.relation, apart.distance) == ("separated", None)
    near = check_meshes(CUBE, CUBE, pose_b=moved(3.0), settings=Settings(clearance=2.0))
    assert (near.relation, near.distance) == ("near", 1.0)


@pytest.mark.parametrize("x", [0.0, 1.5, 2.0, 3.0, 2e45])
@pytest.mark.parametrize(
    "settings",
    [
        Settings(),
        Settings(depth=False, list_pruned=True),
        Settings(distance=True, fail_on="note"),
        Settings(clearance=1.5),
        Settings(max_depth=0.25),
        Settings(accuracy="hull", tolerance=0.75),
        Settings(volume=True, contacts=True),
        Settings(planar="xy"),
    ],
)
def test_a_finding_is_that_of_the_report_of_both(x: float, settings: Settings) -> None:
    poses = {"b": moved(x)}
    report = check(scene_of_meshes({"a": CUBE, "b": KETTLE}, poses), settings)
    finding = check_meshes(CUBE, KETTLE, pose_b=poses["b"], settings=settings)
    assert [finding.to_dict(timings=False)] == report.to_dict(timings=False)["findings"]


def test_a_finding_comes_even_when_a_report_would_leave_it_out() -> None:
    settings = Settings(list_pruned=False)
    assert check_meshes(CUBE, CUBE, pose_b=moved(9.0), settings=settings).relation == "separated"


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("ulps", [-1, 0, 1])
def test_float32_touches_where_float64_tells(dtype: str, ulps: int) -> None:
    """A gap of one step of float32 is within the precision of float32 arrays, not of float64."""
    vertices = np.asarray(CUBE.vertices)
    step = 2.0**-23
    shifted = vertices + np.array((2.0 + ulps * step, 0.0, 0.0))
    result = check_meshes((vertices.astype(dtype), CUBE.faces), (shifted.astype(dtype), CUBE.faces))
    exact = {-1: "penetrating", 0: "touching", 1: "separated"}[ulps]
    assert result.relation == ("touching" if dtype == "float32" else exact)


@pytest.mark.parametrize(
    "settings",
    [
        Settings(),
        Settings(clearance=0.5),
        Settings(volume=True, contacts=True),
        Settings(accuracy="parts"),
        Settings(accuracy="hull"),
    ],
)
@pytest.mark.parametrize("other", ["torus", "ball", "open", "inside"])
def test_verdicts_are_those_of_files(other: str, settings: Settings, tmp_path: Path) -> None:
    torus = trimesh.creation.torus(1.0, 0.3, major_sections=12, minor_sections=8)
    mesh = {
        "torus": torus.copy().apply_translation([0.9, 0.1, 0.2]),
        "ball": trimesh.creation.icosphere(1).apply_translation([1.5, 0.1, 0.0]),
        "open": trimesh.Trimesh(CUBE.vertices, CUBE.faces[:-1]).apply_translation([1.1, 0, 0]),
        "inside": trimesh.creation.box((0.1, 0.1, 0.1)).apply_translation([1.0, 0, 0]),
    }[other]
    for name, one in (("a", torus), ("b", mesh)):
        write_ply(tmp_path / f"{name}.ply", one)
    (of_files,) = check([tmp_path / "a.ply", tmp_path / "b.ply"], settings).findings
    of_meshes = check_meshes(torus, mesh, settings=settings)
    for name in ("relation", "exact_relation", "depth", "depth_bounds", "mtv", "distance"):
        assert getattr(of_meshes, name) == getattr(of_files, name), name
    for name in ("severity", "quality", "undecided", "tolerance", "witness", "volume", "contacts"):
        assert getattr(of_meshes, name) == getattr(of_files, name), name


def write_ply(path: Path, mesh: Any) -> None:
    """Vertices as float64, which trimesh does not write."""
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(mesh.vertices)}"]
    lines += [f"property double {axis}" for axis in "xyz"]
    lines += [f"element face {len(mesh.faces)}", "property list uchar int vertex_indices"]
    header = "\n".join([*lines, "end_header", ""])
    rows = np.zeros(len(mesh.faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, mesh.faces
    vertices = np.asarray(mesh.vertices, dtype="<f8")
    path.write_bytes(header.encode() + vertices.tobytes() + rows.tobytes())


def masked(values: Any) -> Any:
    """An array of which the first value is masked."""
    array = np.ma.masked_array(values)
    array[0, 0] = np.ma.masked
    return array


@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("vertices", lambda: check_meshes((masked(CUBE.vertices), CUBE.faces), CUBE)),
        ("vertices", lambda: Mesh([*masked(CUBE.vertices)], CUBE.faces)),
        ("faces", lambda: Mesh(CUBE.vertices, masked(CUBE.faces))),
        ("pose", lambda: check_meshes(CUBE, CUBE, pose_b=masked(moved(9.0)))),
        ("pose", lambda: scene_of_meshes({"a": CUBE}, {"a": masked(moved(9.0))})),
    ],
)
def test_masked_values_are_refused(name: str, call: Any) -> None:
    with pytest.raises(SatcheckError, match=f"{name}: masked values are no numbers") as raised:
        call()
    assert raised.value.code == "bad-argument"


def test_an_array_that_masks_nothing_is_an_array() -> None:
    unmasked = np.ma.masked_array(CUBE.vertices)
    assert check_meshes((unmasked, CUBE.faces), CUBE, pose_b=moved(1.5)).depth == 0.5


def test_certificates_need_files() -> None:
    with pytest.raises(SatcheckError, match="certificates name files") as refused:
        check_meshes(CUBE, CUBE, settings=Settings(certificate=True))
    assert refused.value.code == "bad-setting"


POSES = [None, moved(0.3), moved(0.75), moved(9.0)]


def hierarchies(mesh: Mesh) -> list[int]:
    """For each set of settings with which it was checked."""
    prepared: Any = mesh.named("a").prepared
    return [shared.geometry.hierarchies for shared in prepared.values()]


@pytest.mark.parametrize("settings", [Settings(), Settings(depth=False), Settings(clearance=9.0)])
def test_a_prepared_mesh_has_the_answers_of_its_arrays(settings: Settings) -> None:
    kettle, cube = Mesh.of(KETTLE), Mesh.of(CUBE)
    for pose in POSES:
        mine = check_meshes(kettle, cube, pose_b=pose, settings=settings)
        arrays = check_meshes(KETTLE, CUBE, pose_b=pose, settings=settings)
        assert mine.to_dict(timings=False) | {"plan": 0} == arrays.to_dict(timings=False) | {
            "plan": 0
        }


def test_a_prepared_mesh_is_prepared_once() -> None:
    """Its tree, for all places and all checks of scenes, and for each of two settings."""
    kettle = Mesh.of(KETTLE)
    for pose in POSES:
        check_meshes(kettle, kettle, pose_b=pose)
        check(scene_of_meshes({"x": kettle, "y": CUBE}, {"x": pose}))
    assert hierarchies(kettle) == [1]
    check_meshes(kettle, CUBE, settings=Settings(allow_open=True))
    assert hierarchies(kettle) == [1, 1]


def test_what_prepared_data_depend_on_is_what_makes_them() -> None:
    """Settings that `terms` leaves out are not read while a mesh is prepared."""
    read: set[str] = set()

    class Watched:
        def __getattr__(self, name: str) -> Any:
            read.add(name)
            return getattr(Settings(), name)

    file = Mesh.of(CUBE).named("a")
    watched: Any = Watched()
    SharedMesh.terms(watched)
    named, read = read, set()
    shared = SharedMesh(file, watched)
    shared.decomposition()
    shared.shape()
    assert read <= named


def test_a_check_in_a_plane_prepares_its_outlines_anew() -> None:
    cube = Mesh.of(CUBE)
    flat = Settings(planar="xy", thickness=False)
    for x, depth in ((1.5, 0.5), (1.0, 1.0), (1.5, 0.5)):
        assert check_meshes(cube, cube, pose_b=moved(x), settings=flat).depth == depth
    assert check_meshes(cube, cube, pose_b=moved(1.75)).depth == 0.25


def test_a_prepared_mesh_is_as_precise_as_its_arrays() -> None:
    flush = np.asarray(CUBE.vertices) + np.array((2.0 - 2.0**-23, 0.0, 0.0))
    fine = Mesh(flush, CUBE.faces)
    coarse = Mesh(flush.astype("float32"), CUBE.faces)
    assert check_meshes(CUBE, fine).relation == "penetrating"
    assert check_meshes(CUBE, coarse).relation == "touching"


def test_a_prepared_mesh_of_a_file() -> None:
    from_file = Mesh.read(SAMPLES / "kettle.obj")
    assert from_file.faces.shape == KETTLE.faces.shape
    assert np.array_equal(np.sort(from_file.vertices, axis=0), np.sort(KETTLE.vertices, axis=0))
    in_files = check([SAMPLES / "box.obj", SAMPLES / "box_pushed.stl"]).findings[0]
    read = check_meshes(*(Mesh.read(SAMPLES / name) for name in ("box.obj", "box_pushed.stl")))
    for field in ("relation", "tolerance", "depth_bounds", "thickness_bounds", "mtv"):
        assert getattr(read, field) == getattr(in_files, field)


@pytest.mark.parametrize(
    ("name", "code"),
    [("gone.obj", "file-not-found"), ("cell.toml", "bad-argument"), ("arm.urdf", "bad-argument")],
)
def test_a_file_that_is_no_mesh_is_refused(name: str, code: str) -> None:
    with pytest.raises(SatcheckError) as raised:
        Mesh.read(SAMPLES / name)
    assert raised.value.code == code


def test_a_prepared_mesh_cannot_change() -> None:
    vertices = np.array(CUBE.vertices)
    cube = Mesh(vertices, CUBE.faces)
    vertices *= 2.0
    assert cube.vertices.max() == 1.0
    with pytest.raises(ValueError, match="read-only"):
        cube.vertices[0] = 9.0
    for name in ("vertices", "faces", "other"):
        with pytest.raises(AttributeError):
            setattr(cube, name, vertices)


TWO = trimesh.Scene({"a": CUBE, "b": CUBE})


@pytest.mark.parametrize(
    ("call", "function"),
    [
        (lambda: check([CUBE, CUBE]), "check_meshes"),
        (lambda: check(TWO), "scene_of_meshes"),
        (lambda: check({"a": CUBE}), "scene_of_meshes"),
        (lambda: load_scene([CUBE]), "scene_of_meshes"),
        (lambda: scene_of_meshes([CUBE, CUBE]), "check_meshes"),
        (lambda: check_meshes(TWO, CUBE), "scene_of_meshes"),
        (lambda: check_meshes([CUBE, CUBE], CUBE), "scene_of_meshes"),
        (lambda: check_meshes("box.obj", CUBE), "satcheck.check "),
        (lambda: Mesh.of("box.obj"), "satcheck.check "),
    ],
)
def test_what_another_function_takes_is_refused_with_its_name(call: Any, function: str) -> None:
    with pytest.raises(SatcheckError) as raised:
        call()
    assert raised.value.code == "bad-argument"
    assert function in str(raised.value)


@pytest.mark.parametrize(
    ("x", "relation", "distance"),
    [(1.5, "penetrating", None), (2.0, "touching", 0.0), (3.0, "separated", 1.0)],
)
def test_a_distance_needs_no_clearance(x: float, relation: str, distance: float | None) -> None:
    """It changes no verdict."""
    found = check_meshes(CUBE, CUBE, pose_b=moved(x), settings=Settings(distance=True))
    plain = check_meshes(CUBE, CUBE, pose_b=moved(x))
    assert (found.relation, found.distance) == (relation, distance)
    assert (found.relation, found.severity, found.depth) == (
        plain.relation, plain.severity, plain.depth
    )  # fmt: skip


@pytest.mark.parametrize("file", ["cell.toml", "arm.urdf", "yard.sdf", "crossed_edges.toml"])
def test_a_distance_of_every_pair_of_a_scene(file: str) -> None:
    """Also of those whose boxes are far apart, and beside rules with clearances."""
    measured, plain = (check([SAMPLES / file], Settings(distance=d)) for d in (True, False))
    assert measured.summary.verdict == plain.summary.verdict
    assert [(f.relation, f.severity, f.depth) for f in measured.findings] == [
        (f.relation, f.severity, f.depth) for f in plain.findings
    ]
    apart = [f for f in measured.findings if f.relation in ("separated", "near", "touching")]
    assert apart
    assert all(f.distance is not None for f in apart)
    (effect,) = [each for each in measured.effects if each.effect == "distance"]
    assert "distance" in effect.asked_by


def test_a_distance_in_a_plane() -> None:
    flat = Settings(planar="xy", thickness=False, distance=True)
    found = check_meshes(CUBE, CUBE, pose_b=moved(5.0), settings=flat)
    assert (found.relation, found.distance) == ("separated", 3.0)
