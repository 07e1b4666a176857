"""What is said of a pair over its whole motion, and that nothing is said that was not shown."""

from __future__ import annotations

import math

import pytest

from satcheck.audit.motion import moving_pair, worst
from satcheck.audit.motion.moving_pair import STEPS
from satcheck.audit.motion.open_stretches import INTERVALS, INTERVALS_A_PIECE, open_stretches
from satcheck.scene.motion import PosePath, Rotation, Translation, Waypoint
from tests.audit.motion.pairs import pair_of, sweep, travel_of
from tests.audit.shapes import box, bracket, moved, open_box, unit_box

ORIGIN = (0.0, 0.0, 0.0)
Z = (0.0, 0.0, 1.0)


def swept(a, path, b, other=None, **settings):
    return sweep(pair_of(a, b, **settings), path, other)


def steps_of_bisection(a, path, b, **settings):
    pair = pair_of(a, b, **settings)
    return open_stretches(travel_of(pair, path, None), [pair])[0].steps


def test_a_hit_is_told_in_the_terms_of_the_motion():
    """The front of a blade turns onto a wall whose face lies at 90 degrees."""
    blade = box((1, -0.2, 0), (3, 0, 1))
    found = swept(blade, Rotation(ORIGIN, Z, 180.0), box((-0.5, 1, 0), (0, 3, 1)))
    assert found.relation == "penetrating"
    assert found.time_of_impact[0] <= 0.5 <= found.time_of_impact[1]
    (at,) = found.at
    assert (at.body, at.term) == ("a", "degrees")
    assert at.value == pytest.approx(90.0, abs=1e-4)
    assert found.worst.depth[0] <= found.worst.depth[1]
    assert found.worst.distance is None


def test_both_places_are_told():
    found = swept(
        unit_box(),
        Translation((3.0, 0.0, 4.0)),
        unit_box(2.5, 0, 0),
        PosePath((Waypoint(0.0, ORIGIN), Waypoint(1.0, (0.0, 0.0, 9.0)))),
        clearance=3.0,
    )
    assert found.relation == "near"
    assert {(place.body, place.term) for place in found.worst.at} == {("a", "length"), ("b", "t")}


@pytest.mark.parametrize("body", [unit_box(), moved(bracket(), -5, -5, 0)])
def test_the_clearance_holds_on_the_way(body):
    wall = box((-9, 2.0, -9), (9, 3.0, 9))
    path = Translation((3.0, 0.5, 0.0))  # ends 0.5 away
    assert swept(body, path, wall).relation == "separated"
    near = swept(body, path, wall, clearance=0.75)
    assert near.relation == "near"
    assert near.worst.distance == pytest.approx((0.5, 0.5), rel=0.01)
    kept = swept(body, path, wall, clearance=0.25)
    assert (kept.relation, kept.worst, kept.distance_at_least) == ("separated", None, 0.25)


def test_the_clearance_holds_at_the_end_to_the_last_bit():
    """The gap at the end is smaller than the clearance by 1.8e-15, less than the search for the
    nearest pose can tell: it ends at 0.97."""
    at = {0.0: 0.0, 2.0: 0.5, 4.0: 1.0, 6.0: 1.0}
    points, faces = bracket()
    body = [(at[x], at[y], at[z]) for x, y, z in points], faces
    path, wall = Translation((-2.0000000000000018, 0.0, 0.0)), moved(body, -1.25, 0, 0)
    assert swept(moved(body, 2, 0, 0), path, wall, clearance=0.25).relation == "near"


@pytest.mark.parametrize("body", [unit_box(), moved(bracket(), -5, -5, 0)])
def test_the_nearest_pose_is_not_searched_unless_asked(body, monkeypatch):
    """Neither of bodies that stay apart, nor of bodies that touch."""
    monkeypatch.setattr(moving_pair.MovingPair, "least_gap", None)
    wall = box((-9, 2.0, -9), (9, 3.0, 9))
    apart = swept(body, Translation((3.0, 0.5, 0.0)), wall, tolerance=0.125)
    assert (apart.relation, apart.worst, apart.distance_at_least) == ("separated", None, 0.125)
    on_the_wall = swept(moved(body, 0, 1, 0), Translation((3.0, 0.0, 0.0)), wall)
    assert (on_the_wall.relation, on_the_wall.worst) == ("touching", None)


@pytest.mark.parametrize("rise", [0.75, 0.875, 0.9375])
def test_as_near_as_the_tolerance_is_a_touch(rise):
    """The bodies come to within 0.25, 0.125 and 0.0625."""
    found = swept(
        unit_box(),
        Translation((3.0, rise, 0.0)),
        box((-9, 2.0, -9), (9, 3.0, 9)),
        tolerance=0.125,
    )
    assert found.contact is None
    assert found.relation == ("touching" if rise > 0.875 else "separated")
    assert (found.distance_at_least == 0.125) is (rise < 0.875)


@pytest.mark.parametrize("ulps", [0, 2, 4])
def test_where_the_motion_ends_decides_as_at_rest(ulps):
    """Although the touch band of a sweep is as wide as the rounding of poses."""
    way = 1.0 + ulps * math.ulp(1.0)
    found = swept(unit_box(), Translation((way, 0.0, 0.0)), unit_box(2, 0, 0), tolerance=0.0)
    assert found.tolerance > 4 * math.ulp(1.0)
    assert found.relation == ("penetrating" if ulps else "touching")
    assert found.time_of_impact is None or found.time_of_impact[1] == 1.0


