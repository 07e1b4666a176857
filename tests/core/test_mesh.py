"""The mesh type, its topology and its repairs, seen from Python."""

from __future__ import annotations

import math
import struct
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from satcheck.core import Mesh, Surface
from tests.core.voxel_solids import SHEAR, box

CUBE = box((0, 0, 0), (1, 1, 1)).mesh()
VERTICES = np.array(CUBE.vertices)
TRIANGLES = np.array(CUBE.triangles)
SHIFT = (1.0, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
MIRROR = (-1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)


@pytest.mark.parametrize("index", [np.int32, np.int64, np.uint32])
def test_a_mesh_takes_any_usual_index_type(index: type[np.generic]) -> None:
    mesh = Mesh(VERTICES, TRIANGLES.astype(index))
    assert mesh.to_bytes() == CUBE.to_bytes()
    assert (mesh.vertex_count, mesh.triangle_count) == (8, 12)
    assert mesh.bounds == ((0, 0, 0), (1, 1, 1))


@pytest.mark.parametrize(
    ("vertices", "triangles", "error"),
    [
        (VERTICES.astype(np.float32), TRIANGLES, TypeError),
        (np.asfortranarray(VERTICES), TRIANGLES, TypeError),
        (VERTICES[:, :2].copy(), TRIANGLES, TypeError),
        (np.full_like(VERTICES, np.nan), TRIANGLES, ValueError),
        (np.full_like(VERTICES, np.inf), TRIANGLES, ValueError),
        (VERTICES, TRIANGLES + 1, ValueError),
        (VERTICES, TRIANGLES.astype(np.int64) - 1, ValueError),
        (VERTICES, TRIANGLES.astype(np.int64) + 2**32, ValueError),
    ],
)
def test_a_mesh_refuses_what_it_cannot_hold(
    vertices: Any, triangles: Any, error: type[Exception]
) -> None:
    with pytest.raises(error):
        Mesh(vertices, triangles)


def test_bytes_are_checked_too() -> None:
    vertices, triangles = CUBE.to_bytes()
    with pytest.raises(ValueError, match="multiples"):
        Mesh.from_bytes(vertices[:-1], triangles)
    with pytest.raises(ValueError, match="names vertex 8"):
        Mesh.from_bytes(vertices, triangles + struct.pack("<3I", 0, 1, 8))


def test_arrays_are_views_that_outlive_the_mesh() -> None:
    array = Mesh(VERTICES, TRIANGLES).vertices
    assert not array.flags.writeable
    assert np.array_equal(array, VERTICES)


def test_the_core_does_not_import_numpy() -> None:
    code = (
        "import sys, satcheck.core as c; m = c.Mesh.from_bytes(b'', b''); m.topology();"
        "sys.exit('numpy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_topology_of_a_cube_and_of_an_open_one() -> None:
    topology = CUBE.topology()
    assert topology.closed
    assert topology.manifold
    assert topology.oriented
    assert topology.solid
    assert topology.volume == 1
    assert topology.components == 1
    opened = Mesh(VERTICES, TRIANGLES[1:].copy()).topology()
    assert not opened.closed
    assert not opened.solid
    assert opened.boundary_edges == 3


def test_transforms_keep_the_outside_outside() -> None:
    assert CUBE.transformed(SHIFT).bounds == ((5, 0, 0), (6, 1, 1))
    assert CUBE.transformed(MIRROR).topology().volume == 1
    assert CUBE.translated((0, 0, -1)).bounds == ((0, 0, -1), (1, 1, 0))
    for bad in (
        (0.0,) * 15 + (1.0,),
        (*SHIFT[:15], 2.0),
    ):
        with pytest.raises(ValueError, match="matrix"):
            CUBE.transformed(bad)
    # Placements that multiply beyond float64 end so.
    for beyond in (math.nan, math.inf):
        with pytest.raises(OverflowError, match="matrix"):
            CUBE.transformed((beyond, *SHIFT[1:]))
    with pytest.raises(ValueError, match="finite"):
        CUBE.translated((math.inf, 0, 0))


def test_transformed_coordinates_are_rounded_once() -> None:
    matrix = (0.1, 0.7, -0.3, 1e9, 0.3, 0.1, 0.9, -1e-9, 0.2, -0.4, 0.5, 3, 0, 0, 0, 1)
    point = np.array([[1 / 3, 1e8 / 7, -1e-8 / 9], [0, 0, 0], [1, 2, 3]])
    moved = Mesh(point, np.array([[0, 1, 2]])).transformed(matrix).vertices[0]
    from fractions import Fraction

    x, y, z = (Fraction(float(c)) for c in point[0])
    for row in range(3):
        a, b, c, d = (Fraction(m) for m in matrix[4 * row : 4 * row + 4])
        assert moved[row] == float(a * x + b * y + c * z + d)


def test_orientation_repairs() -> None:
    flipped = TRIANGLES.copy()
    flipped[3] = flipped[3][::-1]
    mixed = Mesh(VERTICES, flipped)
    assert not mixed.topology().oriented
    assert mixed.oriented().topology().volume == 1
    assert Mesh(VERTICES, TRIANGLES[:, ::-1].copy()).oriented().topology().volume == 1


def test_hull_of_a_sheared_box_is_the_box() -> None:
    solid = box((0, 0, 0), (3, 2, 2)).mesh(SHEAR)
    hull = solid.convex_hull()
    assert (hull.dimension, len(hull.vertices), len(hull.triangles)) == (3, 8, 12)
    assert {*map(tuple, hull.vertices)} <= {*map(tuple, solid.vertices)}
    assert hull.to_mesh().topology().volume == solid.topology().volume
    assert solid.convexity_defect(0.0) == 0.0


def test_surface_queries() -> None:
    surface = Surface(CUBE, True)
    assert surface.solid
    assert surface.winding_number((0.5, 0.5, 0.5)) == 1
    assert surface.winding_number((0.5, 0.5, 1.5)) == 0
    assert surface.winding_number((0.5, 0.5, 1.0)) is None
    assert surface.nearest((0.5, 0.5, 3.0)) == (2.0, (0.5, 0.5, 1.0))
    with pytest.raises(ValueError, match="not a solid"):
        Surface(Mesh(VERTICES, TRIANGLES[1:].copy()), True)
    with pytest.raises(ValueError, match="not finite"):
        surface.nearest((math.nan, 0, 0))


@pytest.mark.parametrize("lift", [0.0, 2.0**-52])
def test_flat_is_exact(lift: float) -> None:
    """A tilted square of which one corner is lifted by an ulp, after a needle without one."""
    corners = [(0, 0, 0), (1, 0, 1), (0, 1, 1), (1, 1, 2 + 2 * lift), (0.5, 0, 0.5)]
    mesh = Mesh(np.array(corners, dtype=float), np.array([[0, 4, 1], [0, 1, 2], [1, 3, 2]]))
    assert mesh.is_flat() == (lift == 0)
    assert mesh.is_flat() == (mesh.convex_hull().dimension < 3)


def test_what_has_no_area_is_flat() -> None:
    assert Mesh(np.array([[0.0, 0, 0], [1, 1, 1], [2, 2, 2]]), np.array([[0, 1, 2]])).is_flat()
