"""The printed MTV frees A: applied here once more, and checked on the hulls."""

from __future__ import annotations

import math

import pytest

from satcheck import core
from satcheck.audit import Settings, check
from satcheck.audit.stages.depth import rounds_once
from tests.audit.shapes import bracket, placed_scene, pose, scene_of, unit_box, write
from tests.core.voxel_solids import VoxelSolid


def only(report):
    (finding,) = report.findings
    return finding


def test_boxes_that_overlap_by_one_move_by_exactly_one(tmp_path):
    finding = only(check(scene_of(tmp_path, a=unit_box(edge=2.0), b=unit_box(1, 0.25, 0.5, 2.0))))
    assert finding.mtv == (-1.0, 0.0, 0.0)
    assert finding.depth == 1.0
    assert finding.mtv_verified
    assert finding.normal == (1.0, 0.0, 0.0)
    low, high = finding.depth_bounds
    assert low <= 1.0 <= high


def moved_hull(body, offset=(0.0, 0.0, 0.0)):
    mesh = body.world_mesh()
    points = mesh.vertices + offset
    return core.Hull(points)


@pytest.mark.parametrize("turn", [0.1, 10, 30, 45, 77, 90])
@pytest.mark.parametrize("x", [0.1, 0.7, 1.0])
def test_turned_boxes_are_free_after_the_move(tmp_path, turn, x):
    write(tmp_path, box=unit_box())
    bodies = [("a", "box.obj", pose()), ("b", "box.obj", pose(x, 0.3, 0.2, turn))]
    scene = placed_scene(tmp_path, bodies)
    finding = only(check(scene, Settings(depth=True)))
    if finding.relation != "penetrating":
        pytest.skip("this pose does not overlap")
    assert finding.mtv_verified
    hull_a, hull_b = moved_hull(scene.bodies[0], finding.mtv), moved_hull(scene.bodies[1])
    assert core.check_pair(hull_a, hull_b, query="overlap").outcome in ("separated", "touching")
    assert math.hypot(*finding.mtv) == pytest.approx(finding.depth, rel=1e-12)


def test_a_peg_moves_into_the_hole_in_which_it_just_fits(tmp_path):
    """A is the first cell of a block whose only hole is one cell wide, two cells away along x and
    one along y. No longer translation along that way is free."""
    side = range(-5, 6)
    block = {(x, y, z) for x in side for y in side for z in side if (x, y) != (2, 1)}
    solid = VoxelSolid(frozenset(block)).mesh()
    scene = scene_of(tmp_path, a=unit_box(), b=(solid.vertices.tolist(), solid.triangles.tolist()))
    finding = only(check(scene, Settings(depth=True)))
    assert finding.mtv[:2] == pytest.approx((2.0, 1.0), rel=1e-14)
    assert math.hypot(*finding.mtv) < 2.24
    assert finding.mtv_verified


def test_a_capped_ladder_verifies_what_it_may(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0))
    assert only(check(scene, Settings(depth=True, accuracy="hull"))).mtv_verified
    assert only(check(scene, Settings(depth=True, accuracy="aabb"))).mtv_verified is False


@pytest.mark.parametrize(
    ("transform", "once"),
    [
        (None, True),
        ((0, -1, 0, 0.1, 2, 0, 0, 0.2, 0, 0, 0.5, 0.3, 0, 0, 0, 1), True),
        ((3, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1), False),
        ((1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1), False),
    ],
)
def test_only_poses_that_round_once_get_the_nominal_length(transform, once):
    assert rounds_once(transform) is once


def test_a_turned_neighbour_gets_a_few_ulps_more(tmp_path):
    # The move is along an axis, but the neighbour's corners depend on the order of its pose's sums.
    write(tmp_path, box=unit_box())
    bodies = [("a", "box.obj", pose()), ("b", "box.obj", pose(0.0, 0.0, 0.75, 30))]
    finding = only(check(placed_scene(tmp_path, bodies), Settings(depth=True)))
    assert finding.relation == "penetrating"
    assert 0.25 < math.hypot(*finding.mtv) < 0.25 * (1 + 1e-13)
    assert [stage.result for stage in finding.plan if stage.stage == "verify"] == ["separated"]


def test_a_fit_between_cells_is_left_by_a_way_that_rounds_nothing(tmp_path):
    """The shortest way, one cell along an axis, leads into a fit. The search finds it but for
    rounding, and no longer one along it is free."""
    a = [(-5, -6, -2), (-5, -4, -5), (-5, -4, -3), (-5, -4, -2), (-4, -6, -2), (-4, -4, -5)]
    a += [(-4, -4, -2), (-4, -2, -5), (-4, -2, -4), (-4, -2, -3), (-4, -2, -2), (-2, -2, -5)]
    solids = [VoxelSolid(frozenset(cells)).mesh() for cells in (a, [(-4, -6, -1), (-4, -2, -5)])]
    meshes = [(solid.vertices.tolist(), solid.triangles.tolist()) for solid in solids]
    finding = only(check(scene_of(tmp_path, a=meshes[0], b=meshes[1]), Settings(depth=True)))
    assert finding.depth_bounds[0] <= 1.0 <= finding.depth_bounds[1]
    assert finding.mtv_verified
    assert sorted(map(abs, finding.mtv)) == [0.0, 0.0, 1.0]
