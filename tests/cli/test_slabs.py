"""A half space in a picture is a slab."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.cli.formats.picture import png, render
from satcheck.cli.formats.picture.slabs import with_slabs
from satcheck.scene import Scene, load_scene

CUBE = {"id": "cube", "shape": {"type": "box", "size": [2, 2, 2]}, "position": [7, 0, 0.5]}
WALL = [[0, 0, 1, -1], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]]


def scene_of(folder: Path, *bodies: dict[str, Any]) -> Scene:
    path = folder / "scene.json"
    path.write_text(json.dumps({"schema": "satcheck.scene/1", "bodies": bodies}))
    return load_scene([path])


def bounds(scene: Scene, number: int) -> np.ndarray:
    return np.array(scene.bodies[number].world_mesh().bounds)


def test_its_top_is_the_plane_and_it_holds_what_lies_below(tmp_path: Path) -> None:
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    drawn = with_slabs(scene_of(tmp_path, floor, CUBE))
    low, high = bounds(drawn, 0)
    assert high[2] == 0.0
    assert -1.0 < low[2] < -0.5
    assert (low[:2] < [6, -1]).all()
    assert (high[:2] > [8, 1]).all()
    assert (high - low).max() < 4.0
    assert bounds(drawn, 1).tolist() == [[6.0, -1.0, -0.5], [8.0, 1.0, 1.5]]


def test_a_turned_one_faces_its_way(tmp_path: Path) -> None:
    wall = {"id": "wall", "shape": {"type": "half-space"}, "matrix": WALL}
    low, high = bounds(with_slabs(scene_of(tmp_path, wall, CUBE)), 0)
    assert high[0] == -1.0
    assert low[0] < -1.0
    assert low[1] < -1.0 < 1.0 < high[1]


def test_one_without_other_bodies_has_a_size(tmp_path: Path) -> None:
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    low, high = bounds(with_slabs(scene_of(tmp_path, floor)), 0)
    assert (high - low).max() == pytest.approx(1.25)


@pytest.mark.parametrize("form", ["png", "glb", "html"])
def test_pictures_have_it(tmp_path: Path, form: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(png, "render", partial(png.render, size=(120, 90)))
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    scene = scene_of(tmp_path, floor, CUBE)
    report = check(scene, Settings(depth=True))
    assert render(form, report, scene) == render(form, report, with_slabs(scene))
