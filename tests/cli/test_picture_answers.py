"""What pictures show of answers about single bodies: what fails, forces, falls, no regions."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import matplotlib.image
import numpy as np

from satcheck.audit import Settings, check
from satcheck.cli.formats.picture.body_answers import arrows_of, states_of, without_regions
from satcheck.cli.formats.picture.html import picture_data
from satcheck.cli.formats.picture.png import ARROW, FAILS, FORCE, KINDS, render
from satcheck.cli.formats.picture.raster import MARKS
from satcheck.report.report import Report
from satcheck.scene import Scene
from tests.audit.statics.scenes import box, floor, loaded, tower

Json = dict[str, Any]
ASKED = {"bodies": "*", "supported": True}
SIZE = (400, 300)


def checked(folder: Path, bodies: list[Json], *rules: Json) -> tuple[Report, Scene]:
    scene = loaded(folder, bodies, [ASKED, *rules])
    return check(scene, Settings(jobs=1)), scene


def share_of(image: bytes, kind: int) -> float:
    """Of the pixels that have the hue of this kind, whatever the light."""
    pixels = matplotlib.image.imread(io.BytesIO(image))[..., :3]
    colour = np.array(KINDS[kind].colour)
    size = np.linalg.norm(pixels, axis=-1) * max(np.linalg.norm(colour), 1e-9)
    return float(((pixels @ colour) / np.where(size > 0, size, 1.0) > 0.995).mean())


def test_forces_point_against_gravity(tmp_path: Path) -> None:
    report, scene = checked(tmp_path, tower(0.3))
    arrows = arrows_of(report, scene)
    assert {arrow.kind for arrow in arrows} == {"force"}
    assert all(arrow.way[2] > 0 for arrow in arrows)
    image = render(report, scene, SIZE)
    assert share_of(image, FORCE) > 0
    assert share_of(image, FAILS) == 0


def test_falls_point_along_gravity(tmp_path: Path) -> None:
    bodies = [floor(), box("lamp", [1, 1, 1], [0, 0, 3])]
    report, scene = checked(tmp_path, bodies)
    (arrow,) = arrows_of(report, scene)
    assert arrow.kind == "fall"
    assert np.allclose(arrow.start, [0, 0, 3])
    assert arrow.way[2] < 0
    assert np.allclose(arrow.way[:2], 0)
    assert states_of(report) == {"lamp": "error"}
    assert share_of(render(report, scene, SIZE), FAILS) > 0.01


def test_the_page_starts_with_all_bodies(tmp_path: Path) -> None:
    report, scene = checked(tmp_path, tower(0.55))
    data = picture_data(report, scene)
    assert data["all"] is True
    assert "error" in data["states"].values()
    assert {arrow["kind"] for arrow in data["arrows"]} == {"fall"}


def test_an_overlap_comes_first(tmp_path: Path) -> None:
    bodies = [floor(), box("a", [1, 1, 1], [0, 0, 3]), box("b", [1, 1, 1], [0.5, 0, 3])]
    report, scene = checked(tmp_path, bodies)
    assert picture_data(report, scene)["all"] is False


def test_a_region_hides_nothing(tmp_path: Path) -> None:
    room = box("room", [6, 6, 6], [0, 0, 3])
    bodies = [floor(), box("lamp", [1, 1, 1], [0, 0, 3])]
    report, scene = checked(tmp_path, [room, *bodies], {"bodies": "room", "region": True})
    assert [body.id for body in without_regions(scene).bodies] == ["floor", "lamp"]
    assert picture_data(report, scene)["bodies"]["ids"] == ["floor", "lamp"]
    assert share_of(render(report, scene, SIZE), FAILS) > 0.01
    assert KINDS[ARROW].layer == MARKS
