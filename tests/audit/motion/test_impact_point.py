"""The point of an impact: in both bodies where they then are, and at the impact, not at a contact
before it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from satcheck.audit import Settings, check
from satcheck.scene.motion import Rotation, Translation
from tests.audit.motion.pairs import pair_of, sweep
from tests.audit.motion.slots import channel
from tests.audit.shapes import box, bracket, moved, open_box, unit_box, write

Z = (0.0, 0.0, 1.0)


def hit_of(a, path, b, **settings):
    found = sweep(pair_of(a, b, depth=False, **settings), path, None)
    assert found.relation == "penetrating"
    return found


@pytest.mark.parametrize("tolerance", [0.0, 1e-6])
def test_a_box_meets_a_box(tolerance):
    path = Translation((4.0, 2.0, 0.0))
    found = hit_of(unit_box(), path, box((3, 1.5, 0.25), (4, 9, 0.5)), tolerance=tolerance)
    x, y, z = found.point
    t = found.time_of_impact[1]
    assert 3.0 <= x <= 1.0 + 4.0 * t
    assert 1.5 <= y <= 1.0 + 2.0 * t
    assert 0.25 <= z <= 0.5


def test_in_a_slot_it_is_the_obstacle_and_not_the_floor():
    """A block on the wall of the slot that the slider fits, 0.75 ahead of it."""
    points, faces = channel()
    corners, sides = box((1.5, 3.75, 0.5), (1.75, 3.8, 0.75))
    obstructed = points + corners, faces + [tuple(k + len(points) for k in side) for side in sides]
    found = hit_of(box((1, 1, 0), (2, 3, 1)), Translation((0.0, 1.5, 0.0)), obstructed)
    x, y, z = found.point
    assert 1.5 <= x <= 1.75
    assert 3.75 <= y <= 3.0 + 1.5 * found.time_of_impact[1]
    assert 0.5 <= z <= 0.75


def test_a_blade_turns_against_a_wall():
    wall = box((-0.5, 1, 0), (0, 3, 1))
    found = hit_of(box((1, -0.2, 0), (3, 0, 1)), Rotation((0.0, 0.0, 0.0), Z, 180.0), wall)
    angle = math.radians(180.0 * found.time_of_impact[1])
    x, y, _ = found.point
    assert -0.5 <= x <= 0.0
    along = x * math.cos(angle) + y * math.sin(angle)
    across = y * math.cos(angle) - x * math.sin(angle)
    assert 1.0 <= along <= 3.0
    assert -1e-15 <= -across <= 0.2


def test_bodies_that_overlap_from_the_start():
    found = hit_of(moved(bracket(), 1, 1, 1), Translation((1.0, 0.0, 0.0)), bracket())
    assert all(1.0 <= c <= 6.0 for c in found.point)


def test_a_corner_through_a_sheet():
    """A box without its lid has no inside; its floor is met by a corner."""
    tip = [(1.0, 1.0, -1.0), (0.0, 1.0, -3.0), (1.0, 0.0, -3.0), (2.0, 2.0, -3.0)]
    spike = tip, [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)]
    found = hit_of(spike, Translation((0.0, 0.0, 4.0)), open_box(), allow_open=True)
    x, y, z = found.point
    sunk = 4.0 * found.time_of_impact[1] - 1.0
    assert z == 0.0
    assert math.dist((x, y), (1.0, 1.0)) <= sunk


def test_a_box_within_an_open_one():
    """The surfaces do not meet, and no fill of the hole at the far corner reaches the small box."""
    corners, sides = box((0, 0, 0), (8, 8, 8))
    cup = corners, [*sides[:-1], sides[-1][:3]]
    found = hit_of(box((2, 5, 2), (3, 6, 3)), Translation((1.0, 0.0, 0.0)), cup)
    assert found.time_of_impact == (0.0, 0.0)
    for c, low in zip(found.point, (2.0, 5.0, 2.0), strict=True):
        assert low <= c <= low + 1.0


@pytest.mark.parametrize("other", ["box", "bracket"])
def test_a_ball(tmp_path: Path, other: str) -> None:
    """At most as far from both as they have moved since the interval began, and the tolerance."""
    write(tmp_path, box=box((0, 0, 0), (6, 6, 4)), bracket=bracket())
    (tmp_path / "scene.toml").write_text(
        'schema = "satcheck.scene/1"\nbodies = [\n'
        '{id = "a", shape = {type = "sphere", radius = 1}, position = [9, 1, 2]},\n'
        f'{{id = "b", mesh = "{other}.obj"}}]\n'
        '[[motion]]\nbodies = "a"\ntranslation = [-8, 0, 0]\n',
        encoding="utf-8",
    )
    (finding,) = check([tmp_path / "scene.toml"], Settings(depth=False)).findings
    found = finding.motion
    assert found is not None
    assert found.time_of_impact is not None
    assert found.point is not None
    low, high = found.time_of_impact
    off = found.tolerance + 8.0 * (high - low)
    assert 6.0 - off <= found.point[0] <= 6.0 + off
    assert math.dist(found.point, (9.0 - 8.0 * high, 1.0, 2.0)) <= 1.0 + off


def test_no_point_of_what_is_not_proven():
    found = sweep(pair_of(unit_box(), unit_box(3.0), accuracy="aabb"), Translation((9, 0, 0)), None)
    assert not found.proven
    assert found.point is None
