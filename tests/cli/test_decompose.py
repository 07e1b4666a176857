"""`satcheck decompose` as a whole process: the parts it writes, its report, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from satcheck.scene import load_scene
from tests.cli.process import private_cache, satcheck

CONCAVE = "l_bracket.obj"


def parts(path: Path) -> dict[str, Any]:
    """Meshes of trimesh by their names, as placed: trimesh shares no code with the writer."""
    options: dict[str, Any] = {}
    if path.suffix == ".obj":
        options = {"split_objects": True, "group_material": False}
    scene = trimesh.load_scene(path, **options)
    placed = [scene.graph[node] for node in scene.graph.nodes_geometry]
    return {
        str(name): scene.geometry[name].copy().apply_transform(matrix) for matrix, name in placed
    }


def test_a_convex_mesh_is_its_own_part(tmp_path: Path) -> None:
    output = tmp_path / "parts.obj"
    ran = satcheck("decompose", "--format", "json", "box.obj", "-o", str(output))
    assert ran.code == 0
    (body,) = ran.document["bodies"]
    assert (body["outside"], body["missing"]) == (0.0, 0.0)
    assert [part["vertices"] for part in body["parts"]] == [8]
    assert ran.document["rounding"] == 0.0
    again = satcheck("--format", "json", "box.obj", str(output))
    assert again.document["findings"][0]["relation"] == "coincident"


@pytest.mark.parametrize("suffix", [".glb", ".obj"])
def test_a_concave_mesh_becomes_named_convex_parts(tmp_path: Path, suffix: str) -> None:
    output, places = tmp_path / f"parts{suffix}", private_cache(tmp_path)
    ran = satcheck("decompose", "--format", "json", CONCAVE, "-o", str(output), env=places)
    assert ran.code == 0
    (body,) = ran.document["bodies"]
    names = [part["name"] for part in body["parts"]]
    assert names == [f"l_bracket-{number}" for number in range(1, len(names) + 1)]
    assert len(names) > 1
    written = parts(output)
    assert sorted(written) == sorted(names)
    # Rounded to float32, a face may be off its plane by the rounding of its corners.
    slack = 4 * ran.document["rounding"] + 1e-12
    for part in body["parts"]:
        mesh = written[part["name"]]
        assert (len(mesh.vertices), len(mesh.faces)) == (part["vertices"], part["triangles"])
        heights = np.einsum(
            "fvc,fc->fv", mesh.vertices[None] - mesh.triangles[:, :1], mesh.face_normals
        )
        assert heights.max() <= slack
    mesh = load_scene(["sample_meshes/l_bracket.obj"], split="none").bodies[0].world_mesh()
    low, high = (np.array(corner) for corner in mesh.bounds)
    corners = np.concatenate([part.vertices for part in written.values()])
    reach = body["outside"] + ran.document["rounding"]
    assert (corners >= low - reach).all()
    assert (corners <= high + reach).all()


def test_an_stl_file_holds_all_parts(tmp_path: Path) -> None:
    output, places = tmp_path / "parts.stl", private_cache(tmp_path)
    arguments = ("decompose", "--format", "json", CONCAVE, "box.obj", "-o", str(output))
    ran = satcheck(*arguments, env=places)
    triangles = sum(part["triangles"] for body in ran.document["bodies"] for part in body["parts"])
    assert len(trimesh.load_mesh(output).faces) == triangles


def test_each_node_of_a_file_is_a_body_where_the_file_places_it(tmp_path: Path) -> None:
    output = tmp_path / "parts.glb"
    arguments = ("decompose", "--threshold", "0.5", "gripper.glb", "-o", str(output))
    ran = satcheck(*arguments, env=private_cache(tmp_path))
    assert ran.code == 0
    assert "\n4 bodies, " in ran.out
    written = parts(output)
    for body in load_scene(["sample_meshes/gripper.glb"]).bodies:
        named = [mesh for name, mesh in written.items() if name.startswith(f"{body.id}-")]
        assert named
        ours = np.array([body.world_mesh().bounds[0], body.world_mesh().bounds[1]])
        corners = np.concatenate([mesh.vertices for mesh in named])
        extent = float(np.ptp(ours, axis=0).max())
        assert np.abs(corners.min(axis=0) - ours[0]).max() < extent
        assert np.abs(corners.max(axis=0) - ours[1]).max() < extent


def test_a_glb_file_is_in_metres_where_the_unit_is_known(tmp_path: Path) -> None:
    output = tmp_path / "parts.glb"
    assert satcheck("decompose", "--units", "mm", "box.obj", "-o", str(output)).code == 0
    ran = satcheck("--units", "mm", "--format", "json", "box.obj", str(output))
    assert ran.document["findings"][0]["relation"] in ("coincident", "contains", "inside")
    (mesh,) = parts(output).values()
    box = load_scene(["sample_meshes/box.obj"], split="none").bodies[0].world_mesh()
    assert mesh.bounds * 1000 == pytest.approx(np.array(box.bounds))


def test_an_open_mesh_is_rebuilt_and_the_report_says_so(tmp_path: Path) -> None:
    arguments = ("decompose", "--threshold", "1", "--format", "json", "open_box.off")
    ran = satcheck(*arguments, env=private_cache(tmp_path))
    assert ran.code == 0
    (body,) = ran.document["bodies"]
    assert "decomposition-remeshed" in [note["code"] for note in body["notes"]]
    assert body["outside"] > 0
    assert [issue["code"] for issue in ran.document["issues"]] == ["not-closed"]


def test_a_coarser_threshold_gives_fewer_parts(tmp_path: Path) -> None:
    places = private_cache(tmp_path)
    counts = [
        len(
            satcheck(
                *("decompose", "--threshold", threshold, "--format", "json", "ring.glb"),
                env=places,
            ).document["bodies"][0]["parts"]
        )
        for threshold in ("1", "0.1")
    ]
    assert counts[0] < counts[1]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "give a mesh file or a scene"),
        (("box.obj", "-o", "parts.ply"), "this command writes .glb, .obj, .stl"),
        (("box.obj", "-o", "no/such/folder/parts.obj"), "folder does not exist"),
        (("box.obj", "-o", "box.obj"), "would overwrite an input"),
        (("cube.off", "-o", "a.glb", "-o", "b.stl"), "a.glb is named for that"),
        (("box.obj", "--threshold", "0"), "--threshold"),
        (("box.obj", "--threshold", "1.5"), "--threshold"),
        (("gone.obj",), "gone.obj: no such file"),
    ],
)
def test_refusals(arguments: tuple[str, ...], words: str) -> None:
    ran = satcheck("decompose", *arguments)
    assert (ran.code, ran.out) == (2, "")
    assert words in ran.err
    assert "Traceback" not in ran.err


def test_a_flat_mesh_has_no_parts_and_no_file(tmp_path: Path) -> None:
    flat, output = tmp_path / "flat.obj", tmp_path / "parts.glb"
    flat.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    alone = satcheck("decompose", str(flat), "-o", str(output))
    assert alone.code == 2
    assert "[decomposition-flat-mesh]" in alone.err
    assert not output.exists()
    beside = satcheck("decompose", str(flat), "box.obj", "-o", str(output))
    assert beside.code == 3
    assert list(parts(output)) == ["box-1"]


@pytest.mark.parametrize(
    ("shape", "code"),
    [({"type": "sphere", "radius": 1}, "curved-shape"), ({"type": "half-space"}, "half-space")],
)
def test_what_has_no_triangles_has_no_parts(
    tmp_path: Path, shape: dict[str, object], code: str
) -> None:
    bodies = [{"id": "one", "shape": shape}]
    scene = tmp_path / "scene.json"
    scene.write_text(json.dumps({"schema": "satcheck.scene/1", "bodies": bodies}), "utf-8")
    ran = satcheck("decompose", "--format", "json", str(scene))
    assert ran.code == 2
    assert ran.document["bodies"][0]["failure"]["code"] == code


def test_the_report_goes_to_a_file(tmp_path: Path) -> None:
    report = tmp_path / "report.json"
    ran = satcheck("decompose", "box.obj", "-o", str(report), env=private_cache(tmp_path))
    assert (ran.code, ran.out) == (0, "")
    assert json.loads(report.read_text())["schema"] == "satcheck.decomposition/1"
