"""check_meshes answers for arrays what a check answers for files that hold them."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from satcheck.audit import Settings, check
from satcheck.audit.meshes import check_meshes
from satcheck.core.errors import SatcheckError

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


def test_certificates_need_files() -> None:
    with pytest.raises(SatcheckError, match="certificates name files") as refused:
        check_meshes(CUBE, CUBE, settings=Settings(certificate=True))
    assert refused.value.code == "bad-setting"
