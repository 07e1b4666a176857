"""The kettle and the snowflake: no pair of convex parts tells the way out of a concave pair."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sample_meshes.kitchen import kettle_parts, snowflake_parts
from satcheck import core
from satcheck.audit import check
from satcheck.report.judge import EXACT_WIDTH
from tests.oracles.free_directions import along, directions, is_free, sampled_depth

SAMPLES = Path(__file__).parents[2] / "sample_meshes"
KETTLE, SNOWFLAKE = SAMPLES / "kettle.obj", SAMPLES / "snowflake.obj"


def meshes():
    from satcheck.scene import load_scene

    return [body.file.mesh for body in load_scene([KETTLE, SNOWFLAKE]).bodies]


def deepest_part_pair():
    parts = [
        [core.Hull(np.array(corners)) for corners in of]
        for of in (kettle_parts(), snowflake_parts())
    ]
    found = (core.check_pair(a, b, query="depth") for a in parts[0] for b in parts[1])
    return min((pair for pair in found if pair.outcome == "penetrating"), key=lambda p: p.distance)


def test_the_deepest_parts_do_not_tell_the_way_out_and_the_hulls_exaggerate():
    a, b = meshes()
    surface = core.Surface(b, True)
    (finding,) = check([KETTLE, SNOWFLAKE]).findings
    low, high = finding.depth_bounds
    deepest = deepest_part_pair()
    hulls = core.check_pair(core.Hull(a.convex_hull()), core.Hull(b.convex_hull()), query="depth")
    assert -deepest.distance < 0.5 * low
    assert high < 0.6 * -hulls.distance
    assert not is_free(a, surface, along(deepest.normal, deepest.distance))
    assert finding.mtv_verified
    assert is_free(a, surface, finding.mtv)
    assert math.hypot(*finding.mtv) <= high * (1 + EXACT_WIDTH)
    assert high - low <= 0.01 * high


def test_no_sampled_translation_contradicts_the_interval():
    a, b = meshes()
    surface = core.Surface(b, True)
    (finding,) = check([KETTLE, SNOWFLAKE]).findings
    low, high = finding.depth_bounds
    for way in directions(300):
        for share in (0.25, 0.6, 0.99):
            assert not is_free(a, surface, along(way, share * low))
    back = tuple(c / math.hypot(*finding.mtv) for c in finding.mtv)
    assert not is_free(a, surface, along(back, 0.99 * low))
    assert sampled_depth(a, surface, 1.01 * high, 40) >= low
