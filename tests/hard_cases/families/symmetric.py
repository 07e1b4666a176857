"""Identical, concentric and nested shapes: many shortest ways out, the origin on every feature."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations

import numpy as np

from tests.hard_cases.case import ConvexPair, Points, pair
from tests.hard_cases.shapes import (
    ball,
    box,
    dodecahedron,
    icosahedron,
    mapped,
    moved,
    octahedron,
    prism,
    random_rotation,
    tetrahedron,
)

CATEGORY = "identical, concentric, ties"


def cases(seed: int) -> Iterator[ConvexPair]:
    rng = np.random.default_rng(seed)
    bodies: dict[str, Points] = {
        "tetrahedron": tetrahedron(),
        "cube": box(),
        "octahedron": octahedron(),
        "icosahedron": icosahedron(),
        "dodecahedron": dodecahedron(),
        "prism of 6": prism(6),
        "prism of 8": prism(8),
        "brick": box((3, 2, 1)),
        "needle": box((1, 2.0**-20, 2.0**-20)),
        "stone": ball(rng, 20),
    }
    for name, a in bodies.items():
        yield pair(CATEGORY, f"{name} in itself", a, a, "penetrating")
        yield pair(CATEGORY, f"{name} in its mirror image", a, -a, "penetrating")
        turn = random_rotation(rng)
        turned = mapped(turn, a)
        yield pair(CATEGORY, f"{name} in itself, turned", turned, turned, "penetrating")
        twisted = mapped(random_rotation(rng), a)
        yield pair(CATEGORY, f"{name} twisted in itself", a, twisted, "penetrating")
        for factor in (2.0**-20, 0.5, math.nextafter(1, 0), math.nextafter(1, 2), 3.0):
            yield pair(CATEGORY, f"{name} in itself times {factor!r}", a, factor * a, "penetrating")
        for offset in (2.0**-52, 1e-9, 0.125):
            b = moved(a, offset, 0, 0)
            yield pair(CATEGORY, f"{name} in itself, {offset:g} off", a, b)
            b = moved(a, offset, offset, offset)
            yield pair(CATEGORY, f"{name} in itself, {offset:g} off diagonally", a, b)
    for (one, a), (other, b) in combinations(bodies.items(), 2):
        yield pair(CATEGORY, f"{one} and {other}, concentric", a, b, "penetrating")
    for place in ((0.5, 0, 0), (0.5, 0.5, 0), (0.5, 0.5, 0.5), (0.5, -0.5, 0.5)):
        small = moved(box((0.5, 0.5, 0.5)), *place)
        yield pair(CATEGORY, f"cube in the corner of a cube, {place}", box(), small, "penetrating")
