"""Faces, edges and vertices that meet exactly, in every combination and many orientations."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from tests.hard_cases.case import ConvexPair, Points, pair
from tests.hard_cases.shapes import MATRICES, TOPS, TURNS, mapped, moved, upside_down

CATEGORY = "features that touch"

# Where the feature of B lies on that of A: quarters are exact.
PLACES = ((0.0, 0.0), (0.25, 0.0), (2.0, 0.0), (-0.5, 0.75))


def cases(seed: int) -> Iterator[ConvexPair]:
    rng = np.random.default_rng(seed)
    for (below, a), (above, b), (turn, matrix) in product(
        TOPS.items(), TOPS.items(), TURNS.items()
    ):
        for place in PLACES:
            if not meets(below, above, turn, place):
                continue
            name = f"{below} on {above}, {turn} at {place}"
            map_ = MATRICES[rng.integers(len(MATRICES))]
            placed = moved(mapped(matrix, upside_down(b)), *place, 0.0)
            yield pair(CATEGORY, name, mapped(map_, a), mapped(map_, placed), "touching")


def meets(below: str, above: str, turn: str, place: tuple[float, float]) -> bool:
    """Do the features, both in the plane z = 0, have a common point?"""
    x, y = place
    if below == "face" or above == "face":
        return True  # the other feature's middle is at most 2 from the middle of a face of 4 by 4
    if below == above == "vertex":
        return place == (0, 0)
    if below == above == "edge" and turn != "along":
        return abs(x - (y if turn == "diagonal" else 0)) <= 2 and abs(y) <= 2
    if above == "edge" and turn == "across":
        return x == 0
    if above == "edge" and turn == "diagonal":
        return x == y
    return y == 0


def touching_pair(
    rng: np.random.Generator, below: str, above: str, turn: str
) -> tuple[Points, Points]:
    """A below and B above the plane z = 0, touching where the features have their middles."""
    a, b = TOPS[below], mapped(TURNS[turn], upside_down(TOPS[above]))
    stretch = np.diag([1.0, 1.0, float(rng.integers(1, 4))])
    return mapped(stretch, a), b
