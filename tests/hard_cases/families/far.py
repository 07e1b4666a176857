"""Unit shapes 1e6 to 1e12 from the origin of the world."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from tests.hard_cases.case import ConvexPair, pair
from tests.hard_cases.families.contact import touching_pair
from tests.hard_cases.shapes import TOPS, TURNS, ball, mapped, moved, random_rotation

CATEGORY = "1e6 to 1e12 from the origin"

OFFSETS = (1e6, 1e8, 1e10, 1e12)
DIRECTIONS = ((1.0, 0.0, 0.0), (-1.0, 1.0, 0.0), (1.0, -2.0, 3.0))


def cases(seed: int) -> Iterator[ConvexPair]:
    rng = np.random.default_rng(seed)
    for offset, direction in product(OFFSETS, DIRECTIONS):
        place = offset * np.array(direction)
        ulp = float(np.spacing(np.abs(place).max()))
        for below, above in product(TOPS, TOPS):
            a, b = touching_pair(rng, below, above, list(TURNS)[rng.integers(len(TURNS))])
            name = f"{below} on {above}, {offset:g} along {direction}"
            yield pair(CATEGORY, name, moved(a, *place), moved(b, *place), "touching")
            lift = float(rng.choice([ulp, -ulp, 8 * ulp, -8 * ulp, -0.5, 0.5]))
            b = moved(b, 0, 0, lift)
            name = f"{name}, lifted by {lift:g}"
            yield pair(CATEGORY, name, moved(a, *place), moved(b, *place))
        turn = random_rotation(rng)
        stone, other = (moved(mapped(turn, ball(rng, 16)), *place) for _ in range(2))
        yield pair(CATEGORY, f"stones {offset:g} along {direction}", stone, other)
        other = moved(other, *rng.normal(size=3))
        yield pair(CATEGORY, f"stones {offset:g} along {direction}, beside", stone, other)
