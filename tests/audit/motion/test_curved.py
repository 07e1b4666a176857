"""Curved shapes on the move, from scene files: against closed forms."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from satcheck.audit import Settings, check
from satcheck.audit.motion.moving_pair import SHORTEST_STEP
from tests.audit.shapes import bracket, write


def swept(
    folder: Path,
    bodies: str,
    motion: str,
    tolerance: float | None = 0.0,
    clearance: float | None = None,
):
    path = folder / "scene.toml"
    text = f'schema = "satcheck.scene/1"\nbodies = [{bodies}]\n[[motion]]\nbodies = "a"\n{motion}\n'
    path.write_text(text, encoding="utf-8")
    (finding,) = check([path], Settings(tolerance=tolerance, clearance=clearance)).findings
    return finding.motion


BALL = '{id = "a", shape = {type = "sphere", radius = 1}}'


def test_balls_meet(tmp_path: Path) -> None:
    """Centres at (0, 0), moved along x, and (5, 1.2): they are 2 apart at x = 5 - 1.6."""
    other = '{id = "b", shape = {type = "sphere", radius = 1}, position = [5, 1.2, 0]}'
    found = swept(tmp_path, f"{BALL}, {other}", "translation = [6.8, 0, 0]")
    low, high = found.time_of_impact
    assert low <= 0.5 <= high
    # They sink in at 1.6 / 2 of the speed.
    assert high - low <= 2 * SHORTEST_STEP + 2 * found.tolerance / (6.8 * 0.8)


def test_balls_pass(tmp_path: Path) -> None:
    other = '{id = "b", shape = {type = "sphere", radius = 1}, position = [5, 1.5, 2]}'
    found = swept(tmp_path, f"{BALL}, {other}", "translation = [10, 0, 0]", clearance=1.0)
    assert found.relation == "near"
    assert found.worst.distance[0] <= 0.5 <= found.worst.distance[1]


def test_a_ball_rolls_on_the_floor(tmp_path: Path) -> None:
    """It slides, that is: a ball does not see its own turning."""
    floor = '{id = "b", shape = {type = "box", size = [50, 50, 2]}, position = [0, 0, -2]}'
    found = swept(tmp_path, f"{BALL}, {floor}", "translation = [10, 3, 0]")
    assert found.relation == "touching"


@pytest.mark.parametrize("degrees", [90, -90])
def test_a_rod_swings_against_a_ball(tmp_path: Path, degrees: int) -> None:
    """A capsule from the origin along x; the ball at 60 degrees, 3 away, radius 0.5: they meet
    when the axis comes to within 1 of the centre."""
    rod = (
        '{id = "a", shape = {type = "capsule", radius = 0.5, length = 4}, position = [2, 0, 0],'
        " euler = [0, 90, 0]}"
    )
    x, y = 3 * math.cos(math.radians(60)), 3 * math.sin(math.radians(60))
    side = math.copysign(1, degrees)
    ball = (
        f'{{id = "b", shape = {{type = "sphere", radius = 0.5}}, position = [{x}, {side * y}, 0]}}'
    )
    motion = f"rotation = {{axis = [0, 0, 1], degrees = {degrees}}}"
    found = swept(tmp_path, f"{rod}, {ball}", motion, tolerance=1e-9)
    truth = (60 - math.degrees(math.asin(1 / 3))) / 90
    assert found.time_of_impact[0] <= truth <= found.time_of_impact[1]
    assert found.time_of_impact[1] - found.time_of_impact[0] <= 1e-8


def test_a_ball_in_the_notch_of_an_l(tmp_path: Path) -> None:
    """The hull of the L holds the ball, whose centre is 2 away from the walls."""
    write(tmp_path, l=bracket())
    notch = '{id = "b", mesh = "l.obj", position = [-4, -4, -2]}'
    up = swept(tmp_path, f"{BALL}, {notch}", "translation = [0, 0, 9]", clearance=2.0)
    assert up.relation == "near"
    assert up.worst.distance[0] <= 1.0 <= up.worst.distance[1]
    into = swept(tmp_path, f"{BALL}, {notch}", "translation = [-3, 0, 0]")
    assert into.time_of_impact[0] <= 1 / 3 <= into.time_of_impact[1]
    assert into.time_of_impact[1] - into.time_of_impact[0] <= 1e-8
    slides = f"{BALL}, {notch.replace('-4, -4', '-3, -3')}"
    assert swept(tmp_path, slides, "translation = [0, 0, 9]").relation == "touching"
    other = '{id = "b", shape = {type = "sphere", radius = 1}, position = [0, 0, 0]}'
    swapped = swept(tmp_path, notch.replace('"b"', '"a"') + ", " + other, "translation = [3, 0, 0]")
    assert swapped.time_of_impact[0] <= 1 / 3 <= swapped.time_of_impact[1]


@pytest.mark.parametrize("kind", ["cylinder", "cone", "ellipsoid", "capsule"])
def test_any_curved_shape_turns_in_front_of_a_wall(tmp_path: Path, kind: str) -> None:
    """Its end, 1.5 from the middle, reaches 1.5 sideways after a quarter of a turn about x."""
    sizes = {
        "cylinder": "radius = 0.001, height = 3",
        "cone": "radius = 0.001, height = 3",
        "ellipsoid": "radii = [0.001, 0.001, 1.5]",
        "capsule": "radius = 0.001, length = 2.998",
    }
    write(tmp_path, l=bracket())
    body = f'{{id = "a", shape = {{type = "{kind}", {sizes[kind]}}}}}'
    turn = "rotation = {axis = [1, 0, 0], degrees = 180}"
    far = '{id = "b", mesh = "l.obj", position = [-3, 1.5002, -2]}'
    assert swept(tmp_path, f"{body}, {far}", turn).relation == "separated"
    close = '{id = "b", mesh = "l.obj", position = [-3, 1.4, -2]}'
    found = swept(tmp_path, f"{body}, {close}", turn)
    truth = math.asin(1.4 / 1.5) / math.pi  # of a thin one; its width of 0.001 is worth 0.001 rad
    assert found.relation == "penetrating"
    assert abs(found.time_of_impact[0] - truth) <= 0.002 / math.cos(math.pi * truth)


@pytest.mark.parametrize("way", ["[0, 0, 2]", "[2, 1, 0]"])
@pytest.mark.parametrize("tolerance", [0.0, 0.01])
def test_a_can_is_lifted_off_the_floor_or_slid_along_it(
    tmp_path: Path, way: str, tolerance: float
) -> None:
    """It stands on the floor as far as bounds tell, which is no reason not to look on."""
    can = '{id = "a", shape = {type = "cylinder", radius = 0.55, height = 1.1}'
    floor = '{id = "b", shape = {type = "box", size = [10, 10, 1]}, position = [0, 0, -0.5]}'
    bodies = f"{can}, position = [0.1, 0.2, 0.55]}}, {floor}"
    found = swept(tmp_path, bodies, f"translation = {way}", tolerance)
    assert (found.relation, found.reached, found.contact) == ("touching", 1.0, 0.0)
    down = swept(tmp_path, bodies, "translation = [0, 0, -0.5]", tolerance)
    assert down.relation == "penetrating"
