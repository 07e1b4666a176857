"""Depth intervals that contain the known depth, and MTVs that are verified."""

from __future__ import annotations

import math

import pytest

from satcheck.audit import Settings, check
from tests.audit.shapes import bracket, open_box, scene_of, unit_box


def only(report):
    (finding,) = report.findings
    return finding


def test_peg_in_an_arm(tmp_path):
    """The peg is stuck 0.5 deep in the arm, from the end of which it is clear of the other arm."""
    report = check(scene_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0)))
    finding = only(report)
    assert finding.quality == "exact"
    assert finding.depth_bounds == pytest.approx((0.5, 0.5))
    assert finding.depth == finding.depth_bounds[1]
    assert finding.mtv_verified
    assert finding.mtv == pytest.approx((-0.5, 0.0, 0.0))


def test_seed_in_an_arm(tmp_path):
    finding = only(check(scene_of(tmp_path, a=bracket(), b=unit_box(0.75, 4, 1))))
    assert finding.relation == "contains"
    assert finding.depth_bounds == pytest.approx((1.25, 1.25))
    assert finding.mtv_verified


def test_the_depth_of_meshes_needs_no_parts(tmp_path):
    report = check(scene_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0)))
    assert "parts" not in [stage.stage for stage in only(report).plan]
    assert [body.parts for body in report.bodies] == [None, None]


def test_an_open_mesh_has_a_depth(tmp_path):
    scene = scene_of(tmp_path, a=open_box(), b=unit_box(-0.5, 1, 1))
    finding = only(check(scene))
    assert finding.relation == "penetrating"
    assert finding.mtv_verified
    assert finding.depth_bounds[0] <= 0.5 <= finding.depth_bounds[1] < 0.505
    assert finding.quality == "exact"


def test_a_surface_pushed_through_a_wall_finds_the_short_way_back(tmp_path):
    """The open box is read as a sheet: it is 4 wide, the way back through its wall is 0.5."""
    scene = scene_of(tmp_path, a=open_box(), b=unit_box(3.25, 1.5, 1.5, edge=1.25))
    finding = only(check(scene, Settings(allow_open=True)))
    assert finding.mtv_verified
    assert math.hypot(*finding.mtv) == pytest.approx(0.5, rel=0.02)


def test_the_way_out_of_a_filled_box_is_not_into_it(tmp_path):
    """The same box with its lid filled somehow: the way out leads away from the inside."""
    scene = scene_of(tmp_path, a=open_box(), b=unit_box(3.25, 1.5, 1.5, edge=1.25))
    finding = only(check(scene))
    assert finding.mtv_verified
    assert math.hypot(*finding.mtv) == pytest.approx(0.75, rel=0.02)


def test_a_failed_decomposition_is_a_warning(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0))
    report = check(scene, Settings(accuracy="parts", cache=False, part_seconds=1e-3))
    assert only(report).relation == "penetrating"
    assert any(issue.severity == "warning" and issue.body == "a" for issue in report.issues)


def test_a_spent_budget_leaves_a_proven_interval_and_says_so(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=bracket())
    finding = only(check(scene, Settings(budget=1e-6)))
    low, high = finding.depth_bounds
    assert 0 <= low <= 2 * math.sqrt(2) <= high
    assert finding.mtv_verified
    (stage,) = [stage for stage in finding.plan if stage.stage == "search"]
    assert stage.result == "budget spent"


def test_swapping_the_bodies_turns_the_way_out_round(tmp_path):
    meshes = {"a": bracket(), "b": unit_box(1.375, 3, 1, edge=2.125)}
    there = only(check(scene_of(tmp_path, **meshes)))
    back = only(check(scene_of(tmp_path, **dict(reversed(meshes.items())))))
    assert there.id == back.id
    assert there.depth_bounds == back.depth_bounds
    assert there.mtv == tuple(0.0 - c for c in back.mtv)


def test_a_narrower_interval_can_be_asked_for(tmp_path):
    points, faces = unit_box()
    dented = ([*points, (0.5, 0.5, 0.75)], faces[:1] + faces[2:])
    dented[1].extend([(4, 5, 8), (5, 7, 8), (7, 6, 8), (6, 4, 8)])
    scene = scene_of(tmp_path, a=dented, b=unit_box(0.5, 0.125, 0.125))
    for width in (0.5, 0.01, 0.001):
        low, high = only(check(scene, Settings(width=width))).depth_bounds
        assert high - low <= width * high
        assert low <= 0.5 <= high
