"""Least motions keep their walls, and no shorter ones do."""

from __future__ import annotations

import math
import random

import pytest

from satcheck import core
from satcheck.audit.resolve.walls import Wall, connected, least_motion

X, Y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)


def random_walls(seed: int, bodies: int) -> list[Wall]:
    """All along a fan of directions that a spread of the bodies follows, so that they are kept by
    some translations."""
    dice = random.Random(seed)
    at = [[dice.gauss(0, 1) for _ in range(3)] for _ in range(bodies)]
    walls = []
    for _ in range(3 * bodies):
        a, b = sorted(dice.sample(range(bodies), 2))
        way = [p - q for p, q in zip(at[a], at[b], strict=True)]
        length = math.hypot(*way)
        walls.append(Wall(a, b, tuple(c / length for c in way), dice.uniform(-0.5, 1.0)))
    return walls


@pytest.mark.parametrize("seed", range(10))
def test_the_answer_fulfils_the_conditions_of_karush_kuhn_and_tucker(seed) -> None:
    walls = random_walls(seed, 12)
    found = least_motion(walls, {0: (0.25, 0.0, -0.5)})
    assert not found.broken
    at = {**found.offsets, 0: (0.25, 0.0, -0.5)}
    pushes = {body: [0.0, 0.0, 0.0] for body in at}
    for wall in walls:
        slack = wall.slack(tuple(p - q for p, q in zip(at[wall.a], at[wall.b], strict=True)))
        assert slack >= -1e-5
        assert wall.multiplier >= 0
        assert wall.multiplier * slack == pytest.approx(0, abs=1e-5)
        for axis in range(3):
            pushes[wall.a][axis] += wall.multiplier * wall.normal[axis]
            pushes[wall.b][axis] -= wall.multiplier * wall.normal[axis]
    for body, offset in found.offsets.items():
        assert pushes[body] == pytest.approx(offset, abs=1e-9)


def test_walls_that_exclude_each_other_are_named() -> None:
    shut = [Wall(0, 1, X, 1.0), Wall(1, 2, X, 1.0), Wall(0, 2, X, -1.0), Wall(0, 3, Y, 1.0)]
    shut.append(Wall(2, 0, X, 1.0))
    found = least_motion(shut, {})
    assert {(wall.a, wall.b) for wall in found.broken} <= {(0, 1), (1, 2), (2, 0)}
    assert found.broken


def test_walls_fall_into_islands_at_bodies_that_stay() -> None:
    walls = [Wall(0, 1, X, 1.0), Wall(2, 3, X, 1.0), Wall(1, 4, X, 1.0), Wall(3, 4, X, 1.0)]
    found = connected(walls, frozenset((0, 1, 2, 3)))
    assert found == [[walls[0], walls[2]], [walls[1], walls[3]]]
    assert connected(walls, frozenset(range(5))) == [walls]


@pytest.mark.parametrize(
    "arguments",
    [
        ([True], [(0, 1)], [X], [1.0], [0.0]),
        ([False, False], [(0, 1)], [X], [1.0], [0.0]),
        ([True, True], [(0, 1)], [X], [1.0], []),
        ([True, True], [(0, 1)], [X, Y], [1.0], [0.0]),
    ],
)
def test_lists_that_do_not_fit_are_refused(arguments) -> None:
    with pytest.raises(ValueError, match=r"body|stay|length"):
        core.least_motion(*arguments)
