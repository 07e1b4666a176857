"""Random convex point sets and poses for the tests, and poses applied in plain numpy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Pose = tuple[float, float, float, float, float, float, float]


def box_corners(half: tuple[float, float, float]) -> Points:
    """The 8 corners (8, 3) of a box around the origin."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    return np.asarray(signs * np.asarray(half))


def random_hull(rng: np.random.Generator, count: int) -> Points:
    """`count` points (count, 3) on an ellipsoid with radii 0.4 to 1: all of them extreme."""
    points = rng.normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    return np.asarray(points * rng.uniform(0.4, 1.0, 3))


def moved(points: Points, x: float, y: float, z: float) -> Points:
    """Points (n, 3) translated."""
    return np.asarray(points + np.array([x, y, z]))


def random_direction(rng: np.random.Generator) -> Points:
    direction = rng.normal(size=3)
    return np.asarray(direction / np.linalg.norm(direction))


def random_quaternion(rng: np.random.Generator) -> Points:
    """Unit quaternion x, y, z, w, uniform over the rotations."""
    quaternion = rng.normal(size=4)
    return quaternion / np.linalg.norm(quaternion)


def random_pose(rng: np.random.Generator, spread: float) -> Pose:
    """Any rotation; translation normal with the given standard deviation."""
    return pose(rng.normal(size=3) * spread, random_quaternion(rng))


def pose(translation: Points, quaternion: Points) -> Pose:
    t, q = translation, quaternion
    return (*(float(c) for c in t), *(float(c) for c in q))  # type: ignore[return-value]


def rotation_matrix(quaternion: Points) -> Points:
    """3x3 matrix of a quaternion x, y, z, w of any length."""
    x, y, z, w = quaternion / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def apply(placement: Pose, points: Points) -> Points:
    """Points (n, 3) rotated, then translated."""
    turned = points @ rotation_matrix(np.array(placement[3:])).T
    return np.asarray(turned + np.array(placement[:3]))


def compose(outer: Pose, inner: Pose) -> Pose:
    """The pose that applies `inner`, then `outer`."""
    x1, y1, z1, w1 = outer[3:]
    x2, y2, z2, w2 = inner[3:]
    quaternion = np.array(
        [
            w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2,
            w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2,
            w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2,
            w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2,
        ]
    )
    translation = apply(outer, np.array([inner[:3]]))[0]
    return pose(translation, quaternion / np.linalg.norm(quaternion))
