"""Second opinions on tiny meshes whose truth is plain."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

import numpy as np
import pytest

from bench.opinions.crossing import cross_for_sure
from bench.opinions.judge import Opinion, common_volume, of_alarm, of_pass
from bench.opinions.meshes import extent, read, read_by_trimesh
from bench.opinions.placing import KINDS, placement
from bench.opinions.surface import (
    Mesh,
    Points,
    Triangles,
    distances,
    rim_kind,
    winding_numbers,
)
from bench.peers.child import replies

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
FLOOR: list[list[float]] = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
CORNERS = np.array([[x, y, z] for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])
QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
FACES = np.array([t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))])


def box(low: float = 0.0, size: float = 1.0, faces: Triangles = FACES) -> Mesh:
    return Mesh(low + size * CORNERS, faces)


def needle(tip: float, x: float = 1.0) -> list[list[float]]:
    """A triangle upright over the floor, its lowest corner at height `tip`."""
    return [[x, 1, tip], [x, 1.5, 3], [x, 0.5, 3]]


def test_triangles_cross_for_sure_up_to_their_depth() -> None:
    assert cross_for_sure(FLOOR, needle(-1), 0.0)
    assert cross_for_sure(needle(-1), FLOOR, 1e-3)
    assert not cross_for_sure(FLOOR, needle(-1e-9), 1e-8)
    assert cross_for_sure(FLOOR, needle(-1e-9), 0.0)


@pytest.mark.parametrize("other", [needle(0.0), needle(1e-300), needle(-1, 5.0), FLOOR])
def test_triangles_that_touch_miss_or_are_coplanar_do_not(other: list[list[float]]) -> None:
    assert not cross_for_sure(FLOOR, other, 0.0)
    assert not cross_for_sure(other, FLOOR, 0.0)


def test_a_winding_number_counts_the_surfaces_around_a_point() -> None:
    points = np.array([[0.5, 0.5, 0.5], [0.1, 0.9, 0.3], [2, 0, 0]])
    assert winding_numbers(box(), points) == pytest.approx([1, 1, 0])
    assert winding_numbers(box(faces=FACES[:, ::-1]), points) == pytest.approx([-1, -1, 0])
    half = winding_numbers(box(faces=FACES[2:]), points[:1])
    assert half == pytest.approx([5 / 6])


def test_the_distance_to_a_surface_is_that_to_a_face_an_edge_or_a_corner() -> None:
    points = np.array([[0.5, 0.5, 3], [0.5, 2, 2], [2, 2, 2], [0.5, 0.5, 0.4]])
    assert distances(box(), points) == pytest.approx([2, math.sqrt(2), math.sqrt(3), 0.4])


def test_rims() -> None:
    assert rim_kind(box()) == "closed"
    assert rim_kind(Mesh(CORNERS[FACES].reshape(-1, 3), np.arange(36).reshape(-1, 3))) == "closed"
    assert rim_kind(box(faces=FACES[1:])) == "holed"
    turned = FACES.copy()
    turned[0] = turned[0, ::-1]
    assert rim_kind(box(faces=turned)) == "mixed winding"


def test_a_t_junction_is_a_crack() -> None:
    a, b, c = FACES[0]
    middle = (CORNERS[a] + CORNERS[b]) / 2
    halves = np.array([[a, 8, c], [8, b, c]])
    split = Mesh(np.vstack([CORNERS, middle]), np.vstack([FACES[1:], halves]))
    assert rim_kind(split) == "cracked"


def test_a_pass_of_boxes_that_cross_is_false() -> None:
    other = Mesh(CORNERS + np.array([0.5, 0.4, 0.2]), FACES)
    assert of_pass(box(), other, 1e-6).standing == "false"
    assert "cross" in of_pass(box(), other, 1e-6).words


def test_a_pass_of_a_box_within_a_box_is_false_and_of_an_open_one_doubted() -> None:
    inner = box(0.3, 0.4)
    assert of_pass(inner, box(), 1e-6).words.startswith("A within B")
    assert of_pass(box(), inner, 1e-6).standing == "false"
    thin = Mesh(*_torn(box()))
    assert rim_kind(thin) == "holed"
    assert of_pass(inner, thin, 1e-6).standing == "doubted"


def _torn(mesh: Mesh) -> tuple[Points, Triangles]:
    """One corner of one face moved a little away from its neighbours."""
    faces = mesh.triangles.copy()
    faces[0, 0] = len(mesh.vertices)
    return np.vstack([mesh.vertices, mesh.vertices[mesh.triangles[0, 0]] + 0.01]), faces


def test_a_sheet_that_cuts_a_box_is_no_pass() -> None:
    corners = np.array([[-5.0, -5, 0.5], [5, -5, 0.5], [0, 9, 0.5]])
    sheet = Mesh(corners, np.array([[0, 1, 2], [2, 1, 0]]))
    assert of_pass(sheet, box(), 1e-6).standing == "false"


def test_passes_that_are_right_agree() -> None:
    assert of_pass(box(), box(2.0), 1e-6) == Opinion("agrees", "no common volume")
    beside = Mesh(CORNERS + np.array([1.0, 0, 0]), FACES)
    assert of_pass(box(), beside, 1e-6).standing == "agrees"
    hollow = Mesh(
        np.vstack([3 * CORNERS - 1, 2 * CORNERS - 0.5]), np.vstack([FACES, FACES[:, ::-1] + 8])
    )
    assert of_pass(box(), hollow, 1e-6).standing == "agrees"


def test_an_alarm_needs_surfaces_that_meet_a_point_within_or_a_volume() -> None:
    assert of_alarm(box(), box(0.5)).standing == "agrees"
    assert of_alarm(box(), box(0.3, 0.4)).standing == "agrees"
    assert of_alarm(box(), box(2.0)).standing == "doubted"
    assert of_alarm(box(), box(2.0, faces=FACES[1:])).standing == "no answer"


def test_manifold_measures_solids_only() -> None:
    assert common_volume(box(), box(0.5)) == pytest.approx(0.125)
    assert common_volume(box(), box(faces=FACES[1:])) is None
    assert common_volume(box(), box(faces=FACES[:, ::-1])) is None


@pytest.mark.parametrize("kind", KINDS)
def test_bodies_are_placed_as_their_kind_says(kind: str) -> None:
    a, b = box(), box(7.0, 3.0)
    matrix = placement(kind, a, a if kind == "beside" else b, np.random.default_rng(1))
    moved = (a if kind == "beside" else b).moved(matrix)
    linear = matrix[:3, :3]
    scale = np.cbrt(np.linalg.det(linear))
    assert linear @ linear.T == pytest.approx(scale**2 * np.eye(3))
    assert scale == pytest.approx({"within": 0.2, "other": 1 / 3}.get(kind, 1.0))
    centre = moved.vertices.mean(axis=0)
    if kind == "far":
        assert np.linalg.norm(centre - 0.5) == pytest.approx(3 * math.sqrt(3))
    if kind == "beside":
        assert centre == pytest.approx([1.5, 0.5, 0.5])
    if kind == "within":
        assert winding_numbers(a, centre[None]) == pytest.approx([1])


def test_both_readers_are_asked() -> None:
    path = str(SAMPLES / "box.obj")
    first, second = extent(read(path)), extent(read_by_trimesh(path))
    assert first.agrees(second)
    assert not first.agrees(extent(read(path).moved(np.diag([1.1, 1, 1, 1]))))


def test_the_judge_answers_line_by_line() -> None:
    eye = np.eye(4).tolist()
    question = {"files": [str(SAMPLES / "box.obj")] * 2, "matrices": [eye, eye]}
    away = np.eye(4)
    away[0, 3] = 0.5
    passed = {**question, "matrices": [eye, away.tolist()], "claim": "pass", "tolerance": 0.0}
    lines = [json.dumps({**question, "claim": "alarm"}), "{}", json.dumps(passed)]
    said = replies([sys.executable, "-m", "bench.opinions.judge"], lines, 60.0)
    standings = [json.loads(reply)["standing"] for reply in said]
    assert standings[:2] == ["agrees", "no answer"]
    assert standings[2] == "false"