def test_without_depth_none_is_measured():
    found = swept(unit_box(), Translation((9.0, 0.0, 0.0)), unit_box(3.0), depth=False)
    assert found.relation == "penetrating"
    assert found.worst is None


def test_what_fills_a_hole_is_not_passed_over():
    """Through the open top and out again; surfaces never meet."""
    ball = box((1, 1, 6), (2, 2, 7))
    there = PosePath((Waypoint(0.0, ORIGIN), Waypoint(1.0, (0.5, 0.5, -5.0))))
    found = swept(ball, there, open_box())
    assert found.relation == "separated"
    assert found.reason == "the fills of the holes of b were not swept"
    away = swept(ball, Translation((0.0, 0.0, 5.0)), open_box())
    assert away.reason is None
    assert swept(ball, there, open_box(), allow_open=True).reason is None


def test_within_walls_of_sheets_the_surfaces_say_everything():
    corners, faces = box((0, 0, 0), (9, 9, 9))
    room = corners, faces + [face[::-1] for face in faces]
    found = swept(box((1, 1, 1), (2, 2, 2)), Translation((5.0, 0.0, 0.0)), room)
    assert (found.relation, found.reason) == ("separated", None)


@pytest.mark.parametrize(
    "path",
    [
        Translation((1e30, 0.0, 0.0)),
        Translation((0.0, 1e300, 0.0)),
        Rotation((9.0, 0.0, 0.0), Z, 1e300),
        Rotation((1e40, 0.0, 0.0), Z, 90.0),
    ],
)
def test_motions_beyond_float64_are_open(path):
    found = swept(unit_box(), path, unit_box(3.0))
    assert found.relation == "indeterminate"
    assert found.reason


def test_a_spent_search_for_the_nearest_pose_is_no_clearance_that_was_not_kept(monkeypatch):
    """A gap that stays the same all the way: its lower bound gets no better than 1 %."""
    monkeypatch.setattr(worst, "INTERVALS", 1)
    square, wall = box((-1, -1, 0), (1, 1, 1)), box((1.5, -5, 0), (9, 5, 1))
    found = swept(square, Rotation(ORIGIN, Z, 90.0), wall, clearance=0.4)
    assert (found.relation, found.contact) == ("near", None)
    assert found.worst.distance[0] == 0.0


def test_a_budget_that_ends_at_a_contact_leaves_the_gap_open(monkeypatch):
    """The notch's floor is slid along; measuring the gap there is one question too many."""
    path = Translation((0.5, 0.0, 0.0))
    slid = swept(unit_box(3, 2, 1), path, bracket(), clearance=0.5)
    assert (slid.relation, slid.contact) == ("touching", 0.0)
    bisected = steps_of_bisection(unit_box(3, 2, 1), path, bracket(), clearance=0.5)
    monkeypatch.setattr(moving_pair, "STEPS", slid.steps - bisected - 1)
    found = swept(unit_box(3, 2, 1), path, bracket(), clearance=0.5)
    assert (found.relation, found.contact, found.worst) == ("touching", 0.0, None)


def test_a_million_turns_end():
    """Next to a wall that the corners pass at 0.1. While the wall stands, one plane keeps them
    apart. If the wall turns too, a step is a part of a turn, and the budget ends first."""
    square = box((-1, -1, 0), (1, 1, 1))
    wall = box((math.sqrt(2.0) + 0.1, -5, 0), (9, 5, 1))
    turns = Rotation(ORIGIN, Z, 3.6e8)
    found = swept(square, turns, wall)
    bisected = steps_of_bisection(square, turns, wall)
    assert (found.relation, found.steps) == ("separated", bisected + 1)
    assert bisected <= 2 * (INTERVALS + INTERVALS_A_PIECE)
    found = swept(square, turns, wall, Rotation((9.0, 0.0, 0.0), Z, 1e-9))
    assert (found.relation, found.steps) == ("indeterminate", bisected + STEPS + 1)
    assert found.reason.startswith("the budget of the sweep was spent")


def test_a_body_with_a_hole_is_decided_where_no_fill_can_be_met():
    """It stays in the notch, within the hull of the bracket."""
    cup = moved(open_box(1.0), 2.2, 2.2, 1.0)
    found = swept(cup, Translation((0.3, 0.3, 0.0)), bracket())
    assert (found.relation, found.reason) == ("separated", None)
    assert found.distance_at_least > 0.0


@pytest.mark.parametrize("scale", [2.0**-100, 2.0**-20, 1.0, 2.0**60])
def test_scaled_by_a_power_of_two(scale):
    """Nothing but lengths changes."""

    def scaled(mesh):
        return [tuple(c * scale for c in p) for p in mesh[0]], mesh[1]

    blade, wall = box((1, -0.25, 0), (3, 0, 1)), box((-0.5, 1, 0), (0, 3, 1))
    path = Rotation((scale / 4, 0.0, 0.0), Z, 180.0)
    found = swept(scaled(blade), path, scaled(wall), tolerance=0.0)
    reference = swept(blade, Rotation((0.25, 0.0, 0.0), Z, 180.0), wall, tolerance=0.0)
    assert found.time_of_impact == reference.time_of_impact
    assert found.worst.time == reference.worst.time
    assert [d / scale for d in found.worst.depth] == list(reference.worst.depth)
