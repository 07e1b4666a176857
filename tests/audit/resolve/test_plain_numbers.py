"""Short numbers where they are free, and what is free stays so."""

from __future__ import annotations

import math

from satcheck.audit import Settings
from satcheck.audit.resolve.layout import Layout
from satcheck.audit.resolve.plain_numbers import write_plainly
from tests.audit.resolve.boxes import boxes_scene, unit_at


def crowd_of(tmp_path, *offsets: tuple[float, float, float]) -> Layout:
    layout = Layout(
        boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0)}), Settings(), frozenset()
    )
    layout.move(dict(enumerate(offsets)))
    return layout


def test_noise_goes_and_zeros_stay(tmp_path) -> None:
    layout = crowd_of(tmp_path, (-0.50000000000442, 0.0, 0.0), (0.5, 0.0, 1e-20))
    write_plainly(layout, (), math.inf)
    assert layout.offsets == [(-0.5, 0, 0), (0.5, 0, 0)]


def test_what_would_overlap_is_rounded_away_from_home(tmp_path) -> None:
    third = 1 / 3
    layout = crowd_of(tmp_path, (third - 1, 0.0, 0.0), (third + 1e-15, 0.0, 0.0))
    write_plainly(layout, (), math.inf)
    (a, _, _), (b, _, _) = layout.offsets
    assert b - a >= 1
    assert len(repr(a)) <= len("-0.666666667")
    assert len(repr(b)) <= len("0.333333334")


def test_no_body_is_moved_farther_than_allowed(tmp_path) -> None:
    layout = crowd_of(tmp_path, (-1 / 3, 0.0, 0.0), (2 / 3 + 1e-15, 0.0, 0.0))
    write_plainly(layout, (), 2 / 3 + 1e-15)
    assert all(math.hypot(*offset) <= 2 / 3 + 1e-15 for offset in layout.offsets)
