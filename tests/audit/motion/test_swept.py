"""Swept boxes hold the body at all times, and not much more."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from satcheck.audit.motion.swept import swept_box
from satcheck.audit.motion.track import track_of
from satcheck.audit.motion.turn import applied
from satcheck.scene.motion import PosePath, Rotation, Translation, Waypoint
from tests.oracles.random_shapes import random_quaternion

BOUNDS = ((1.0, -0.5, 0.0), (3.0, 0.5, 1.0))


def samples(path, count=2000):
    track = track_of(path)
    corners = list(itertools.product(*zip(*BOUNDS, strict=True)))
    found = []
    for k in range(count + 1):
        turn, shift = track.pose_at(k / count)
        found += [np.add(applied(turn, corner), shift) for corner in corners]
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
    low, high = swept_box(BOUNDS, track_of(path))
    points = samples(path)
    assert (points >= low).all()
    assert (points <= high).all()
    assert (np.minimum(BOUNDS[0], points.min(axis=0)) - low <= 0.5).all() or path.degrees == 1e5


def test_a_translation_is_boxed_tightly():
    low, high = swept_box(BOUNDS, track_of(Translation((3.0, -4.0, 0.0))))
    assert low == pytest.approx((1.0, -4.5, 0.0), abs=1e-12)
    assert high == pytest.approx((6.0, 0.5, 1.0), abs=1e-12)


def test_where_it_was_placed_counts_too():
    far = PosePath((Waypoint(0.0, (50.0, 0.0, 0.0)), Waypoint(1.0, (60.0, 0.0, 0.0))))
    low, high = swept_box(BOUNDS, track_of(far))
    assert low[0] <= 1.0
    assert high[0] == pytest.approx(63.0, abs=1e-11)


def test_whole_turns_are_boxed_by_their_circle():
    low, high = swept_box(BOUNDS, track_of(Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 720.0)))
    circle = math.hypot(3.0, 0.5)
    assert (
        max(abs(c) for c in (*low[:2], *high[:2])) <= circle * (1 + (math.pi / 12) ** 2 / 8) + 1e-11
    )
