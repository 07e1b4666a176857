"""Gaps and depths from one ulp to 1e-3, between every combination of features."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product

import numpy as np

from tests.hard_cases.case import ConvexPair, Points, pair
from tests.hard_cases.families.contact import touching_pair
from tests.hard_cases.shapes import MATRICES, TOPS, TURNS, box_between, mapped, random_rotation

CATEGORY = "gaps, depths: 1 ulp to 1e-3"

STEPS = (1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)


def cases(seed: int) -> Iterator[ConvexPair]:
    yield from one_ulp()
    rng = np.random.default_rng(seed)
    for (below, above), step in product(product(TOPS, TOPS), STEPS):
        for sign in (1, -1):
            turn = list(TURNS)[rng.integers(len(TURNS))]
            a, b = touching_pair(rng, below, above, turn)
            shifted = b + np.array([0.0, 0.0, sign * step])
            name = f"{below} on {above}, {turn}, {'gap' if sign > 0 else 'depth'} {step:g}"
            yield pair(CATEGORY, name, *turned(rng, a, shifted))


def turned(rng: np.random.Generator, a: Points, b: Points) -> tuple[Points, Points]:
    """Both as they are, through an integer map, or through a rotation: rounded either way."""
    way = rng.integers(3)
    if way == 0:
        return a, b
    matrix = MATRICES[rng.integers(1, 4)] if way == 1 else random_rotation(rng)
    return mapped(matrix, a), mapped(matrix, b)


def one_ulp() -> Iterator[ConvexPair]:
    """Boxes that face, edges and corners keep apart, or in each other, by the last bit."""
    cube = box_between((-1, -1, -1), (1, 1, 1))
    for axes in ((0,), (1,), (2,), (0, 1), (1, 2), (0, 2), (0, 1, 2)):
        for toward, expected in ((2.0, "separated"), (0.0, "penetrating")):
            step = math.nextafter(1.0, toward)
            low = [step if axis in axes else -0.5 for axis in range(3)]
            name = f"boxes, axes {axes}, {expected} by one ulp"
            other = box_between(tuple(low), (3, 3, 3))
            yield pair(CATEGORY, name, cube, other, expected)
            if len(axes) > 1:
                low = [
                    step if axis == axes[0] else 1.0 if axis in axes else -0.5 for axis in range(3)
                ]
                one = "separated" if toward > 1 else "touching"
                other = box_between(tuple(low), (3, 3, 3))
                yield pair(CATEGORY, f"{name} along one axis", cube, other, one)
