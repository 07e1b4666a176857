"""The cells of the search for the thickness show its upper end, and nothing below it."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from satcheck import core
from satcheck.audit.stages.certificate.cells import cells
from satcheck.verify import Rejected
from satcheck.verify.pairs import Pair
from satcheck.verify.thickness import at_most, holds_ball
from tests.audit.shapes import Mesh, bracket, moved, unit_box
from tests.verify.reports import pieces
from tests.verify.test_cover import pair_of

WORK = 1_000_000_000
NOTHING = Fraction(0), Fraction(0)


def prism(n: int, radius: float, phase: float, low: float, high: float) -> Mesh:
    angles = [2 * math.pi * (k + phase) / n for k in range(n)]
    points = [(radius * math.cos(t), radius * math.sin(t), z) for z in (low, high) for t in angles]
    walls = [(k, (k + 1) % n, (k + 1) % n + n, k + n) for k in range(n)]
    return points, [*walls, tuple(range(n - 1, -1, -1)), tuple(range(n, 2 * n))]


def turned(mesh: Mesh) -> Mesh:
    """About an axis of no symmetry; coordinates are rounded."""
    x, y, z = np.array((1.0, 2.0, 3.0)) / math.sqrt(14)
    k = np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
    turn = np.eye(3) + math.sin(0.9) * k + (1 - math.cos(0.9)) * k @ k
    points, faces = mesh
    return [tuple(p) for p in (np.array(points) @ turn.T).tolist()], faces


# name: A, B, the thickness
THICK: dict[str, tuple[Mesh, Mesh, float]] = {
    "boxes": (unit_box(), unit_box(0.75, 0.25, 0.125), 0.25),
    "flush boxes": (unit_box(), unit_box(0.75), 0.25),
    "boxes askew": (turned(unit_box()), turned(unit_box(0.75, 0.25, 0.125)), 0.25),
    "far away": (moved(unit_box(), 4e5, 5e6, 0.0), moved(unit_box(0.75), 4e5, 5e6, 0.0), 0.25),
    "a box in a notch": (
        bracket(),
        unit_box(1.5, 1.5, 1.0, edge=2.0),
        2 * math.sqrt(2) / (2 + 2 * math.sqrt(2)),
    ),
    "a box in a bracket": (bracket(), unit_box(0.5, 0.5, 1.0), 1.0),
    "one of two boxes": (pieces(unit_box(), unit_box(8.0)), unit_box(0.75, 0.25, 0.125), 0.25),
    "rods": (prism(12, 1.0, 0.0, 0.0, 4.0), prism(9, 1.0, 0.25, 3.5, 8.0), 0.5),
}


def surfaces(pair: Pair) -> list[core.Surface]:
    worlds = pair.a.world, pair.b.world
    meshes = [core.Mesh(w.vertices, w.triangles.astype(np.int32)) for w in worlds]
    return [core.Surface(mesh, solid=True) for mesh in meshes]


@pytest.mark.parametrize("name", THICK)
@pytest.mark.parametrize("swapped", [False, True], ids=["", "swapped"])
def test_the_search_leaves_what_shows_its_ends(name: str, swapped: bool) -> None:
    a, b, thickness = THICK[name]
    pair = pair_of(b, a) if swapped else pair_of(a, b)
    interval = core.search_thickness(*surfaces(pair), width=0.01, work=WORK, prove=True)
    assert interval.lower <= thickness * (1 + 1e-9)
    assert interval.upper >= thickness * (1 - 1e-9)
    assert interval.proof is not None
    assert interval.centre is not None
    shown = cells(interval.proof)
    assert shown is not None
    at_most(shown, pair.a, pair.b, Fraction(interval.upper) / 2, NOTHING)
    for body in (pair.a, pair.b):
        holds_ball(body, interval.centre, Fraction(interval.lower) / 2)
    with pytest.raises(Rejected):
        at_most(shown, pair.a, pair.b, Fraction(interval.lower) / 2 * 99 / 100, NOTHING)


@pytest.mark.parametrize("less", [(0.0625, 0.125), (0.125, 0.5), (0.5, 0.0)])
def test_so_it_does_of_surfaces_that_may_be_off(less: tuple[float, float]) -> None:
    a, b, _ = THICK["a box in a notch"]
    pair = pair_of(a, b)
    interval = core.search_thickness(
        *surfaces(pair), width=0.01, work=WORK, less_a=less[0], less_b=less[1], prove=True
    )
    assert interval.proof is not None
    shown = cells(interval.proof)
    assert shown is not None
    off = Fraction(less[0]), Fraction(less[1])
    at_most(shown, pair.a, pair.b, max(Fraction(interval.upper) / 2, Fraction(0)), off)
    if interval.lower > 0:
        with pytest.raises(Rejected):
            at_most(shown, pair.a, pair.b, Fraction(interval.lower) / 4, off)


def test_nothing_is_written_down_where_nobody_asks() -> None:
    a, b, _ = THICK["boxes"]
    first, second = surfaces(pair_of(a, b))
    assert core.search_thickness(first, second, width=0.01, work=WORK).proof is None
