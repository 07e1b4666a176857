"""The rational truth about bodies on a line: against closed forms, and against another oracle."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from bench.swept_truth import Convex, Meeting, Point, is_convex, meeting
from tests.oracles.translated_pair import overlap_times

SIDES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


def tetrahedron(draw: random.Random) -> Convex:
    while True:
        p = [(draw.randint(-9, 9), draw.randint(-9, 9), draw.randint(-9, 9)) for _ in range(4)]
        u, v, w = ([c - d for c, d in zip(q, p[0], strict=True)] for q in p[1:])
        volume = sum(u[i] * (v[i - 2] * w[i - 1] - v[i - 1] * w[i - 2]) for i in range(3))
        if volume:
            return Convex(p, SIDES if volume > 0 else [(i, k, j) for i, j, k in SIDES])


def test_random_tetrahedra() -> None:
    draw = random.Random(3)
    for _ in range(60):
        a, b = tetrahedron(draw), tetrahedron(draw)
        assert is_convex(a)
        move = draw.randint(-20, 20), draw.randint(-20, 20), draw.randint(1, 20)
        times = overlap_times(a.points, b.points, move)
        expected = None
        if times is not None and times[0] < 1 and times[1] > 0:
            expected = max(times[0], Fraction(0))
        assert meeting([a], move, [b]).overlap == expected


TRIANGLE = Convex([(0, 0, 0), (3, 0, 0), (0, 3, 0)], [(0, 1, 2)])


@pytest.mark.parametrize(
    ("points", "move", "touch", "overlap"),
    [
        # A corner onto the inside of the triangle, and through it.
        ([(1, 1, 2), (1, 2, 5), (2, 1, 5)], (0, 0, -4), Fraction(1, 2), Fraction(1, 2)),
        # Onto its corner, up to it, and not so far.
        ([(0, 0, 2), (-1, 0, 5), (-1, -1, 5)], (0, 0, -2), Fraction(1), None),
        ([(0, 0, 2), (-1, 0, 5), (-1, -1, 5)], (0, 0, -1), None, None),
        # In its plane: a corner onto an edge, and past it.
        ([(2, 2, 0), (4, 3, 0), (3, 4, 0)], (-1, -1, 0), Fraction(1, 2), None),
        ([(4, 0, 0), (5, 0, 0), (5, 1, 0)], (0, 9, 0), None, None),
        # Parallel to it, through it.
        ([(0, 0, 1), (1, 0, 1), (0, 1, 1)], (0, 0, -2), Fraction(1, 2), None),
    ],
)
def test_triangles(
    points: list[Point], move: Point, touch: Fraction | None, overlap: Fraction | None
) -> None:
    a = Convex(points, [(0, 1, 2)])
    assert meeting([a], move, [TRIANGLE]) == Meeting(touch, overlap)
