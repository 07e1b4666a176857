"""The page with a 3-D view: one file, and the geometry in it is that of the bodies."""

from __future__ import annotations

import base64
import json
import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.cli.formats.picture.html import picture_data, render
from satcheck.cli.formats.picture.packing import STEPS, simplified
from satcheck.cli.formats.picture.parts import parts_of
from satcheck.core import Mesh
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Sphere
from satcheck.report.part_pairs import number_of
from satcheck.scene import load_scene
from satcheck.scene.meshes import scene_of_meshes
from tests.cli.process import PUSHED, SAMPLES, satcheck

DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)
BYTES_WITHOUT_GEOMETRY = 600_000


def page_data(page: str) -> dict[str, Any]:
    match = DATA.search(page)
    assert match is not None
    data: dict[str, Any] = json.loads(match[1])
    return {**data, "findings": json.loads(unpacked(data["findings"], "u1").tobytes())}


def unpacked(text: str, kind: str) -> Any:
    """As the page reads numbers."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8)
    rows = np.ascontiguousarray(planes.reshape(np.dtype(kind).itemsize, -1).T)
    return rows.view(kind).reshape(-1)


def sums(text: str, kind: str) -> Any:
    return np.cumsum(unpacked(text, kind), dtype=kind)


def vertices(data: dict[str, Any], body: int) -> Any:
    """As the page reads them, relative to the middle of the scene."""
    mesh = data["meshes"][data["bodies"]["meshes"][body]]
    steps = sums(mesh["corners"], "<u2").reshape(3, -1).T
    return steps / STEPS @ frames(data)[body][:, :3].T + frames(data)[body][:, 3]


def frames(data: dict[str, Any]) -> Any:
    return unpacked(data["bodies"]["frames"], "<f4").reshape(-1, 3, 4).astype(float)


def triangles(data: dict[str, Any], mesh: int) -> Any:
    return sums(data["meshes"][mesh]["triangles"], "<u4").reshape(-1, 3)


def test_the_page_is_one_file(tmp_path: Path) -> None:
    output = tmp_path / "out.html"
    assert satcheck(*PUSHED, "-o", str(output)).code == 1
    page = output.read_text()
    assert not re.search(r"""(src|href)\s*=|url\(|import\s""", page)
    assert "/* " not in DATA.sub("", page)
    assert len(page) < BYTES_WITHOUT_GEOMETRY
    assert [(f["a"], f["b"], f["relation"]) for f in page_data(page)["findings"]] == [
        (0, 1, "penetrating")
    ]


@pytest.mark.parametrize("names", [PUSHED, ("rack.3mf",)])
def test_geometry_is_that_of_the_world_to_half_a_step(names: tuple[str, ...]) -> None:
    scene = load_scene([str(SAMPLES / name) for name in names])
    data = picture_data(check(scene), scene)
    meshes = [np.asarray(body.world_mesh().vertices) for body in scene.bodies]
    corners = np.concatenate(meshes)
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    for k, (body, mesh) in enumerate(zip(scene.bodies, meshes, strict=True)):
        # Half a step of each of three axes, and the rounding of each float32 of the frame.
        frame = np.abs(frames(data)[k])
        error = 0.5 * frame[:, :3].sum(axis=1) / STEPS + 2.0**-24 * frame.sum(axis=1)
        assert (np.abs(vertices(data, k) + middle - mesh) <= error).all()
        shown = triangles(data, data["bodies"]["meshes"][k])
        assert (shown == np.asarray(body.file.mesh.triangles)).all()


def test_each_element_that_a_script_names_is_in_the_page() -> None:
    scene = load_scene([str(SAMPLES / name) for name in PUSHED])
    page = render(check(scene), scene)
    named = set(re.findall(r"""element\("([\w-]+)"\)""", page))
    assert len(named) > 15
    assert named <= set(re.findall(r'id="([\w-]+)"', page))


def test_copies_share_their_geometry() -> None:
    scene = load_scene([str(SAMPLES / "rack.3mf")])
    data = picture_data(check(scene), scene)
    bodies = data["bodies"]
    posts = [bodies["meshes"][k] for k, id_ in enumerate(bodies["ids"]) if "post" in id_]
    assert len(posts) == 2
    assert len(set(posts)) == 1


@pytest.mark.parametrize(("name", "up"), [("gripper.glb", "y"), ("rack.3mf", "z")])
def test_the_axis_that_points_up_is_that_of_the_format(name: str, up: str) -> None:
    scene = load_scene([str(SAMPLES / name)])
    assert picture_data(check(scene), scene)["up"] == up


def test_the_worst_finding_comes_first() -> None:
    scene = load_scene([str(SAMPLES / "gripper.glb")])
    severities = [f["severity"] for f in picture_data(check(scene), scene)["findings"]]
    assert severities == ["error", "note", "note", "note"]


def ball(segments: int) -> Mesh:
    return mesh_of(Sphere(radius=1.0), segments)


@pytest.mark.parametrize("room", [8_000, 5_000, 0])
def test_bodies_without_findings_are_simplified_until_they_fit(
    monkeypatch: pytest.MonkeyPatch, room: int
) -> None:
    monkeypatch.setattr("satcheck.cli.formats.picture.html.ROOM", room)
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    tip = (corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    far = (np.asarray(ball(64).vertices) + 5.0, np.asarray(ball(64).triangles))
    scene = scene_of_meshes({"a": tip, "b": ball(8), "far": far})
    data = picture_data(check(scene), scene)
    assert "1 body without findings" in data["simplified"]
    assert ("boxes" in data["simplified"]) is (room == 0)
    packed = [len("".join(mesh.values())) for mesh in data["meshes"]]
    assert room == 0 or sum(packed) <= room
    for k in (0, 1):
        shown = triangles(data, data["bodies"]["meshes"][k])
        assert len(shown) == scene.bodies[k].file.mesh.triangle_count
    shape = vertices(data, 2)
    assert len(shape) < len(far[0])
    middle = (-1.0 + 6.0) / 2
    assert np.abs(shape + middle - 5.0).max() <= 1.0 + 2.0 / 8


@pytest.mark.parametrize("cells", [4, 16, 64])
def test_a_simplified_mesh_is_within_a_cell_of_the_mesh(cells: int) -> None:
    mesh = ball(64)
    coarse = simplified(mesh, cells)
    assert coarse.triangle_count <= mesh.triangle_count
    radii = np.linalg.norm(coarse.vertices, axis=1)
    diagonal = 3**0.5 * 2.0 / cells
    assert radii.max() <= 1.0 + 1e-12
    assert radii.min() >= 1.0 - diagonal
    corners = np.asarray(coarse.vertices)[np.asarray(coarse.triangles)]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume > 0.0  # still wound outward


def test_a_mesh_within_one_cell_stays_as_it_is() -> None:
    mesh = ball(8)
    assert simplified(mesh, 1).triangle_count == mesh.triangle_count


def test_what_each_rung_sees() -> None:
    """Hulls of bodies with findings, and their parts where these are given."""
    scene = load_scene([str(SAMPLES / name) for name in ("l_bracket.obj", "peg_in_arm.ply")])
    report = check(scene)
    parts = parts_of(report, scene)
    data = picture_data(report, scene, parts)
    assert set(data["hulls"]) == {0, 1}
    hull = triangles(data, data["hulls"][0])
    assert len(hull) == scene.bodies[0].file.mesh.convex_hull().to_mesh().triangle_count
    split = data["parts"][0]
    assert len(split["triangles"]) == len(parts["l_bracket"]) > 1
    assert sum(split["triangles"]) == len(triangles(data, split["mesh"]))


@pytest.mark.parametrize("asked", [False, True])
def test_the_page_knows_which_parts_overlap(asked: bool) -> None:
    names = [str(SAMPLES / name) for name in ("l_bracket.obj", "peg_in_arm.ply")]
    scene = load_scene(names)
    report = check(scene, Settings(parts=asked, depth=False))
    (shown,) = picture_data(report, scene, parts_of(report, scene))["findings"]
    if not asked:
        assert shown["parts"] == ([], [])
        return
    (pair,) = report.findings[0].part_pairs.pairs  # type: ignore[union-attr]
    assert shown["parts"] == ([number_of(pair.a)], [1])


def test_figures_of_a_finding_are_in_the_frame_of_the_page() -> None:
    names = [str(SAMPLES / name) for name in ("l_bracket.obj", "peg_in_arm.ply")]
    scene = load_scene(names)
    (finding,) = check(scene, Settings(components=True, contacts=True)).findings
    data = picture_data(check(scene, Settings(components=True)), scene)
    (shown,) = data["findings"]
    corners = np.concatenate([np.asarray(body.world_mesh().vertices) for body in scene.bodies])
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    assert finding.ball is not None
    assert finding.components is not None
    assert finding.contacts is not None
    assert shown["ball"]["centre"] == pytest.approx(np.array(finding.ball.centre) - middle)
    assert shown["ball"]["radius"] == finding.ball.radius
    assert shown["axis"] == finding.normal
    assert "move l_bracket by " in " ".join(label[0] for label in shown["labels"])
    (component,) = shown["components"]
    assert component["low"] == pytest.approx(
        np.array(finding.components.items[0].bounds[0]) - middle
    )
    low, high = np.array(shown["box"])
    points = sums(shown["points"], "<u2").reshape(3, -1).T / STEPS * (high - low) + low
    (curve,) = finding.contacts.curves
    off = (high - low).max() / STEPS
    assert points[: len(curve.points)] == pytest.approx(np.array(curve.points) - middle, abs=off)
    assert sum(shown["lines"]) == len(points)


def test_a_page_lists_the_worst_findings_and_counts_the_others(tmp_path: Path) -> None:
    """Fifty copies of a body at one place have 1,225 pairs."""
    box = 'shape = {type = "box", size = [1, 1, 1]}'
    bodies = "\n".join(f'[[bodies]]\nid = "b{k}"\n{box}' for k in range(50))
    (tmp_path / "scene.toml").write_text(f'schema = "satcheck.scene/1"\n{bodies}')
    scene = load_scene([str(tmp_path / "scene.toml")])
    data = picture_data(check(scene), scene)
    assert (len(data["findings"]), data["unlisted"]) == (1000, 225)


def test_what_cannot_be_drawn_is_told() -> None:
    """A pair with a body that cannot be read, and the issue of that body."""
    scene = load_scene([str(SAMPLES / name) for name in (*PUSHED, "missing.obj")])
    data = picture_data(check(scene), scene)
    undrawn = [f["names"] for f in data["findings"] if None in (f["a"], f["b"])]
    assert undrawn == [["box", "missing"], ["box_pushed", "missing"]]
    assert any("missing.obj" in text for text in data["issues"])


def test_coordinates_beyond_the_renderer_have_no_picture(tmp_path: Path) -> None:
    text = "v 0 0 0\nv {0} 0 0\nv 0 {0} 0\nv 0 0 {0}\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "a.obj").write_text(text.format("1e42"))
    (tmp_path / "b.obj").write_text(text.format("2e42"))
    output = tmp_path / "out.html"
    names = (str(tmp_path / "a.obj"), str(tmp_path / "b.obj"))
    assert satcheck(*names, "-o", str(output)).code == 1
    data = page_data(output.read_text())
    assert (data["drawn"], data["bodies"]["ids"], len(data["findings"])) == (False, [], 1)


@pytest.mark.parametrize("more", [("--planar", "xy"), ("--accuracy", "hull")])
def test_a_check_without_contacts_has_a_page(more: tuple[str, ...], tmp_path: Path) -> None:
    ran = satcheck(*more, *PUSHED, "-o", str(tmp_path / "out.html"))
    assert ran.code == 1


def test_names_are_never_markup(tmp_path: Path) -> None:
    for name in PUSHED:
        text = (SAMPLES / name).read_bytes()
        (tmp_path / f"<script>alert(1)<{name}").write_bytes(text)
    scene = load_scene(sorted(map(str, tmp_path.iterdir())))
    page = render(check(scene), scene)
    assert "<script>alert" not in page
    assert "<script>alert(1)<" in json.dumps(page_data(page))
