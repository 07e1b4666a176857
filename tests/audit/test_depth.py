"""Depth intervals that contain the known depth, and MTVs that are verified."""

from __future__ import annotations

import pytest

from satcheck.audit import Settings, check
from tests.audit.shapes import bracket, open_box, scene_of, unit_box

UNCACHED = Settings(cache=False)


def only(report):
    (finding,) = report.findings
    return finding


def test_peg_in_an_arm(tmp_path):
    report = check(scene_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0)), UNCACHED)
    finding = only(report)
    low, high = finding.depth_bounds
    assert 0 < low <= 0.5 <= high < 0.51
    assert finding.depth == high
    assert finding.mtv_verified
    assert finding.mtv[0] == pytest.approx(-0.5, abs=0.01)
    assert {body.id: body.parts is not None for body in report.bodies} == {"a": True, "b": False}


def test_seed_in_an_arm(tmp_path):
    finding = only(check(scene_of(tmp_path, a=bracket(), b=unit_box(0.75, 4, 1)), UNCACHED))
    assert finding.relation == "contains"
    low, high = finding.depth_bounds
    assert 0 < low <= 1.25 <= high < 1.3
    assert finding.mtv_verified


def test_nearly_convex_bodies_are_not_decomposed(tmp_path):
    points, faces = unit_box()
    dented = ([*points, (0.5, 0.5, 0.999)], faces[:1] + faces[2:])
    dented[1].extend([(4, 5, 8), (5, 7, 8), (7, 6, 8), (6, 4, 8)])
    report = check(scene_of(tmp_path, a=dented, b=unit_box(0.5, 0.1, 0.1)), UNCACHED)
    finding = only(report)
    low, high = finding.depth_bounds
    assert 0.495 < low <= 0.5 <= high < 0.505
    assert finding.quality == "bounded"
    assert "parts" not in [stage.stage for stage in finding.plan]
    assert report.bodies[0].parts is None


def test_an_open_mesh_has_no_lower_bound_but_a_way_out(tmp_path):
    scene = scene_of(tmp_path, a=open_box(), b=unit_box(-0.5, 1, 1))
    finding = only(check(scene, UNCACHED))
    assert finding.relation == "penetrating"
    assert finding.mtv_verified
    assert finding.depth_bounds[0] <= 0.5 <= finding.depth_bounds[1]
    assert "no solid" in finding.reason


def test_a_box_in_an_open_box_is_separated(tmp_path):
    finding = only(check(scene_of(tmp_path, a=open_box(), b=unit_box(1, 1, 1))))
    assert (finding.relation, finding.quality) == ("separated", "exact")


def test_a_failed_decomposition_is_a_warning(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0))
    report = check(scene, Settings(cache=False, part_seconds=1e-3))
    finding = only(report)
    low, high = finding.depth_bounds
    assert low <= 0.5 <= high
    assert finding.mtv_verified
    assert any(issue.severity == "warning" and issue.body == "a" for issue in report.issues)


def test_swapping_the_bodies_turns_the_way_out_round(tmp_path):
    meshes = {"a": bracket(), "b": unit_box(1.5, 3, 1, edge=2.0)}
    there = only(check(scene_of(tmp_path, **meshes), Settings(depth_width=0.9)))
    back = only(
        check(scene_of(tmp_path, **dict(reversed(meshes.items()))), Settings(depth_width=0.9))
    )
    assert there.id == back.id
    assert there.depth == pytest.approx(back.depth)
    assert there.mtv == pytest.approx(tuple(-c for c in back.mtv))


def test_a_nested_body_is_as_deep_as_its_gap_at_least(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(0.75, 4, 1))
    finding = only(check(scene, Settings(cache=False, part_seconds=1e-3)))
    assert 0.25 - 1e-9 <= finding.depth_bounds[0] <= 1.25
