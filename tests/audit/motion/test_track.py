"""Tracks: where a motion takes a body, how fast, and how well that is known."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from satcheck.audit.motion.track import between, track_of, unit
from satcheck.core.transform import about, compose, cos_sin, placed, quaternion_matrix
from satcheck.scene.motion import PosePath, Rotation, Translation, Waypoint
from tests.audit.motion.pairs import boxes_on

UNIT = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
# Roundings of a turn of a vector of length 1: sine, cosine, axis and nine products.
ERROR = 32 * 2.0**-53
QUARTER = (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
SCREW = PosePath(
    (
        Waypoint(0.0, (1.0, 0.0, 0.0)),
        Waypoint(0.25, (1.0, 0.0, 2.0), QUARTER),
        Waypoint(1.0, (4.0, 0.0, 2.0), QUARTER),
    )
)


def at(path, t, point):
    pose = track_of(path).pose_at(t)
    return compose(pose, placed(IDENTITY[:3] + IDENTITY[4:7] + IDENTITY[8:11], point))[3:12:4]


def test_a_translation() -> None:
    assert at(Translation((2.0, 0.0, -4.0)), 0.25, (1.0, 1.0, 1.0)) == (1.5, 1.0, 0.0)


@pytest.mark.parametrize("turns", [1, -3, 1000])
def test_whole_turns_return(turns: int) -> None:
    track = track_of(Rotation((3.0, 0.1, 7.0), (1.0, 2.0, 2.0), 360.0 * turns))
    assert track.pose_at(0.0) == track.pose_at(1.0) == IDENTITY


def test_a_quarter_about_a_line() -> None:
    path = Rotation((1.0, 0.0, 0.0), (0.0, 0.0, 5.0), 180.0)
    assert at(path, 0.5, (3.0, 0.0, 4.0)) == (1.0, 2.0, 4.0)


def test_a_path_of_poses() -> None:
    track = track_of(SCREW)
    assert track.times == [0.0, 0.25, 1.0]
    assert at(SCREW, 0.0, (1.0, 0.0, 0.0)) == (2.0, 0.0, 0.0)
    half = math.sqrt(0.5)
    assert at(SCREW, 0.125, (1.0, 0.0, 0.0)) == pytest.approx((1.0 + half, half, 1.0), abs=1e-15)
    assert at(SCREW, 1.0, (1.0, 0.0, 0.0)) == pytest.approx((4.0, 1.0, 2.0), abs=1e-15)


def test_the_pad_holds_what_rounding_does() -> None:
    """A turn by a rational angle, in rationals: 3-4-5 is no binary angle, so a thousand turns more
    round it as they may."""
    angle = math.degrees(math.atan2(4.0, 3.0))
    exact = [Fraction(3, 5), Fraction(4, 5), Fraction(0)]
    for turns in (0, 1, 1000):
        path = Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), angle + 360.0 * turns)
        point = at(path, 1.0, (1.0, 0.0, 0.0))
        off = max(abs(Fraction(c) - e) for c, e in zip(point, exact, strict=True))
        # The angle that was asked for is itself rounded: by half a unit in the last place.
        asked = math.radians(math.ulp(path.degrees))
        assert off <= boxes_on((UNIT, path), (UNIT, None)).pad(0) + asked


@pytest.mark.parametrize(
    "path", [Translation((3.0, 4.0, 0.0)), Rotation((9.0, 0.0, 0.0), (0.0, 1.0, 1.0), 700.0), SCREW]
)
def test_no_point_is_faster_than_the_bound(path) -> None:
    travel = boxes_on((UNIT, path), (UNIT, None))
    pad = travel.pad(0)
    for k in range(64):
        start, end = k / 64, (k + 1) / 64
        for corner in ((0.0, 0.0, 0.0), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0)):
            step = math.dist(at(path, start, corner), at(path, end, corner))
            assert step <= travel.in_piece((0, [0]), start, end)[0] / 64 + 2 * pad


def test_between_takes_the_shortest_arc() -> None:
    """From 10 to 350 degrees about z: back by 20, also where the quaternions differ in sign."""

    def about_z(degrees: float, sign: float = 1.0) -> tuple[float, float, float, float]:
        half = math.radians(degrees) / 2
        return 0.0, 0.0, sign * math.sin(half), sign * math.cos(half)

    for sign in (1.0, -1.0):
        axis, degrees = between(about_z(10.0), about_z(350.0, sign))
        assert degrees == pytest.approx(20.0, rel=64 * ERROR)
        assert axis == (0.0, 0.0, -1.0)


def test_the_turn_between_leads_from_one_to_the_other() -> None:
    start, end = (0.1, -0.7, 0.3, 0.5), (-0.4, 0.2, 0.9, 0.1)
    axis, degrees = between(start, end)
    here, turn = quaternion_matrix(*start), about(axis, cos_sin(degrees))
    there = compose(placed(turn, UNIT[0]), placed(here, UNIT[0]))
    for entry, expected in zip(there, placed(quaternion_matrix(*end), UNIT[0]), strict=True):
        assert entry == pytest.approx(expected, abs=8 * ERROR)


@pytest.mark.parametrize("turns", [-1000, -2, -1, 0, 1, 3, 10**12])
def test_whole_turns_return_exactly(turns: int) -> None:
    assert about(unit((1.0, 2.0, 3.0)), cos_sin(360.0 * turns)) == about(
        (0.0, 0.0, 1.0), (1.0, 0.0)
    )
