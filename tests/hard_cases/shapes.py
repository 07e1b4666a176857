"""Convex point sets (n, 3) to build hard cases from, and how to move them."""

from __future__ import annotations

import math

import numpy as np

from tests.hard_cases.case import Points
from tests.oracles.random_shapes import random_quaternion, rotation_matrix

# Integer maps of determinant 4, 18 and -6: lattice points stay exact, right angles do not.
MATRICES: tuple[Points, ...] = (
    np.eye(3),
    np.array([[2.0, 1, 0], [-1, 3, 1], [1, -1, 2]]),
    np.array([[1.0, -1, 1], [1, 1, -1], [-1, 1, 1]]),
    np.array([[0.0, 2, 1], [3, 0, -1], [1, 0, -1]]),
)


def box(half: tuple[float, float, float] = (1, 1, 1)) -> Points:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    return np.asarray(signs * np.asarray(half))


def box_between(low: tuple[float, ...], high: tuple[float, ...]) -> Points:
    """The corners are the given coordinates, bit by bit."""
    ends = list(zip(low, high, strict=True))
    return np.array([[x, y, z] for x in ends[0] for y in ends[1] for z in ends[2]])


def tetrahedron() -> Points:
    return np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])


def octahedron() -> Points:
    return np.concatenate([np.eye(3), -np.eye(3)])


def icosahedron() -> Points:
    g = (1 + math.sqrt(5)) / 2
    flat = [(0.0, s, t * g) for s in (-1, 1) for t in (-1, 1)]
    return np.array([np.roll(p, k) for p in flat for k in range(3)])


def dodecahedron() -> Points:
    g = (1 + math.sqrt(5)) / 2
    flat = [(0.0, s / g, t * g) for s in (-1, 1) for t in (-1, 1)]
    return np.concatenate([box(), [np.roll(p, k) for p in flat for k in range(3)]])


def polygon(sides: int, radius: float = 1.0, z: float = 0.0) -> Points:
    angles = [2 * math.pi * i / sides for i in range(sides)]
    return np.array([[radius * math.cos(t), radius * math.sin(t), z] for t in angles])


def prism(sides: int, radius: float = 1.0, half_height: float = 1.0) -> Points:
    """Caps at exactly +-half_height; the sides are rounded."""
    return np.concatenate([polygon(sides, radius, z) for z in (-half_height, half_height)])


def ball(rng: np.random.Generator, count: int, radii: tuple[float, ...] = (1, 1, 1)) -> Points:
    """Points on an ellipsoid: all of them extreme."""
    points = rng.normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    return np.asarray(points * np.asarray(radii))


# Bodies below z = 0 whose highest feature is a face, an edge along x, or a vertex: a polygon, a
# segment and a point at z = 0 with the origin in the middle. All coordinates are small integers.
TOPS: dict[str, Points] = {
    "face": box_between((-2, -2, -4), (2, 2, 0)),
    "edge": np.array([[-2.0, 0, 0], [2, 0, 0], *([x, y, -4] for x in (-2, 2) for y in (-2, 2))]),
    "vertex": np.array([[0.0, 0, 0], *([x, y, -4] for x in (-2, 2) for y in (-2, 2))]),
}
# Turns in the plane that keep integers: by 0, by 90 degrees, by 45 degrees with a stretch.
TURNS: dict[str, Points] = {
    "along": np.eye(3),
    "across": np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]),
    "diagonal": np.array([[1.0, -1, 0], [1, 1, 0], [0, 0, 1]]),
}


def upside_down(points: Points) -> Points:
    return np.asarray(points * np.array([1.0, 1.0, -1.0]))


def moved(points: Points, *offset: float) -> Points:
    return np.asarray(points + np.asarray(offset, float))


def mapped(matrix: Points, points: Points) -> Points:
    """matrix @ p for each point, sums in a fixed order: BLAS would round as the machine likes."""
    x, y, z = (points[:, i : i + 1] * matrix[:, i] for i in range(3))
    return np.asarray(x + y + z)


def random_rotation(rng: np.random.Generator) -> Points:
    return rotation_matrix(random_quaternion(rng))


def about(axis: int, angle: float) -> Points:
    """Rotation about a coordinate axis; for tiny angles cos is 1 and sin the angle."""
    c, s = math.cos(angle), math.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix
