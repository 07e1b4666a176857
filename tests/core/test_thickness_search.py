"""The thickness of overlaps: proven intervals against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck.core import Mesh, Surface, search_thickness
from tests.core.voxel_solids import VoxelSolid, box

WORK = 100_000_000


def tetrahedron(height: float) -> Surface:
    """The corner x, y, z >= 0, x + y + z <= height."""
    corners = [(0, 0, 0), (height, 0, 0), (0, height, 0), (0, 0, height)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    return Surface(Mesh(np.array(corners, float), np.array(faces, np.uint32)), True)


def cube(low: int, high: int) -> Surface:
    return Surface(box((low,) * 3, (high,) * 3).mesh(), True)


def test_the_insphere_of_a_corner_that_reaches_into_a_cube() -> None:
    found = search_thickness(tetrahedron(3.0), cube(-1, 4), width=0.01, work=WORK)
    truth = 2 * 3.0 / (3 + math.sqrt(3))
    assert found.lower <= truth <= found.upper
    assert found.stop == "narrow"
    assert found.upper - found.lower <= 0.01 * found.upper
    assert found.centre is not None
    assert found.radius == pytest.approx(found.lower / 2, rel=1e-9)


def test_a_limit_ends_the_search_early() -> None:
    exact = search_thickness(tetrahedron(3.0), cube(-1, 4), width=1e-6, work=WORK)
    for limit in (0.5, 2.0):
        found = search_thickness(tetrahedron(3.0), cube(-1, 4), width=1e-6, work=WORK, limit=limit)
        assert found.stop == "decided"
        assert (found.lower > limit) == (exact.lower > limit)
        assert (found.upper <= limit) == (exact.upper <= limit)
        assert found.boxes <= exact.boxes


def test_no_work_leaves_a_wide_interval() -> None:
    """A cube within the hollow of a box whose walls it enters by 1."""
    hollow = VoxelSolid(box((0, 0, 0), (8, 8, 8)).cells - box((2, 2, 2), (6, 6, 6)).cells)
    a, b = Surface(hollow.mesh(), True), cube(1, 7)
    spent = search_thickness(a, b, width=1e-6, work=0)
    assert spent.stop == "work spent"
    assert spent.lower <= 1.0 <= spent.upper


@pytest.mark.parametrize(
    "wrong", [{"width": -0.1}, {"less_a": -1.0}, {"less_b": math.inf}, {"limit": math.nan}]
)
def test_wrong_lengths_are_refused(wrong: dict[str, float]) -> None:
    given = {"width": 0.01, **wrong}
    with pytest.raises(ValueError, match=next(iter(wrong))):
        search_thickness(cube(0, 1), cube(0, 2), work=WORK, **given)  # type: ignore[arg-type]


def test_an_open_surface_is_refused() -> None:
    mesh = Mesh(np.eye(3), np.array([(0, 1, 2)], np.uint32))
    with pytest.raises(ValueError, match="solid"):
        search_thickness(Surface(mesh, False), cube(0, 1), width=0.01, work=WORK)


def prism_ring(
    outer: float, inner: float, turn: float, low: float, high: float, n: int, twist: float = 0.0
) -> Surface:
    """A ring of n facets along z; a prism if inner is 0. turn: in facets, and how far they turn on
    the way from low to high."""
    steps = 2 * math.pi / n * np.add.outer((turn, turn + twist), np.arange(n))
    radii = (outer, inner or outer / 2)
    points = [
        (r * math.cos(angle), r * math.sin(angle), z)
        for z, angles in zip((low, high), steps, strict=True)
        for r in radii
        for angle in angles
    ]
    quads = []
    for k in range(n):
        j = (k + 1) % n
        bottom, top = (k, j, n + j, n + k), (2 * n + k, 2 * n + j, 3 * n + j, 3 * n + k)
        quads += [bottom[::-1], top, (k, j, 2 * n + j, 2 * n + k)]
        if inner:
            quads.append((n + j, n + k, 3 * n + k, 3 * n + j))
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    if not inner:
        faces += [
            t
            for k in range(1, n - 1)
            for t in ((n, n + k + 1, n + k), (3 * n, 3 * n + k, 3 * n + k + 1))
        ]
    return Surface(Mesh(np.array(points), np.array(faces, np.uint32)), True)


def test_surfaces_off_by_exactly_the_sagitta_explain_facets_that_interlock() -> None:
    """The overlap ends where the distance to a facet is the tolerance, but for rounding."""
    n = 24
    bolt, hole = prism_ring(5, 0, 0.5, -10, 10, n), prism_ring(9, 5, 0, -4, 4, n)
    sagitta = 5 * (1 - math.cos(math.pi / n))
    found = search_thickness(
        bolt, hole, width=0.0, work=WORK, less_a=sagitta, less_b=sagitta, limit=1e-10 * sagitta
    )
    assert found.stop == "decided"
    assert found.upper <= 1e-10 * sagitta


def test_slivers_between_long_triangles() -> None:
    """Triangles that turn a little from one end to the other: no two lie in one plane, and
    planes around a sliver differ by half a degree. Slivers are half as thick as the sagitta."""
    n = 280
    bolt, hole = prism_ring(5, 0, 0.3, -10, 10, n, 0.2), prism_ring(9, 5, 0, -10, 10, n - 14, 0.1)
    sagitta = 5 * (1 - math.cos(math.pi / (n - 14)))
    for share, is_real in ((0.55, False), (0.45, True)):
        off = share * sagitta
        found = search_thickness(
            bolt, hole, width=0.0, work=WORK // 2, less_a=off, less_b=off, limit=0.0
        )
        assert found.stop == "decided"
        assert (found.lower > 0) == is_real
