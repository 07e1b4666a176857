"""The pairs of many poses: what is called apart or deep is so, however near the limit."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from satcheck import core
from satcheck.core.shape_mesh import meshes_beside, shape_bounds
from satcheck.core.shapes import Capsule, Cone, Cylinder, Ellipsoid, Primitive, Sphere, support
from satcheck.core.transform import Transform, about_fixed_axes, placed

APART, DEEP = 1, 2
CUBE = np.array([(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
FACES = ["023", "031", "457", "476", "015", "054", "267", "273", "046", "062", "137", "175"]
TRIANGLES = np.array([[int(corner) for corner in face] for face in FACES], dtype=np.uint32)


def geometry(vertices: np.ndarray) -> core.Geometry:
    return core.Geometry(core.Mesh(vertices, TRIANGLES), True)


def turn(draw: random.Random, shift: tuple[float, float, float]) -> Transform:
    angles = [draw.uniform(-3, 3) for _ in range(3)]
    x, y, z = ((math.cos(angle), math.sin(angle)) for angle in angles)
    return placed(about_fixed_axes(x, y, z), shift)


def sifted(
    a: core.PosedBody,
    b: core.PosedBody,
    at: list[tuple[Transform, Transform]],
    limit: float,
    depth: float,
) -> list[int]:
    matrices = np.array([[m[:12] for m in pose] for pose in at])
    codes, steps = core.sift([a, b], [(0, 1, limit, depth, 2 * depth)], matrices, 1)
    on_two, same = core.sift([a, b], [(0, 1, limit, depth, 2 * depth)], matrices, 2)
    assert np.array_equal(codes, on_two)
    assert steps == same
    return [int(code) for code in codes[:, 0]]


@pytest.mark.parametrize("far", [0.0, 1e3, 1e9])
@pytest.mark.parametrize("limit", [0.0, 1e-3])
def test_cubes_face_to_face(far: float, limit: float) -> None:
    """The gap is the limit, give or take a few roundings, in turned frames far from the origin."""
    draw, cube = random.Random(1), geometry(CUBE)
    body, poses, seen = core.PosedBody(cube), [], set()
    for k in range(300):
        at = turn(draw, (far, -far, draw.uniform(-1, 1)))
        step = (1 + limit) * (1 + draw.choice((0, 1, -1)) * 2.0 ** -draw.uniform(2, 53))
        across = (draw.uniform(-0.5, 0.5), draw.uniform(-0.5, 0.5))
        move = [
            at[4 * row] * step + at[4 * row + 1] * across[0] + at[4 * row + 2] * across[1]
            for row in range(3)
        ]
        other = tuple(
            c + (move[k // 4] if k % 4 == 3 and k < 12 else 0.0) for k, c in enumerate(at)
        )
        poses.append((at, other))
    for (first, second), code in zip(poses, sifted(body, body, poses, limit, limit), strict=True):
        a, b = (core.Hull(np.array(placed_vertices(m))) for m in (first, second))
        seen.add(code)
        if code == APART:
            assert core.compare_signed_distance(a, b, limit) == 1
        if code == DEEP:
            assert core.compare_signed_distance(a, b, -2 * limit) == -1
    assert {APART, 0} <= seen


def placed_vertices(matrix: Transform) -> list[tuple[float, float, float]]:
    mesh = core.Mesh(CUBE, TRIANGLES).transformed(matrix)
    return [mesh.vertex(k) for k in range(8)]


@pytest.mark.parametrize(
    "shape",
    [
        Sphere(0.7),
        Capsule(0.3, 2.0),
        Capsule(0.5, 1e-3),
        Cylinder(0.5, 3.0),
        Cylinder(2.0, 0.1),
        Cone(1.0, 2.0),
        Ellipsoid((1.0, 0.5, 0.25)),
    ],
)
def test_simple_bodies_around_and_inside_a_shape(shape: Primitive) -> None:
    draw, (corners, margin) = random.Random(2), shape_bounds(shape)
    beside = meshes_beside(shape, 16)
    outer, inner = (np.asarray(mesh.vertices) for mesh in beside)
    assert all(mesh.topology().solid for mesh in beside)
    for _ in range(500):
        n = [draw.gauss(0, 1) for _ in range(3)]
        x, y, z = (c / math.hypot(*n) for c in n)
        reach = support(shape, (x, y, z))
        assert max(x * p + y * q + z * r for p, q, r in corners) + margin > reach
        assert (inner @ (x, y, z)).max() < reach < (outer @ (x, y, z)).max()


def test_a_body_in_a_shell_is_not_apart() -> None:
    """Their surfaces do not meet, and the hull of the shell holds the body."""
    small = core.PosedBody(geometry(CUBE * 0.25 + 0.375))
    large = core.PosedBody(geometry(CUBE))
    still = placed((1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0), (0.0, 0.0, 0.0))
    assert sifted(small, large, [(still, still)], 0.0, 0.01) == [DEEP]


def test_matrices_that_prove_nothing() -> None:
    body = core.PosedBody(geometry(CUBE))
    still = placed((1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0), (5.0, 0.0, 0.0))
    for wrong in (math.nan, math.inf, 1e300):
        other = (*still[:3], wrong, *still[4:])
        assert sifted(body, body, [(still, other)], 0.0, 0.0) == [0]


def test_without_steps_only_separate_hulls_are_proven() -> None:
    bodies = [core.PosedBody(geometry(CUBE)) for _ in range(2)]
    at = [placed((1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), (x, 0.0, 0.0)) for x in (0.5, 3.0)]
    still = placed((1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0))
    matrices = np.array([[still[:12], moved[:12]] for moved in at])
    pairs = [(0, 1, 0.0, 0.1, 0.1)]
    assert core.sift(bodies, pairs, matrices)[0].ravel().tolist() == [DEEP, APART]
    assert core.sift(bodies, pairs, matrices, steps=0)[0].ravel().tolist() == [0, APART]
