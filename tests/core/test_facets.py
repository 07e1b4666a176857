"""Facets and ridges of meshes whose faces are known."""

from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh

from satcheck.core.facets import Facets, Ridges, components, facets_and_ridges
from satcheck.core.transform import about

ROUNDED = 2.0**-24


def of_mesh(mesh: trimesh.Trimesh, precision: float = 0.0) -> tuple[Facets, Ridges]:
    return facets_and_ridges(np.array(mesh.vertices), np.array(mesh.faces), precision)


def turned(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """Turned, and rounded to float32."""
    turn = np.array(about((2 / 7, 3 / 7, 6 / 7), (0.6, 0.8))).reshape(3, 3)
    vertices = (np.array(mesh.vertices) @ turn.T).astype(np.float32)
    return trimesh.Trimesh(vertices.astype(np.float64), mesh.faces, process=False)


def test_components_of_a_graph() -> None:
    pairs = np.array([(6, 2), (5, 4), (2, 4), (0, 1)])
    assert components(7, pairs).tolist() == [0, 0, 1, 2, 1, 1, 1]
    assert components(3, pairs[:0]).tolist() == [0, 1, 2]


def test_a_box_has_six_facets() -> None:
    """A finer box too, whose triangles continue each other in a plane."""
    for mesh in (trimesh.creation.box((1, 2, 3)), trimesh.creation.box((1, 2, 3)).subdivide()):
        facets, ridges = of_mesh(mesh)
        assert (facets.count, len(ridges.angles)) == (6, 12)
        assert ridges.angles == pytest.approx(np.full(12, math.pi / 2))
        assert sorted({*ridges.widths.ravel().round(9)}) == [1, 2, 3]


@pytest.mark.parametrize("number", [6, 48])
def test_strips_of_a_turned_prism(number: int) -> None:
    mesh = turned(trimesh.creation.cylinder(0.5, 8, sections=number))
    facets, ridges = of_mesh(mesh, ROUNDED)
    assert facets.count == number + 2
    of_side = ridges.angles < 1.2  # the caps are at 90 degrees
    assert of_side.sum() == number
    # A coordinate is off by the precision, and a direction across a strip by twice that.
    width = math.sin(math.pi / number)
    assert ridges.widths[of_side] == pytest.approx(width, abs=4 * ROUNDED)
    assert ridges.angles[of_side] == pytest.approx(2 * math.pi / number, abs=8 * ROUNDED / width)


def test_a_sliver_hides_no_ridge() -> None:
    """A triangle without area on the edge between two walls of a corner."""
    points = np.array([(0, 0, 0), (0, 0, 1), (0, 0, 2), (1, 0, 1), (0, 1, 1)], dtype=float)
    facets, ridges = facets_and_ridges(
        points, np.array([(0, 2, 3), (0, 1, 2), (1, 0, 4), (2, 1, 4)]), 0.0
    )
    assert facets.count == 2
    assert ridges.angles == pytest.approx([math.pi / 2])


def test_edges_without_two_triangles_that_agree_are_no_ridges() -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -1, -1)], dtype=float)
    agreeing = [(0, 1, 2), (1, 0, 3)]
    for more, count in (([], 1), ([(0, 1, 4)], 0)):
        assert len(facets_and_ridges(points, np.array(agreeing + more), 0.0)[1].angles) == count
    assert len(facets_and_ridges(points, np.array([(0, 1, 2), (0, 1, 3)]), 0.0)[1].angles) == 0
