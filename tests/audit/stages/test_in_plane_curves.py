"""Polygons that stand for curves: what is said of the curves is true of them."""

from __future__ import annotations

import math
from typing import Any

import pytest
from msgspec.structs import replace

from satcheck.audit import Finding, Settings, check
from satcheck.core.shapes import Sphere
from satcheck.scene import Body, Scene
from satcheck.scene.inspect import shape_file
from satcheck.scene.planar.outline import Outline, Shape
from satcheck.scene.rules import Rule, Selector
from tests.scene.planar.flat import scene, sheet

RADIUS = 1000.0


def body(name: str, shape: Shape, x: float = 0.0, y: float = 0.0) -> Body:
    pose = (1.0, 0, 0, x, 0, 1.0, 0, y, 0, 0, 1.0, 0, 0, 0, 0, 1.0)
    return Body(name, name, shape_file(shape, "cell.toml"), pose, shape=shape)


def balls(apart: float, angle: float = 0.0) -> Scene:
    """Two balls with this gap, below 0 an overlap, along a direction."""
    away = 2 * RADIUS + apart
    moved = body("b", Sphere(RADIUS), away * math.cos(angle), away * math.sin(angle))
    return Scene("balls", None, (body("a", Sphere(RADIUS)), moved))


def ask(given: Scene, **settings: Any) -> Finding:
    (finding,) = check(given, Settings(planar="xy", **settings)).findings
    return finding


ANGLES = (0.0, 0.003, math.pi / 256, 0.7, math.pi / 4)


@pytest.mark.parametrize("angle", ANGLES)
def test_the_bounds_of_a_gap_hold_that_of_the_curves(angle: float) -> None:
    given = balls(0.4, angle)
    found = ask(given, clearance=0.5)
    assert (found.relation, found.quality) in (("near", "bounded"), ("separated", "bounded"))
    assert found.distance_bounds is not None
    low, high = found.distance_bounds
    rounding = 1e-9 * RADIUS
    assert low - rounding <= 0.4 <= high + rounding
    assert high == pytest.approx(found.distance, abs=rounding)


@pytest.mark.parametrize(
    ("clearance", "relation", "undecided"),
    [(0.05, "separated", None), (0.25, "separated", "limit"), (0.46, "near", None)],
)
def test_a_clearance_is_kept_by_the_curves(
    clearance: float, relation: str, undecided: str | None
) -> None:
    """Of a gap of 0.4; the curves may be closer than their polygons by 0.3."""
    found = ask(balls(0.4), clearance=clearance)
    assert (found.relation, found.undecided) == (relation, undecided)
    assert found.exact_relation == "separated"


def test_balls_closer_than_the_clearance_do_not_pass() -> None:
    angle = math.pi / 256  # towards the middle of two edges
    assert ask(balls(0.5225, angle), clearance=0.55).severity != "none"


@pytest.mark.parametrize("angle", ANGLES)
def test_the_bounds_of_a_depth_hold_that_of_the_curves(angle: float) -> None:
    given = balls(-0.7, angle)
    found = ask(given, depth=True)
    assert (found.relation, found.exact_relation) == ("penetrating", "penetrating")
    assert found.quality == "bounded"
    assert found.depth_bounds is not None
    low, high = found.depth_bounds
    assert low <= 0.7 <= high == found.depth
    assert found.mtv is not None
    assert found.mtv_verified
    away = 2 * RADIUS - 0.7
    after = math.dist(found.mtv[:2], (away * math.cos(angle), away * math.sin(angle)))
    assert after >= 2 * RADIUS


@pytest.mark.parametrize(
    ("most", "severity", "undecided"),
    [(0.36, "error", None), (0.5, "warning", "limit"), (0.75, "note", None)],
)
def test_a_limit_of_the_depth_is_that_of_the_curves(
    most: float, severity: str, undecided: str | None
) -> None:
    """Of a depth of 0.4; that of the curves may be more than that of their polygons by 0.3."""
    rule = Rule(a=Selector("*"), b=Selector("*"), max_depth=most, where="rules.toml:1")
    found = ask(replace(balls(-0.4), rules=(rule,)))
    assert (found.severity, found.undecided) == (severity, undecided)


def test_without_a_tolerance_the_curves_leave_it_open() -> None:
    """Polygons that miss each other, of balls that overlap."""
    given = balls(-0.01, math.pi / 256)
    apart = ask(given, tolerance=0.0, clearance=None)
    assert (apart.relation, apart.quality) == ("separated", "estimate")
    assert (apart.exact_relation, apart.undecided) == (None, "relation")
    assert ask(given).relation == "touching"


@pytest.mark.parametrize(("room", "shown"), [(0.1, None), (0.5, "contains")])
@pytest.mark.parametrize("swapped", [False, True])
def test_a_ball_in_a_ball(room: float, shown: str | None, swapped: bool) -> None:
    """Within another with more room than the curves may be off."""
    bodies = [body("a", Sphere(RADIUS)), body("b", Sphere(RADIUS - room))]
    found = ask(Scene("balls", None, tuple(bodies[::-1] if swapped else bodies)))
    expected = {"contains": "inside", None: None}[shown] if swapped else shown
    assert found.exact_relation == expected


SLOT = [(-1500.0, -1500.0), (1500.0, -1500.0), (1500.0, 1500.0), (1000.0, 1500.0)]
SLOT += [(1000.0, -1000.0), (-1000.0, -1000.0), (-1000.0, 1500.0), (-1500.0, 1500.0)]


@pytest.mark.parametrize("angle", [0.0, 0.01])
def test_a_ball_in_a_slot(angle: float) -> None:
    """It overlaps one side of the slot by 0.6, and has room on the other side."""
    slot = body("slot", Outline(tuple(SLOT)))
    ball = body("ball", Sphere(990.0), 10.6, 10.6 * math.sin(angle))
    found = ask(Scene("slot", None, (slot, ball)), depth=True)
    assert found.relation == "penetrating"
    assert found.depth_bounds is not None
    low, high = found.depth_bounds
    assert 0.4 < low <= 0.6 <= high < 1.0
    assert found.mtv is not None
    assert found.mtv_verified
    assert 10.6 - found.mtv[0] <= 10.0  # the slot moves away from the ball


def test_straight_lines_stay_exact() -> None:
    square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
    other = [(x + 2.5, y) for x, y in square]
    found = ask(scene(sheet(square), sheet(other)), clearance=1.0)
    assert (found.relation, found.quality, found.distance) == ("near", "exact", 0.5)
    assert found.distance_bounds is None
    other = [(x + 1.5, y) for x, y in square]
    found = ask(scene(sheet(square), sheet(other)), depth=True)
    assert (found.quality, found.depth, found.exact_relation) == ("exact", 0.5, "penetrating")
