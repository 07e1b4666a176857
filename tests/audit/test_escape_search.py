"""The search on the meshes: its directions, its budget, and ways out that are known."""

from __future__ import annotations

import math

import pytest

from satcheck.audit import Settings, check
from satcheck.audit.escape_search import TILT_SIDES, _directions, _tilted
from satcheck.audit.pair import Pair
from satcheck.audit.placed_body import PlacedBody, SharedMesh
from satcheck.audit.trials import MOST_TRIALS, Trials
from tests.audit.shapes import bracket, open_box, scene_of, unit_box


def pair_of(tmp_path, **meshes):
    settings = Settings()
    a, b = (
        PlacedBody(body, SharedMesh(body.file, settings))
        for body in scene_of(tmp_path, **meshes).bodies
    )
    return Pair(a, b, settings)


@pytest.mark.parametrize("more", [0, 40])
def test_directions_are_unit_and_differ(more):
    found = _directions(more)
    assert len(set(found)) == 26 + more
    assert all(math.hypot(*way) == pytest.approx(1.0) for way in found)


def test_tilted_directions_keep_their_angle():
    way = (0.6, 0.0, 0.8)
    found = _tilted(way, 0.1)
    assert len(found) == TILT_SIDES
    for other in found:
        cosine = sum(p * q for p, q in zip(way, other, strict=True))
        assert cosine == pytest.approx(math.cos(0.1))


def test_trials_are_counted_and_end(tmp_path):
    trials = Trials(pair_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0)))
    assert trials.left == MOST_TRIALS
    assert not trials.frees((0.0, 0.0, 0.0))
    assert trials.frees((-0.5, 0.0, 0.0))
    assert trials.made == 2
    trials.left = 0
    assert not trials.frees((-0.5, 0.0, 0.0))
    assert trials.made == 2


def test_a_remembered_crossing_costs_no_trial(tmp_path):
    trials = Trials(pair_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0)))
    assert not trials.frees((0.0, 0.0, 0.0))
    assert not trials.frees((-0.01, 0.0, 0.0))
    assert trials.made == 1


def test_a_surface_pushed_through_a_wall_finds_the_short_way_back(tmp_path):
    """Open meshes have no parts and no hull that helps: the box is 4 wide, the way back is 0.5."""
    scene = scene_of(tmp_path, a=open_box(), b=unit_box(3.25, 1.5, 1.5, edge=1.25))
    (finding,) = check(scene).findings
    assert finding.mtv_verified
    assert math.hypot(*finding.mtv) == pytest.approx(0.5, rel=0.02)
