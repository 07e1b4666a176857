"""Swept boxes hold the body at all times, and not much more."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck.audit.body import corners
from satcheck.audit.motion.track import track_of
from satcheck.scene.motion import PosePath, Rotation, Translation, Waypoint
from tests.audit.motion.pairs import boxes_on
from tests.oracles.random_shapes import random_quaternion

ORIGIN = (0.0, 0.0, 0.0)
BOUNDS = ((1.0, -0.5, 0.0), (3.0, 0.5, 1.0))


def meet(a, b, limit):
    travel = boxes_on(a, b)
    assert travel.may_meet("0", "1", limit) == travel.may_meet("1", "0", limit)
    return travel.may_meet("0", "1", limit)


def samples(path, start=0.0, end=1.0, count=2000):
    track = track_of(path)
    found = []
    for k in range(count + 1):
        pose = np.reshape(track.pose_at(start + (end - start) * k / count), (4, 4))
        found += [pose[:3, :3] @ corner + pose[:3, 3] for corner in corners(BOUNDS)]
    return np.array(found)


def path_of(rng):
    times = (0.0, 0.1, 0.75, 1.0)
    return PosePath(
        tuple(
            Waypoint(t, tuple(rng.normal(size=3) * 3), tuple(random_quaternion(rng))) for t in times
        )
    )


@pytest.mark.parametrize(
    "path",
    [
        Translation((3.0, -4.0, 0.0)),
        Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 33.0),
        Rotation((5.0, 1.0, 0.0), (1.0, 2.0, -1.0), -200.0),
        Rotation((5.0, 1.0, 0.0), (1.0, 2.0, -1.0), 1e5),
        *(path_of(np.random.default_rng(seed)) for seed in range(5)),
    ],
)
def test_the_body_is_always_inside(path):
    low, high = boxes_on((BOUNDS, path)).bounds("0")
    points = samples(path)
    assert (points >= low).all()
    assert (points <= high).all()
    assert (np.minimum(BOUNDS[0], points.min(axis=0)) - low <= 0.5).all() or path.degrees == 1e5


def test_a_motion_beyond_float64_may_meet_everything():
    """The velocity of the first leg is infinite, so that its centre is not a number."""
    back = (Waypoint(5e-324, (5.0, 0.0, 0.0)), Waypoint(1.0, ORIGIN))
    path = PosePath((Waypoint(0.0, ORIGIN), *back))
    assert boxes_on((BOUNDS, path)).bounds("0") == ((-math.inf,) * 3, (math.inf,) * 3)
    assert meet((BOUNDS, path), (((4.0, 0.0, 0.0), (4.5, 1.0, 1.0)), None), 0.0)


def test_a_translation_is_boxed_tightly():
    low, high = boxes_on((BOUNDS, Translation((3.0, -4.0, 0.0)))).bounds("0")
    assert low == pytest.approx((1.0, -4.5, 0.0), abs=1e-12)
    assert high == pytest.approx((6.0, 0.5, 1.0), abs=1e-12)


def test_where_it_was_placed_counts_too():
    far = PosePath((Waypoint(0.0, (50.0, 0.0, 0.0)), Waypoint(1.0, (60.0, 0.0, 0.0))))
    low, high = boxes_on((BOUNDS, far)).bounds("0")
    assert low == pytest.approx(BOUNDS[0], abs=1e-11)
    assert high == pytest.approx((63.0, *BOUNDS[1][1:]), abs=1e-11)
    near_the_place = ((0.0, 0.0, 0.0), (2.0, 1.0, 1.0))
    assert meet((BOUNDS, far), (near_the_place, None), 0.0)


@pytest.mark.parametrize("seed", range(5))
def test_over_a_part_the_body_is_inside(seed):
    rng = np.random.default_rng(seed)
    path = path_of(rng)
    travel = boxes_on((BOUNDS, path))
    boxes, times = travel.swept(0), travel.part_times
    for k in map(int, rng.integers(len(times) - 1, size=8)):
        points = samples(path, times[k], times[k + 1], count=100)
        assert (points >= boxes.low[k]).all()
        assert (points <= boxes.high[k]).all()


def test_bodies_that_pass_the_same_place_at_other_times_do_not_meet():
    """Both cross the origin."""
    corner = ((-20.5, -20.5, 0.0), (-19.5, -19.5, 1.0))
    a = (corner, Translation((40.0, 40.0, 0.0)))
    other = ((-20.5, 19.5, 0.0), (-19.5, 20.5, 1.0))
    there = Waypoint(1.0, (40.0, -40.0, 0.0))
    at_once = PosePath((Waypoint(0.0, ORIGIN), there))
    later = PosePath((Waypoint(0.0, ORIGIN), Waypoint(0.9, ORIGIN), there))
    assert meet(a, (other, at_once), 0.0)
    assert not meet(a, (other, later), 0.0)


def test_beside_the_path_boxes_are_apart():
    """The corners that are nearest pass each other at sqrt 2, along the diagonal."""
    corner = ((-20.5, -20.5, 0.0), (-19.5, -19.5, 1.0))
    a = (corner, Translation((40.0, 40.0, 0.0)))
    aside = (((5.0, 9.0, 0.0), (6.0, 10.0, 1.0)), None)
    assert not meet(a, aside, 1.0)
    assert meet(a, aside, 1.5)


def test_whole_turns_are_boxed_by_their_circle():
    turn = Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 720.0)
    low, high = boxes_on((BOUNDS, turn)).bounds("0")
    circle = math.hypot(3.0, 0.5)
    assert (
        max(abs(c) for c in (*low[:2], *high[:2])) <= circle * (1 + (math.pi / 12) ** 2 / 8) + 1e-11
    )
