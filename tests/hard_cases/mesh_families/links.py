"""Octagonal rings in chains and on rods, tilted exactly, apart or in touch to the last bit.

A ring is eight convex pieces with integer corners; the truth about two such bodies is that about
the pairs of their pieces.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product

import numpy as np

from tests.hard_cases.case import Points
from tests.hard_cases.mesh_case import MeshPair, mesh_of_polygons
from tests.hard_cases.shapes import box_between, mapped, moved
from tests.oracles.exact_distance import Difference, exact_truth

CATEGORY = "octagonal rings, chains, rods"

# Three times a rotation, in integers; a permutation of axes; none.
TILT = np.array([[1.0, 2, 2], [2, 1, -2], [2, -2, 1]]) * np.array([1, 1, -1])
UPRIGHT = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
OCTAGON = np.array([[3, 1], [1, 3], [-1, 3], [-3, 1], [-3, -1], [-1, -3], [1, -3], [3, -1]], float)
OUTER, INNER, HALF = 3.0, 2.0, 1.0  # a hole from -6 to 6 in a ring from -9 to 9

Quads = list[Points]


def ring() -> tuple[list[Points], Quads]:
    """The pieces, and the faces counter-clockwise from outside."""
    pieces, quads = [], []
    for i in range(8):
        p, q = OCTAGON[i], OCTAGON[(i + 1) % 8]
        outer, inner = (np.array([p, q]) * size for size in (OUTER, INNER))
        corner = [[np.append(c, z) for c in (*outer, *inner)] for z in (-HALF, HALF)]
        (op, oq, ip, iq), (op2, oq2, ip2, iq2) = corner
        pieces.append(np.array([*corner[0], *corner[1]]))
        quads += [[op, oq, oq2, op2], [iq, ip, ip2, iq2], [op2, oq2, iq2, ip2], [oq, op, ip, iq]]
    return pieces, [np.array(quad) for quad in quads]


def block(low: tuple[float, ...], high: tuple[float, ...]) -> tuple[list[Points], Quads]:
    corners = box_between(low, high)
    faces = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return [corners], [corners[list(face)] for face in faces]


def place(
    body: tuple[list[Points], Quads], matrix: Points, offset: tuple[float, ...]
) -> tuple[list[Points], Quads]:
    pieces, quads = body
    return (
        [moved(mapped(matrix, piece), *offset) for piece in pieces],
        [moved(mapped(matrix, quad), *offset) for quad in quads],
    )


def cases(seed: int) -> Iterator[MeshPair]:
    rng = np.random.default_rng(seed)
    rod = block((-1, -1, -20), (1, 1, 20))
    others = {"rod": rod, "link": place(ring(), UPRIGHT, (0, 0, 0))}
    # The rod's side is at x + 1, the bar of the link at x - 9 to x - 6, the wall of the hole at 6.
    shifts = {"rod": (*around(5.0), *around(10.0), 0.0, 4.5, 6.0, 9.5), "link": (9.0, 10.5, 15.0)}
    shifts["link"] += (*around(12.0), *around(3.0), *around(18.0))
    for name, body in others.items():
        for shift, (way, matrix) in product(shifts[name], (("flat", np.eye(3)), ("tilted", TILT))):
            pieces_a, quads_a = place(ring(), matrix, (0, 0, 0))
            pieces_b, quads_b = place(place(body, np.eye(3), (shift, 0, 0)), matrix, (0, 0, 0))
            truths = [exact_truth(p, q) for p in pieces_a for q in pieces_b]
            outcomes = {truth.outcome for truth in truths}
            relation = next(o for o in ("penetrating", "touching", "separated") if o in outcomes)
            squared = min(Difference(p, q).squared_distance() for p in pieces_a for q in pieces_b)
            turn = int(rng.integers(3))
            yield MeshPair(
                CATEGORY,
                f"ring and {name}, {way}, {shift!r} off",
                mesh_of_polygons([q.tolist() for q in quads_a], turn),
                mesh_of_polygons([q.tolist() for q in quads_b]),
                relation,
                squared,
            )


def around(shift: float) -> tuple[float, float, float]:
    """It and its neighbours two ulps away: adding it to corners rounds to one ulp of these."""
    ulp = 2 * math.ulp(shift)
    return shift - ulp, shift, shift + ulp
