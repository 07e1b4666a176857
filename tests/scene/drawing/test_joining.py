"""Lines that join end to end, whatever their order and direction."""

from __future__ import annotations

import random
from itertools import pairwise

from satcheck.scene.drawing.joining import Line, join

ROUND = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (2.0, 5.0), (0.0, 3.0)]


def test_the_order_of_lines_does_not_matter() -> None:
    rng = random.Random(3)
    for _ in range(20):
        lines = [Line(pair, 0.0) for pair in pairwise([*ROUND, ROUND[0]])]
        lines = [Line(line.points[:: rng.choice((1, -1))], 0.0) for line in lines]
        lines += [Line(((4.0, 3.0), (9.0, 9.0)), 0.0), Line(((9.0, 9.0), (9.0, 0.0)), 0.0)]
        rng.shuffle(lines)
        found = join(lines)
        assert (found.dead_ends, found.repeated, found.branching) == (True, False, False)
        (loop,) = found.loops
        assert sorted(loop.points) == sorted(ROUND)


def test_a_branch_spoils_its_own_lines_alone() -> None:
    pairs = list(pairwise([*ROUND, ROUND[0]]))
    bridge = ((0.0, 0.0), (2.0, 5.0))
    beside = [tuple((x + 10, y) for x, y in pair) for pair in pairs]
    found = join([Line(pair, 0.0) for pair in (*pairs, bridge, *beside)])
    assert found.branching
    (loop,) = found.loops
    assert min(x for x, _ in loop.points) == 10.0


def test_what_ends_are_apart_counts_as_deviation() -> None:
    off = (1e-9, 0.0)
    lines = [Line((ROUND[0], ROUND[1], ROUND[2]), 0.5), Line((ROUND[2], off), 0.25)]
    (loop,) = join(lines).loops
    assert loop.deviation == 0.5 + 1e-9
