"""Each rung that ran has its words, in the order of the ladder, and no other."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np

from satcheck import core
from satcheck.audit.stages.relation import rungs_of

CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
FACES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
        *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ],
    np.uint32,
)
CUBE = core.Geometry(core.Mesh(CORNERS, FACES), True)
Matrix = tuple[float, ...]


def turned(axis: int, degrees: float, move: tuple[float, float, float]) -> Matrix:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    m = np.eye(4)
    m[i, i], m[i, j], m[j, i], m[j, j] = c, -s, s, c
    m[:3, 3] = move
    return tuple(m.ravel().tolist())


def words(a: Matrix | None, b: Matrix) -> list[tuple[str, str, str]]:
    bodies = [core.PlacedGeometry(CUBE, m, None, 0.0) for m in (a, b)]
    climb = core.climb((bodies[0], bodies[1], 0.0, 0.0, 0.0, 0.0, False))
    return [(s.stage, s.result, s.detail) for s in rungs_of(climb)]


def told(**known: Any) -> list[tuple[str, str, str]]:
    nothing = dict.fromkeys(("hulls", "nesting", "triangles"))
    base = {"boxes": "", "box_gap": 0.0, "both_convex": False, "nanoseconds": [0] * 6}
    climb: Any = SimpleNamespace(**{**nothing, **base, **known})
    return [(s.stage, s.result, s.detail) for s in rungs_of(climb)]


def test_turned_boxes_name_the_axis_that_separates() -> None:
    stages = words(None, turned(2, 45, (1.1, 1.1, 0)))
    assert stages[0] == ("aabb", "meet", "world boxes meet")
    axis = "sat: face normal x of B separates, 6 of 15 axes tested"
    assert stages[1:] == [("obb", "separated", axis)]
    tilt = np.reshape(turned(0, 30, (0, 0, 0)), (4, 4))
    ridges = (turned(0, 45, (0, 0, 0)), turned(1, 45, (0, 0, 1.4143)))
    tilted = [tuple((tilt @ np.reshape(m, (4, 4))).ravel().tolist()) for m in ridges]
    crossed = words(tilted[0], tilted[1])
    axis = "sat: edge x of A across edge y of B separates, 15 of 15 axes tested"
    assert crossed[-1] == ("obb", "separated", axis)


def test_boxes_that_overlap_or_touch_name_15_axes() -> None:
    overlap, touch = words(None, turned(2, 20, (0.9, 0, 0))), words(None, turned(0, 0, (1, 0.5, 0)))
    assert overlap[1] == ("obb", "meet", "sat: none of 15 axes separates")
    least = "both convex: sat, 15 axes, least along a face normal of A"
    assert overlap[-1] == ("hull", "penetrating", least)
    assert touch[-1] == ("hull", "touching", least + ": exact signs")
    assert touch[1][1] == "skipped"


def test_hulls_and_triangles() -> None:
    hulls = SimpleNamespace(outcome="separated", method="gjk", feature="vertices", lower=2.5)
    known = {"hulls": hulls, "boxes": "sheared", "box_gap": 3.0}
    assert told(**known)[2] == ("hull", "separated", "hulls apart by at least 3")
    assert told(**known, both_convex=True)[2][2] == "both convex: gjk vertices"
    assert told(**known, nesting="contains")[3][:2] == ("containment", "contains")
    hulls.outcome = "penetrating"
    found = SimpleNamespace(relation="penetrating", box_tests=7, triangle_tests=2, edge_tests=None)
    found.triangle_a, found.triangle_b, found.proven, found.decided = 3, 4, False, True
    from_hulls = told(hulls=hulls, triangles=found)
    assert from_hulls[0][:2] == ("hull", "meet")
    meet = "7 box tests, 2 triangle tests, triangles 3 and 4 meet, sampled in a degenerate contact"
    assert from_hulls[1] == ("triangles", "penetrating", meet)
    found.edge_tests, found.triangle_a, found.proven = 9, -1, True
    assert told(triangles=found)[0][2] == "9 tests of edges of the outlines"
    found.decided = False
    assert told(triangles=found) == [("triangles", "undecided", "too many steps")]
    assert told(box_gap=0.1234567) == [
        ("aabb", "separated", "world boxes apart by at least 0.123457")
    ]
