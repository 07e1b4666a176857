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

from satcheck.audit import check
from satcheck.cli.report.picture.data import STEPS, picture_data
from satcheck.cli.report.picture.html import render
from satcheck.scene import load_scene
from tests.cli.process import PUSHED, SAMPLES, satcheck

DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)
BYTES_WITHOUT_GEOMETRY = 600_000


def page_data(page: str) -> dict[str, Any]:
    match = DATA.search(page)
    assert match is not None
    data = json.loads(match[1])
    assert isinstance(data, dict)
    return data


def vertices(mesh: dict[str, Any], frame: list[float]) -> Any:
    """As the page reads them, relative to the middle of the scene."""
    raw = zlib.decompress(base64.b64decode(mesh["data"]))
    steps = np.frombuffer(raw, "<u2", mesh["vertices"] * 3).reshape(-1, 3)
    rows = np.array(frame).reshape(3, 4)
    return steps / STEPS @ rows[:, :3].T + rows[:, 3]


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
    for body, mesh in zip(data["bodies"], meshes, strict=True):
        shown = vertices(data["meshes"][body["mesh"]], body["frame"])
        # Half a step of each of three axes, and 8 digits of each number of the frame.
        frame = np.abs(np.array(body["frame"]).reshape(3, 4))
        error = 0.5 * frame[:, :3].sum(axis=1) / STEPS + 5e-8 * frame.sum(axis=1)
        assert (np.abs(shown + middle - mesh) <= error).all()


def test_copies_share_their_geometry() -> None:
    scene = load_scene([str(SAMPLES / "rack.3mf")])
    data = picture_data(check(scene), scene)
    posts = [body["mesh"] for body in data["bodies"] if "post" in body["id"]]
    assert len(posts) == 2
    assert len(set(posts)) == 1


def test_the_worst_finding_comes_first() -> None:
    scene = load_scene([str(SAMPLES / "gripper.glb")])
    severities = [f["severity"] for f in picture_data(check(scene), scene)["findings"]]
    assert severities == ["error", "note", "note", "note"]


def test_bodies_without_findings_are_boxes_in_a_large_scene(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("satcheck.cli.report.picture.data.MOST_TRIANGLES", 10)
    scene = load_scene([str(SAMPLES / name) for name in (*PUSHED, "far_a.obj")])
    data = picture_data(check(scene), scene)
    assert data["simplified"]
    far = data["bodies"][2]
    corners = vertices(data["meshes"][far["mesh"]], far["frame"])
    assert len(corners) == 8
    extent = corners.max(axis=0) - corners.min(axis=0)
    assert extent == pytest.approx(far["size"], rel=1e-7)


def test_what_cannot_be_drawn_is_told() -> None:
    """A pair with a body that cannot be read, and the issue of that body."""
    scene = load_scene([str(SAMPLES / name) for name in (*PUSHED, "missing.obj")])
    data = picture_data(check(scene), scene)
    undrawn = [f["names"] for f in data["findings"] if None in (f["a"], f["b"])]
    assert undrawn == ["box and missing", "box_pushed and missing"]
    assert any("missing.obj" in text for text in data["issues"])


def test_coordinates_beyond_the_renderer_have_no_picture(tmp_path: Path) -> None:
    text = "v 0 0 0\nv {0} 0 0\nv 0 {0} 0\nv 0 0 {0}\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "a.obj").write_text(text.format("1e100"))
    (tmp_path / "b.obj").write_text(text.format("2e100"))
    output = tmp_path / "out.html"
    names = (str(tmp_path / "a.obj"), str(tmp_path / "b.obj"))
    assert satcheck(*names, "-o", str(output)).code == 1
    data = page_data(output.read_text())
    assert (data["drawn"], data["bodies"], len(data["findings"])) == (False, [], 1)


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
