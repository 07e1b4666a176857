"""Where a picture is seen from."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.audit.words import figure, short_names
from satcheck.cli.formats.picture import headline
from satcheck.cli.formats.picture.html import picture_data
from satcheck.cli.formats.picture.moments import Moments
from satcheck.cli.formats.picture.png import view_of
from satcheck.cli.formats.picture.shown import Shown, Shows
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Box
from satcheck.scene import Scene, load_scene
from satcheck.scene.meshes import scene_of_meshes
from tests.cli.process import SAMPLES

Floats = np.ndarray
ACROSS = 0.26  # the cosine that still counts as across, as viewpoint.py says


def box(size: tuple[float, float, float], at: tuple[float, float, float]) -> tuple[Floats, Floats]:
    mesh = mesh_of(Box(size))
    return np.asarray(mesh.vertices) + at, np.asarray(mesh.triangles)


DEPTH = Settings(depth=True)


def shown(scene: Scene, settings: Settings = DEPTH, up: str = "z") -> Shown:
    """The first finding."""
    report = check(scene, settings)
    return Shows(report, scene, Moments(), up).of(report.findings[0])


def scene_of(bodies: Mapping[str, tuple[Floats, Floats]]) -> Scene:
    return scene_of_meshes(dict(bodies))


@pytest.mark.parametrize("up", ["y", "z"])
@pytest.mark.parametrize("way", [(1.5, 0, 0), (0, 1.5, 0), (0, 0, 1.5), (1.5, 0, 1.6)])
def test_it_is_across_the_way_out(way: tuple[float, float, float], up: str) -> None:
    seen = shown(scene_of({"a": box((2, 2, 2), (0, 0, 0)), "b": box((2, 2, 2), way)}), up=up)
    assert seen.marks.way is not None
    out = seen.marks.way[1] / np.linalg.norm(seen.marks.way[1])
    assert abs(seen.view.towards @ out) <= ACROSS
    assert seen.view.towards @ seen.view.rows(up)[2] == pytest.approx(1.0)


def test_a_wall_does_not_hide_the_place() -> None:
    """Two boxes in a corner of four walls, of which one is missing."""
    pair = {"a": box((2, 2, 2), (0, 0, 0)), "b": box((2, 2, 2), (0, 0, 1.5))}
    sides = {"north": (0, 4), "south": (0, -4), "east": (4, 0), "west": (-4, 0)}
    for missing, (x, y) in sides.items():
        walls = {
            name: box((0.2 if u else 8, 0.2 if v else 8, 8), (u, v, 0))
            for name, (u, v) in sides.items()
            if name != missing
        }
        seen = shown(scene_of(pair | walls))
        assert seen.view.towards @ (np.array([x, y, 0]) / 4) > 0.5, missing


def test_a_gap_is_not_seen_through_a_body_of_the_pair() -> None:
    scene = load_scene([str(SAMPLES / "cell.toml")])
    report = check(scene)
    finding = next(f for f in report.findings if {f.a, f.b} == {"fence", "gripper/palm"})
    seen = Shows(report, scene, Moments(), "z").of(finding)
    assert abs(seen.view.towards[0]) <= ACROSS  # the fence stands across x
    assert seen.marks.gap is not None
    assert np.linalg.norm(seen.marks.gap[1] - seen.marks.gap[0]) == pytest.approx(40.0)
    assert [label.text for label in seen.labels] == ["fence", "gripper/palm", "gap 40 mm"]


def test_the_eye_is_beyond_a_body_around_the_place() -> None:
    room, seed = box((10, 10, 10), (0, 0, 0)), box((0.2, 0.2, 0.2), (1, 0, 0))
    seen = shown(scene_of({"room": room, "seed": seed}))
    eye = seen.view.target + seen.view.towards * seen.view.clear * (1 + 1e-9)
    assert np.abs(eye).max() >= 5.0


def test_the_page_and_the_image_have_one_viewpoint() -> None:
    scene = load_scene([str(SAMPLES / "kettle.obj"), str(SAMPLES / "snowflake.obj")])
    report = check(scene)
    seen = Shows(report, scene, Moments(), "z").of(report.findings[0])
    (finding,) = picture_data(report, scene)["findings"]
    assert finding["view"]["towards"] == pytest.approx(seen.view.towards)
    assert view_of(seen.view, seen.pair, "z", (100, 80)).rows[2] == pytest.approx(seen.view.towards)


def test_the_hole_that_decides_has_its_rim() -> None:
    """A box without its lid, 4 wide, and a cube in the opening."""
    points, faces = box((4, 4, 4), (0, 0, 0))
    lid = (points[faces][:, :, 2] > 0).all(axis=1)
    bodies = {"tray": (points, faces[~lid]), "cube": box((1, 1, 1), (0, 0, 2))}
    seen = shown(scene_of(bodies), Settings())
    rim = seen.marks.rim
    assert rim is not None
    (line,) = rim.lines
    assert (line[0] == line[-1]).all()
    assert {tuple(point) for point in line.tolist()} == {
        (x, y, 2.0) for x in (-2.0, 2.0) for y in (-2.0, 2.0)
    }
    assert seen.labels[-1].text == "the hole of tray, 5.66 across: its fill decides"
    assert abs(seen.view.towards[2]) >= 0.4  # not its edge alone


def test_the_headline_counts_pairs() -> None:
    scene = load_scene([str(SAMPLES / "rack.3mf")])
    assert headline(check(scene), Moments()) == "1 of 6 pairs overlaps"
    scene = load_scene([str(SAMPLES / "box.obj"), str(SAMPLES / "open_box.off")])
    assert headline(check(scene), Moments(note="pose 3")).endswith(", pose 3")


def test_figures_are_those_of_tables() -> None:
    assert figure((0.50411, 0.50411), "mm") == "0.504 mm"
    assert figure((0.0, 0.3), "mm") == "at most 0.3 mm"
    assert figure((0.48, 0.5236), None) == "0.502 ±0.023"


def test_names_lose_the_folders_that_they_share() -> None:
    assert short_names("gear/case/lid", "gear/case/bolt") == ["lid", "bolt"]
    assert short_names("gear/lid", "bolt") == ["gear/lid", "bolt"]
    (long,) = short_names("x" * 99)
    assert len(long) == 41
