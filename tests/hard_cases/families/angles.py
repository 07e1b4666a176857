"""Edges and faces that are parallel, or nearly so, down to 1e-15 rad."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from tests.hard_cases.case import ConvexPair, pair
from tests.hard_cases.shapes import TOPS, about, box, mapped, moved, random_rotation, upside_down

CATEGORY = "nearly parallel to 1e-15 rad"

ANGLES = (0.0, 1e-15, 3e-15, 1e-14, 1e-13, 1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-4, 1e-2)
LIFTS = (0.0, 1e-15, -1e-15, 1e-9, -1e-9, 1e-3, -1e-3, -0.5)


def cases(seed: int) -> Iterator[ConvexPair]:
    rng = np.random.default_rng(seed)
    for angle, lift in product(ANGLES, LIFTS):
        ridge = mapped(about(2, angle), upside_down(TOPS["edge"]))
        yield pair(
            CATEGORY,
            f"ridge on ridge, {angle:g} rad, lifted by {lift:g}",
            TOPS["edge"],
            moved(ridge, 0.25, 0, lift),
        )
        axis = int(rng.integers(3))
        yield pair(
            CATEGORY,
            f"box on box, {angle:g} rad about axis {axis}, lifted by {lift:g}",
            box(),
            moved(mapped(about(axis, angle), box()), 0.25, 0.125, 2 + lift),
        )
        tilted = mapped(about(0, angle), mapped(about(1, angle / 3), upside_down(TOPS["edge"])))
        yield pair(
            CATEGORY,
            f"ridge on face, {angle:g} rad, lifted by {lift:g}",
            TOPS["face"],
            moved(tilted, 0, 0.5, lift),
        )
        turn = random_rotation(rng)
        beam = box((10, 0.5, 0.5))
        turned = mapped(about(1, angle), mapped(about(2, angle), beam))
        yield pair(
            CATEGORY,
            f"beam along beam, {angle:g} rad, turned, lifted by {lift:g}",
            mapped(turn, beam),
            mapped(turn, moved(turned, 0.5, 1 + lift, 0.25)),
        )
