"""Needles, plates and slivers of aspect 1e6 to 1e12."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product

import numpy as np

from tests.hard_cases.case import ConvexPair, Points, pair
from tests.hard_cases.shapes import box, mapped, moved, random_rotation, tetrahedron

CATEGORY = "needles, slivers: aspect 1e6+"

ASPECTS = (1e6, 1e9, 1e12)
MAKERS: dict[str, Callable[[float], Points]] = {
    "needle": lambda t: box((1, t, t)),
    "plate": lambda t: box((1, 1, t)),
    "splinter": lambda t: tetrahedron() * np.array([1, t, t]),
    "sliver": lambda t: np.array([[-1, 0, t], [1, 0, t], [0, -1, -t], [0, 1, -t]]),
    "blade": lambda t: np.array([[-1, 0, 0], [1, 0, 0], [0.3, t, 0], [0.3, t / 2, t]]),
}
PLACES = ("crossing", "near the surface", "apart")


def cases(seed: int) -> Iterator[ConvexPair]:
    rng = np.random.default_rng(seed)
    bodies: dict[str, Callable[[float], Points]] = {"box": lambda _: box((0.5, 0.5, 0.5)), **MAKERS}
    for (one, make), (other, make_other), aspect in product(
        MAKERS.items(), bodies.items(), ASPECTS
    ):
        for place in PLACES:
            thin = 1 / aspect
            a = mapped(random_rotation(rng), make(thin))
            b = mapped(random_rotation(rng), make_other(thin))
            if place == "crossing":
                offset = rng.uniform(-0.3, 0.3, 3) * (1.0 if other == "box" else thin)
            elif place == "apart":
                offset = rng.normal(size=3)
            else:  # a vertex of B on a point of A, and off it by less than the thickness
                weights = rng.dirichlet(np.ones(len(a)))
                offset = weights @ a - b[0] + rng.normal(size=3) * thin * 0.1
            yield pair(CATEGORY, f"{one} and {other} 1:{aspect:g}, {place}", a, moved(b, *offset))
    yield from aligned()


def aligned() -> Iterator[ConvexPair]:
    """The same thin bodies without any rounding, face on face and face in face."""
    for aspect in ASPECTS:
        thin = 2.0 ** -round(np.log2(aspect))
        for name in ("needle", "plate"):
            a = MAKERS[name](thin)
            for part, expected in ((2.0, "touching"), (1.5, "penetrating"), (2.5, "separated")):
                b = moved(a, 0.5, 0, part * thin)
                yield pair(CATEGORY, f"{name} 1:{aspect:g} on itself, {part} thick", a, b, expected)
