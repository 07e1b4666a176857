"""Motions are refused where they are none."""

from __future__ import annotations

import math

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import Scene
from satcheck.scene.motion import Motion, PosePath, Rotation, Translation, Waypoint

ALONG_X = Translation((1.0, 0.0, 0.0))
START, END = Waypoint(0.0, (0.0, 0.0, 0.0)), Waypoint(1.0, (1.0, 0.0, 0.0))


def test_degenerate_motions_are_motions() -> None:
    assert Translation((0.0, 0.0, 0.0)).vector == (0.0, 0.0, 0.0)
    assert Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 3.0), -7200.0).degrees == -7200.0
    assert PosePath((START, END)).waypoints[0].orientation == (0.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Translation((0.0, math.nan, 0.0)), "vector of a translation"),
        (lambda: Translation((0.0, 0.0)), "3 finite numbers"),  # type: ignore[arg-type]
        (lambda: Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0), "must not be zero"),
        (lambda: Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.inf), "degrees"),
        (lambda: Waypoint(0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)), "must not be zero"),
        (lambda: Waypoint(0.0, (0.0, 0.0, math.inf)), "position of a waypoint"),
        (lambda: PosePath((START,)), "start at time 0"),
        (lambda: PosePath((START, Waypoint(0.5, (0.0, 0.0, 0.0)))), "end at time 1"),
        (lambda: PosePath((START, START, END)), "must increase"),
        (lambda: Motion((), ALONG_X), "must name a body"),
        (lambda: Motion(("a", "a"), ALONG_X), "one motion only"),
        (
            lambda: Scene(
                "s", None, (), motions=(Motion(("a",), ALONG_X), Motion(("a",), ALONG_X))
            ),
            "one motion only",
        ),
    ],
)
def test_what_is_no_motion_is_refused(make: object, words: str) -> None:
    assert callable(make)
    with pytest.raises(SatcheckError, match=words) as caught:
        make()
    assert caught.value.code == "bad-motion"
