"""Concave meshes of known shape, and a cache of the test's own."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from satcheck.core import Mesh
from satcheck.decompose import Cache

Triangles = list[tuple[int, int, int]]


def prism(outline: Sequence[tuple[float, float]], cap: Triangles, height: float = 1.0) -> Mesh:
    """A polygon in the xy plane (counter-clockwise, `cap` its triangles) swept along z."""
    count = len(outline)
    vertices = [(x, y, z) for z in (0.0, height) for x, y in outline]
    triangles = [(c, b, a) for a, b, c in cap]
    triangles += [(a + count, b + count, c + count) for a, b, c in cap]
    for tail in range(count):
        head = (tail + 1) % count
        triangles += [(tail, head, head + count), (tail, head + count, tail + count)]
    return Mesh(np.array(vertices, dtype=np.float64), np.array(triangles, dtype=np.uint32))


@pytest.fixture(scope="session")
def box() -> Mesh:
    return prism([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 2, 3)])


@pytest.fixture(scope="session")
def l_shape() -> Mesh:
    """The square [0,2]^2 less its corner ]1,2]^2, one high."""
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    return prism(outline, [(0, 1, 2), (0, 2, 3), (0, 3, 5), (3, 4, 5)])


@pytest.fixture(scope="session")
def u_shape() -> Mesh:
    """[0,3] x [0,2] less ]1,2[ x ]1,2], one high."""
    outline = [(0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)]
    cap = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 5), (0, 5, 7), (5, 6, 7)]
    return prism(outline, cap)


@pytest.fixture(scope="session")
def torus() -> Mesh:
    """Around z, radii 1 and 0.3, 16 x 8 quadrilaterals."""
    around, across = 16, 8
    vertices = []
    for i in range(around):
        for j in range(across):
            u, v = 2.0 * math.pi * i / around, 2.0 * math.pi * j / across
            radius = 1.0 + 0.3 * math.cos(v)
            vertices.append((radius * math.cos(u), radius * math.sin(u), 0.3 * math.sin(v)))
    triangles = []
    for i in range(around):
        for j in range(across):
            a, b = i * across + j, (i + 1) % around * across + j
            c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
            triangles += [(a, b, c), (a, c, d)]
    return Mesh(np.array(vertices), np.array(triangles, dtype=np.uint32))


@pytest.fixture
def cache(tmp_path: Path) -> Cache:
    return Cache(tmp_path / "cache")
