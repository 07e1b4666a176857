"""Points, segments and polygons, with each other and with solids."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations_with_replacement

import numpy as np

from tests.hard_cases.case import ConvexPair, Points, pair
from tests.hard_cases.shapes import MATRICES, box, mapped, moved, polygon, random_rotation

CATEGORY = "points, segments, polygons"

FLATS: dict[str, Points] = {
    "point": np.zeros((1, 3)),
    "segment": np.array([[-1.0, 0, 0], [1, 0, 0]]),
    "triangle": np.array([[-1.0, -1, 0], [1, -1, 0], [0, 1, 0]]),
    "square": np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]),
}
SOLIDS: dict[str, Points] = {"box": box(), "wedge": np.array([[0.0, 0, 0], *(2 * np.eye(3))])}
# B moved by this: in place, along the flat, off its end, across it by little and by much.
OFFSETS = (
    (0.0, 0.0, 0.0),
    (0.5, 0.0, 0.0),
    (2.0, 0.0, 0.0),
    (2.25, 0.0, 0.0),
    (0.25, 0.5, 2.0**-40),
    (0.0, 0.0, 1.0),
    (1.0, 1.0, 1.0),
)


def cases(seed: int) -> Iterator[ConvexPair]:
    rng = np.random.default_rng(seed)
    upright = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    pairs = list(combinations_with_replacement(FLATS.items(), 2))
    pairs += [(flat, solid) for flat in FLATS.items() for solid in SOLIDS.items()]
    for (one, a), (other, b) in pairs:
        for offset in OFFSETS:
            for way, matrix in (("flat", np.eye(3)), ("upright", upright)):
                map_ = MATRICES[rng.integers(len(MATRICES))]
                placed = moved(mapped(matrix, b), *offset)
                name = f"{one} and {other}, {way}, at {offset}"
                yield pair(CATEGORY, name, mapped(map_, a), mapped(map_, placed))
        turn = random_rotation(rng)
        yield pair(CATEGORY, f"{one} and {other}, turned", mapped(turn, a), mapped(turn, b))
        apart = moved(mapped(random_rotation(rng), b), *rng.normal(size=3))
        yield pair(CATEGORY, f"{one} and {other}, anywhere", a, apart)
    ring = polygon(12)
    for height in (0.0, 1e-9, 0.5):
        yield pair(CATEGORY, f"polygons of 12, {height:g} apart", ring, moved(ring, 0.5, 0, height))
