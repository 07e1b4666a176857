"""Which pairs the broad phase leaves over, and which it may never make."""

from __future__ import annotations

from itertools import combinations

import pytest

from satcheck.audit.bodies import PlacedBodies, place
from satcheck.audit.close_pairs import ClosePairs
from satcheck.audit.planner import Planner
from satcheck.audit.settings import Settings
from satcheck.core import box_gap
from satcheck.core.shapes import Box
from satcheck.scene import Body, Rule, Scene, Selector, Unreadable
from satcheck.scene.inspect import shape_file
from satcheck.scene.issue import issue

FILE = shape_file(Box((1.0, 1.0, 1.0)), "test.toml")


def at(x, y, z):
    return (1.0, 0, 0, float(x), 0, 1.0, 0, float(y), 0, 0, 1.0, float(z), 0, 0, 0, 1.0)


def row(count, step=1.25, groups=None):
    return tuple(
        Body(f"b{k}", "", FILE, transform=at(step * k, 0, 0), groups=groups[k] if groups else ())
        for k in range(count)
    )


def close_pairs(bodies: PlacedBodies, settings: Settings) -> list[tuple[int, int]]:
    """All close pairs, which blocks of any size give too."""
    close = ClosePairs(bodies, Planner(settings, bodies.book))
    pairs = list(close)
    assert close.count() == len(pairs)
    blocks = list(close.blocks(2))
    assert [pair for block in blocks for pair in block] == pairs
    assert all(len(block) == 2 for block in blocks[:-1])
    return pairs


@pytest.mark.parametrize(
    "settings",
    [Settings(), Settings(clearance=0.5), Settings(tolerance=1.0), Settings(clearance=3.0)],
)
def test_close_is_what_is_asked_about(settings):
    placed_bodies = place(Scene("", None, row(9)), settings)
    asked = max(settings.clearance or 0.0, settings.tolerance or 0.0)
    bounds = [body.bounds for body in placed_bodies.placed.values()]
    assert close_pairs(placed_bodies, settings) == [
        (i, j) for i, j in combinations(range(9), 2) if box_gap(bounds[i], bounds[j]) <= asked
    ]


def test_exempt_pairs_are_not_close():
    bodies = row(6, 0.0, [("left",)] * 3 + [("right", "hall")] * 3)
    allowed = [
        Rule(a=Selector(a), b=Selector(b), allowed=True)
        for a, b in (("b0", "b5"), ("b4", "gone"), ("b[12]", "b3"))
    ]
    scene = Scene("", None, bodies, (), frozenset(("left", "hall")), tuple(allowed))
    placed_bodies = place(scene, Settings())
    found = close_pairs(placed_bodies, Settings())
    assert found == sorted(placed_bodies.book.checked_pairs())
    assert len(found) == 3 * 3 - 1 - 2


def test_numbers_are_those_of_the_bodies_where_some_are_lost():
    lost = Unreadable("lost", "gone.obj", issue("file-not-found", "gone"))
    scene = Scene("", None, row(3, 0.0), (lost,), order=("lost", "b0", "b1", "b2"))
    placed_bodies = place(scene, Settings())
    assert close_pairs(placed_bodies, Settings()) == [
        (1, 2),
        (1, 3),
        (2, 3),
    ]
