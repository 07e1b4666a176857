"""Faces, edges and candidate axes of hulls, against counts by hand and a brute-force SAT."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck import core
from satcheck.audit.axes import axes_shown
from satcheck.core.axes import Floats, Hull, corners_of, edge_pairs, hull_of
from tests.oracles.brute_sat import signed_distance
from tests.oracles.random_shapes import (
    box_corners,
    random_hull,
    random_quaternion,
    rotation_matrix,
)

STEP = 1e-16
# Signed distances of bodies of size 1: support values in float64, and qhull's plane normals.
SAME = 1e-12


def polytope_of(points: Floats) -> core.Polytope:
    no_triangles = np.zeros((1, 3), dtype=np.uint32)
    return core.Mesh(np.ascontiguousarray(points), no_triangles).convex_hull()


def both(a: Floats, b: Floats, step: float = STEP) -> tuple[Hull, Hull]:
    first, second = polytope_of(a), polytope_of(b)
    of_first, of_second = corners_of(first.vertices, second.vertices)
    return hull_of(first, of_first, step), hull_of(second, of_second, step)


def largest_gap(a: Floats, b: Floats) -> float:
    first, second = both(a, b)
    pairs = edge_pairs(first, second)
    return max(axis.gap for axis in axes_shown(first, second, pairs.where(pairs.plain)))


PRISM = np.array([[np.cos(t), np.sin(t), z] for z in (0.0, 1.0) for t in np.arange(6) * np.pi / 3])


@pytest.mark.parametrize(
    ("points", "faces", "sides"),
    [
        (box_corners((1, 2, 3)), 6, 12),
        (PRISM, 8, 18),
        (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), 4, 6),
        (np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), 2, 4),
    ],
    ids=["box", "prism", "tetrahedron", "square"],
)
def test_faces_and_edges_are_those_of_the_solid(points: Floats, faces: int, sides: int) -> None:
    for turn in (np.eye(3), rotation_matrix(np.array([0.1, 0.2, 0.3, 0.9]))):
        features, _ = both(points @ turn.T, box_corners((1, 1, 1)))
        assert (features.faces, features.sides) == (faces, sides)
        assert len(features.edges) >= sides
        outward = features.unit[features.beside[:sides]].sum(axis=1)
        world = features.corners.world
        middle = world[features.edges[:sides]].mean(axis=1) - world.mean(axis=0)
        if faces > 2:  # the two normals of a polygon cancel
            assert ((outward * middle).sum(axis=1) > 0).all()


def test_coordinates_of_float32_have_flat_faces_within_their_precision() -> None:
    corners = box_corners((1, 2, 3)) @ rotation_matrix(np.array([0.1, 0.2, 0.3, 0.9])).T
    rounded = np.float32(corners).astype(float)
    features, _ = both(rounded, corners, step=3 * 2.0**-23)
    assert (features.faces, features.sides) == (6, 12)
    features, _ = both(rounded, corners)
    assert features.faces > 6


@pytest.mark.parametrize("seed", range(60))
def test_the_best_candidate_is_that_of_a_test_of_all_axes(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shapes = []
    for _ in range(2):
        points = random_hull(rng, int(rng.integers(4, 20)))
        if rng.random() < 0.4:
            points = box_corners(tuple(rng.uniform(0.2, 1, 3)))
        if rng.random() < 0.7:
            points = points @ rotation_matrix(random_quaternion(rng)).T
        shapes.append(points + 0.4 * rng.normal(size=3))
    truth = signed_distance(*shapes).distance
    best = largest_gap(*shapes)
    if truth < 0:
        assert best == pytest.approx(truth, abs=SAME)
    else:
        assert 0 < best <= truth + SAME


def test_pairs_of_edges_that_are_left_out_make_no_face_of_the_difference() -> None:
    """The Minkowski difference of turned boxes has 30 faces: 18 come from pairs of edges."""
    rng = np.random.default_rng(9)
    for _ in range(20):
        turn_a, turn_b = (rotation_matrix(random_quaternion(rng)) for _ in range(2))
        box = box_corners((1, 2, 3))
        assert edge_pairs(*both(box @ turn_a.T, box @ turn_b.T)).plain.sum() == 18
