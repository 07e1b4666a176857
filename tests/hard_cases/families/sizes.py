"""Sizes from 1e-9 to 1e9, alone and both in one pair."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from tests.hard_cases.case import ConvexPair, Points, pair
from tests.hard_cases.families.contact import touching_pair
from tests.hard_cases.shapes import TOPS, TURNS, ball, box, mapped, moved, random_rotation

CATEGORY = "sizes 1e-9 to 1e9"

SIZES = (1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9)


def cases(seed: int) -> Iterator[ConvexPair]:
    rng = np.random.default_rng(seed)
    for size in SIZES:
        for below, above in product(TOPS, TOPS):
            turn = list(TURNS)[rng.integers(len(TURNS))]
            a, b = touching_pair(rng, below, above, turn)
            lift = float(rng.choice([0.0, 1e-12, -1e-12, 1e-3, -1e-3, -1.0, 2.0]))
            name = f"{below} on {above}, {turn}, lifted by {lift:g}, times {size:g}"
            yield pair(CATEGORY, name, size * a, size * moved(b, 0, 0, lift))
        a, b = ball(rng, 16), mapped(random_rotation(rng), ball(rng, 12))
        yield pair(CATEGORY, f"stones times {size:g}", size * a, size * moved(b, 1, 0.5, 0))
    yield from both(rng)


def both(rng: np.random.Generator) -> Iterator[ConvexPair]:
    """A small body at, in and near a large one."""
    for large, small in (
        (1e9, 1e-9),
        (1e9, 1.0),
        (1e6, 1e-6),
        (1e3, 1e-3),
        (1.0, 1e-9),
        (1.0, 1e-12),
    ):
        for body in ("box", "stone"):
            a = large * (box() if body == "box" else ball(rng, 24))
            b = small * (box() if body == "box" else mapped(random_rotation(rng), ball(rng, 8)))
            corner = a[int(rng.integers(len(a)))]
            inside = rng.dirichlet(np.ones(len(a))) @ a
            side = (a[0] + a[1]) / 2
            for where, place in (
                ("in the middle", np.zeros(3)),
                ("within", inside),
                ("at a corner", corner),
                ("on an edge or within", side),
                ("beside", corner + rng.normal(size=3) * small * 2),
                ("beyond", corner * (1 + 1e-12)),
            ):
                name = f"{body} of {small:g} {where} of {large:g}"
                yield pair(CATEGORY, name, *swapped(rng, a, moved(b, *place)))


def swapped(rng: np.random.Generator, a: Points, b: Points) -> tuple[Points, Points]:
    return (a, b) if rng.random() < 0.5 else (b, a)
