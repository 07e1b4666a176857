"""Vertices that add nothing: duplicates, points on edges, on faces, within, and an ulp off."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tests.hard_cases.case import ConvexPair, Points, pair
from tests.hard_cases.families.contact import touching_pair
from tests.hard_cases.shapes import MATRICES, TOPS, box, mapped, random_rotation

CATEGORY = "duplicate, collinear, coplanar"

EXTRAS = ("duplicates", "on edges", "on faces", "within", "an ulp off")
PLACES = ("touching", "deep", "gap", "by 1e-12")


def cases(seed: int) -> Iterator[ConvexPair]:
    rng = np.random.default_rng(seed)
    for extra in EXTRAS:
        for below in TOPS:
            for above in TOPS:
                for place in PLACES:
                    a, b = touching_pair(rng, below, above, "along")
                    lift = {"touching": 0.0, "deep": -1.0, "gap": 0.5, "by 1e-12": -1e-12}[place]
                    map_ = MATRICES[rng.integers(len(MATRICES))]
                    points = (padded(rng, p, extra) for p in (a, b + np.array([0.25, 0, lift])))
                    mapped_a, mapped_b = (mapped(map_, p) for p in points)
                    name = f"{below} on {above} with {extra}, {place}"
                    yield pair(CATEGORY, name, mapped_a, mapped_b)
    grid = np.array([[x, y, z] for x in range(4) for y in range(4) for z in range(4)], float)
    for shift, expected in ((3.0, "touching"), (2.0, "penetrating"), (3.5, "separated")):
        other = grid + np.array([shift, 0.5, 0])
        yield pair(CATEGORY, f"grids of 64 points, {expected}", grid, other, expected)
        turn = random_rotation(rng)
        name = f"grids of 64 points, turned, {shift:g} off"
        yield pair(CATEGORY, name, mapped(turn, grid), mapped(turn, other))
    yield pair(CATEGORY, "a box 100 times", np.tile(box(), (100, 1)), box() + 2, "touching")


def padded(rng: np.random.Generator, points: Points, extra: str) -> Points:
    """With eight points more. Halves of integers are exact; `an ulp off` is meant to round."""
    i, j, k = (rng.integers(len(points), size=8) for _ in range(3))
    if extra == "duplicates":
        return np.concatenate([points, points[i]])
    if extra == "on edges":
        return np.concatenate([points, (points[i] + points[j]) / 2])
    if extra == "on faces":
        return np.concatenate([points, (points[i] + points[j]) / 4 + points[k] / 2])
    if extra == "within":
        return np.concatenate([points, (points.mean(axis=0) + points[i]) / 2])
    off = np.nextafter(points[i], rng.choice([-9.0, 9.0], size=(8, 3)))
    return np.concatenate([points, np.where(points[i] == 0, 0.0, off)])  # an ulp of 0 is no length
