"""Placement and winding numbers, beside those of the core, which share no code with them."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest

from satcheck import core
from satcheck.verify.exact import Rejected, dot, normal_of, sign, sub
from satcheck.verify.meshes import is_balanced, is_convex
from satcheck.verify.world import Exact, World, placed
from tests.audit.shapes import Mesh, bracket, open_box, unit_box


def arrays(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    points, faces = mesh
    fans = [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]
    return np.array(points, dtype=float), np.array(fans, dtype=np.int64)


def test_a_pose_rounds_as_documented() -> None:
    random = np.random.default_rng(7)
    vertices = random.normal(size=(200, 3)) * 10.0 ** random.integers(-6, 6, size=(200, 1))
    triangles = np.arange(198).reshape(-1, 3)
    mesh = core.Mesh(vertices, triangles.astype(np.uint32))
    for _ in range(20):
        pose = [*random.normal(size=12), 0.0, 0.0, 0.0, 1.0]
        world, expected = placed(vertices, triangles, False, pose), mesh.transformed(pose)
        assert (world.vertices == expected.vertices).all()
        assert (world.triangles == expected.triangles).all()  # turned by a reflection


def test_a_singular_pose_is_refused() -> None:
    vertices, triangles = arrays(unit_box())
    with pytest.raises(Rejected):
        placed(vertices, triangles, True, [1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])


def test_winding_numbers_are_those_of_the_core() -> None:
    """On a grid through vertices, edges and faces."""
    vertices, triangles = arrays(bracket())
    solid = Exact(World(vertices, triangles, True), 0)
    surface = core.Surface(core.Mesh(vertices, triangles.astype(np.uint32)), True)
    for x in range(-1, 8):
        for y in range(-1, 8):
            for z in range(-1, 6):
                p = Fraction(x), Fraction(y), Fraction(z)
                assert solid.winding(p) == surface.winding_number((float(x), float(y), float(z)))


def test_a_triangle_without_area_holds_what_its_segment_holds() -> None:
    """Two of its corners are one point: beside the segment lies nothing of it."""
    points, triangles = arrays(unit_box(edge=4.0))
    for corners in ((0, 7, 7), (0, 0, 7), (7, 7, 7)):  # of a diagonal, and of a corner
        solid = Exact(World(points, np.vstack([triangles, [corners]]), True), 0)
        assert solid.winding((Fraction(1), Fraction(2), Fraction(1))) == 1
        on_diagonal = solid.winding((Fraction(2), Fraction(2), Fraction(2)))
        assert on_diagonal == (1 if corners == (7, 7, 7) else None)


def test_what_is_closed_and_what_is_convex() -> None:
    assert is_balanced(*arrays(unit_box()))
    assert not is_balanced(*arrays(open_box()))
    assert is_convex(*arrays(unit_box()))
    assert not is_convex(*arrays(bracket()))
    points, triangles = arrays(unit_box())
    assert not is_convex(points, triangles[:, ::-1])  # inside out
    backed = np.vstack([triangles, triangles[:2], triangles[:2, ::-1]])
    assert is_convex(points, backed)  # a sheet flush with a face
    assert is_convex(points, np.vstack([triangles, triangles]))
    assert not is_convex(points, np.vstack([triangles, triangles[:, ::-1]]))


def bricks(count: int) -> tuple[np.ndarray, np.ndarray]:
    """The surface of a box, each side in squares of two triangles."""
    points: dict[tuple[int, ...], int] = {}
    triangles = []
    for axis, end in itertools.product(range(3), (0, count)):
        for i, j in itertools.product(range(count), repeat=2):
            square = []
            for x, y in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                p = [0, 0, 0]
                p[axis], p[axis - 2], p[axis - 1] = end, x, y
                square.append(points.setdefault(tuple(p), len(points)))
            k, m, n, o = square if end else square[::-1]
            triangles += [(k, m, n), (k, n, o)]
    return np.array(list(points), dtype=float) / 7 + 1 / 3, np.array(triangles, dtype=np.int64)


def is_convex_slowly(points: np.ndarray, triangles: np.ndarray) -> bool:
    exact = [[Fraction(c) for c in p] for p in points.tolist()]
    volume = Fraction(0)
    for face in triangles.tolist():
        normal = normal_of([exact[v] for v in face])
        heights = {sign(dot(normal, sub(p, exact[face[0]]))) for p in exact}
        if heights >= {1, -1}:
            return False
        volume += dot(normal, exact[face[0]])
    return volume > 0


def test_convexity_is_exact() -> None:
    """A side of many triangles in one plane, and the same with a point off it by a last place."""
    points, triangles = bricks(3)
    assert is_convex(points, triangles) == is_convex_slowly(points, triangles)
    whole = np.round(points * 2**20)
    assert is_convex(whole, triangles)
    for row, axis in itertools.product(range(0, len(whole), 9), range(3)):
        for way in (-np.inf, np.inf):
            other = whole.copy()
            other[row, axis] = np.nextafter(other[row, axis], way)
            assert is_convex(other, triangles) == is_convex_slowly(other, triangles)


def test_of_a_large_body_every_point_counts() -> None:
    """One point of thousands is in front."""
    points, triangles = bricks(30)
    points = np.round(points * 2**20)
    assert is_convex(points, triangles)
    row = int(np.flatnonzero(points[:, 0] == points[:, 0].max())[450])
    points[row, 0] = np.nextafter(points[row, 0], np.inf)
    assert not is_convex(points, triangles)
