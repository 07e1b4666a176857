"""Hulls of 500 and more vertices, prisms of 200 sides."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tests.hard_cases.case import ConvexPair, pair
from tests.hard_cases.shapes import about, ball, box, mapped, moved, prism, random_rotation

CATEGORY = "500+ vertices, 200 sides"

LIFTS = (-0.5, -1e-3, -1e-9, 0.0, 1e-9, 1e-3, 0.5)


def cases(seed: int) -> Iterator[ConvexPair]:
    rng = np.random.default_rng(seed)
    tall, low = prism(200, 1.0, 1.0), prism(200, 1.0, 0.25)
    for lift in LIFTS:
        yield pair(CATEGORY, f"prisms on end, {lift:g}", tall, moved(tall, 0.1, 0.2, 2 + lift))
        yield pair(CATEGORY, f"prisms side by side, {lift:g}", tall, moved(tall, 2 + lift, 0, 0.5))
        across = mapped(about(1, np.pi / 2), tall)
        yield pair(CATEGORY, f"prisms crossed, {lift:g}", tall, moved(across, 0, 2 + lift, 0))
        turn = random_rotation(rng)
        a, b = mapped(turn, tall), mapped(turn, moved(tall, 1.2, 0.9, 2 + lift))
        yield pair(CATEGORY, f"prisms on end, turned, {lift:g}", a, b)
        stone = ball(rng, 500, (1, 0.8, 0.6))
        other = ball(rng, 600)
        way = rng.normal(size=3)
        way /= np.linalg.norm(way)
        reach = (stone @ way).max() - (other @ way).min() + lift
        name = f"hulls of 500 and 600, {lift:g}"
        yield pair(CATEGORY, name, stone, moved(other, *(reach * way)))
        cube = moved(mapped(turn, box()), *(((stone @ way).max() + 1 + lift) * way))
        yield pair(CATEGORY, f"hull of 500 and a box, {lift:g}", stone, cube)
    for count in (512, 1000):
        a = ball(rng, count)
        yield pair(CATEGORY, f"hull of {count} in itself, 0.5 off", a, moved(a, 0.5, 0, 0))
        yield pair(CATEGORY, f"hulls of {count} deep", a, moved(ball(rng, count), 0.3, 0.4, 0.5))
    yield pair(CATEGORY, "flat prisms, concentric", low, low, "penetrating")
    yield pair(CATEGORY, "flat prism in a tall one", tall, low, "penetrating")
    yield pair(CATEGORY, "prisms of 200 in each other", tall, moved(tall, 0.5, 0, 0), "penetrating")
