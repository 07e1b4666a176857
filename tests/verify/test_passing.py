"""Whether one of two solids passes through the other, decided from their surfaces alone."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck import core
from satcheck.verify import Rejected
from satcheck.verify.excuse import neither_passes
from satcheck.verify.pairs import Pair
from satcheck.verify.surfaces import meeting
from tests.audit.shapes import Mesh, box, bracket, moved, unit_box
from tests.audit.stages.certificate.test_thickness import prism
from tests.audit.stages.test_explained import PLATE, SPIKE
from tests.audit.stages.test_thickness import wedge
from tests.verify.reports import pieces, turned
from tests.verify.test_cover import pair_of


def ring(n: int, inner: float, outer: float, low: float, high: float) -> Mesh:
    """A plate with a hole, both of n corners."""
    angles = [2 * math.pi * k / n for k in range(n)]
    points = [
        (r * math.cos(t), r * math.sin(t), z)
        for r, z in ((outer, low), (outer, high), (inner, high), (inner, low))
        for t in angles
    ]
    after = [(k, (k + 1) % n) for k in range(n)]
    around = [(m * n, (m + 1) % 4 * n) for m in range(4)]
    return points, [(i + k, i + m, j + m, j + k) for i, j in around for k, m in after]


def random_rods(seed: int) -> list[Mesh]:
    """Two rods of three to seven corners, at random through each other."""
    random = np.random.default_rng(seed)
    rods = []
    for n in random.integers(3, 8, 2):
        points, faces = prism(int(n), 1.0, 0.0, -2.0, 2.0)
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        turn *= np.sign(np.linalg.det(turn))
        placed = np.array(points) @ turn.T + random.uniform(-0.8, 0.8, 3)
        rods.append(([tuple(p) for p in placed.tolist()], faces))
    return rods


BAR = box((-1, 0.25, 0.25), (2, 0.75, 0.75))
NAIL = box((0.25, 0.25, 0.75), (0.75, 0.75, 2.0))
THROUGH = "one body passes through the other"
OPEN_FACE = "a face that bounds no material lies in the other body"

# name: A, B, why it is rejected; None: neither passes
PAIRS: dict[str, tuple[Mesh, Mesh, str | None]] = {
    "a spike through a plate": (PLATE, SPIKE, THROUGH),
    "a bar through a box": (unit_box(), BAR, THROUGH),
    "a bar across a notch": (bracket(), box((-1, 1, 1), (7, 4.5, 2)), THROUGH),
    "a bar through one of two boxes": (pieces(unit_box(5.0), unit_box()), BAR, THROUGH),
    "a nail in a box": (unit_box(), NAIL, None),
    "two nails in a box": (unit_box(), pieces(NAIL, moved(NAIL, 0.0, 0.0, -1.5)), None),
    "a wedge in a box": (unit_box(), wedge(), None),
    "corners": (unit_box(), unit_box(0.75, 0.75, 0.75), None),
    "flush boxes": (unit_box(), unit_box(0.75), None),
    "on a face": (unit_box(), unit_box(1.0), None),
    "inside": (unit_box(), unit_box(0.25, 0.25, 0.25, edge=0.5), None),
    "a bolt of 16 corners in a hole of 24": (
        prism(16, 5.0, 0.25, -1.0, 3.0),
        ring(24, 5.0, 8.0, 0.0, 2.0),
        None,
    ),
    "a face within the material": (pieces(unit_box(), unit_box(0.5)), NAIL, OPEN_FACE),
    "a wall without thickness": (
        pieces(unit_box(5.0), unit_box(0.5), turned(unit_box(0.5))),
        NAIL,
        OPEN_FACE,
    ),
    "two edges in one": (
        pieces(unit_box(), unit_box(1.0, 1.0)),
        unit_box(0.5, 0.5, 0.25),
        "the common part meets itself in an edge",
    ),
}


def rejected(pair: Pair) -> str | None:
    try:
        neither_passes(pair, meeting(pair.a, pair.b))
    except Rejected as why:
        return str(why)
    return None


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("swapped", [False, True], ids=["", "swapped"])
def test_what_passes_is_rejected_and_so_is_what_is_not_simple(name: str, swapped: bool) -> None:
    a, b, why = PAIRS[name]
    assert rejected(pair_of(b, a) if swapped else pair_of(a, b)) == why


@pytest.mark.parametrize("seed", range(12))
def test_the_core_sees_the_same(seed: int) -> None:
    rods = random_rods(seed)
    pair = pair_of(*rods)
    worlds = pair.a.world, pair.b.world
    meshes = [core.Mesh(w.vertices, w.triangles.astype(np.int32)) for w in worlds]
    surfaces = [core.Surface(mesh, solid=True) for mesh in meshes]
    through = core.passes_through(*surfaces, 10_000)
    assert through is not None
    assert rejected(pair) == (THROUGH if through else None)
