"""The ladder of the core: the same answers as its rungs give one by one, and what it leaves out."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from satcheck import core

CUBE = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4)] + [
    (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)
]  # fmt: skip


def box_mesh(low, high):
    points = [
        (x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])
    ]
    return points, CUBE


def mesh_of(*parts):
    points, triangles = [], []
    for part_points, part_triangles in parts:
        triangles += [tuple(i + len(points) for i in t) for t in part_triangles]
        points += part_points
    return core.Mesh(np.array(points, dtype=float), np.array(triangles, dtype=np.int32))


def two_boxes():
    """In one mesh, so that it is not convex."""
    return mesh_of(box_mesh((-1, -1, -1), (1, 0, 1)), box_mesh((-1, 2, -1), (1, 3, 1)))


def turned(rng):
    angle = rng.uniform(-3, 3)
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = (rng.uniform(-2, 2) for _ in range(3))
    return (c, -s, 0.0, x, s, c, 0.0, y, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0)


def crowd(count, seed=3):
    rng = random.Random(seed)
    shared = [
        core.Geometry(two_boxes(), True),
        core.Geometry(mesh_of(box_mesh((-1, -1, -1), (1, 1, 1))), True),
    ]
    bodies = []
    for k in range(count):
        matrix = turned(rng)
        mesh = (two_boxes, lambda: mesh_of(box_mesh((-1, -1, -1), (1, 1, 1))))[k % 2]()
        bounds = mesh.transformed(matrix).bounds
        bodies.append(core.PlacedGeometry(shared[k % 2], matrix, bounds, 1e-12))
    return bodies


def questions(bodies, tolerance=1e-9):
    return [
        (a, b, tolerance, tolerance, False) for k, a in enumerate(bodies) for b in bodies[k + 1 :]
    ]


def test_rungs_say_what_they_say_alone():
    pairs = questions(crowd(24))
    seen = {"hulls": 0, "triangles": 0, "boxes": 0}
    for (a, b, *_), found in zip(pairs, core.climb_all(pairs), strict=True):
        relation = core.mesh_relation(a.surface(), b.surface())
        if found.triangles is not None:
            seen["triangles"] += 1
            assert found.triangles.relation == relation.relation
            assert found.triangles.triangle_a == relation.triangle_a
        elif found.boxes == "apart" or found.box_gap > 1e-9:
            seen["boxes"] += 1
            assert relation.relation == "separated"
        else:
            seen["hulls"] += 1
            query = "depth" if found.both_convex else "distance"
            alone = core.check_pair(a.hull_shape(), b.hull_shape(), query=query)
            assert (found.hulls.outcome, found.hulls.distance) == (alone.outcome, alone.distance)
    assert min(seen.values()) > 10


def test_a_proven_depth_is_no_more_than_the_way_out():
    pairs = questions(crowd(16))
    found = [(pair, one) for pair, one in zip(pairs, core.climb_all(pairs), strict=True)]
    deep = [(pair, one) for pair, one in found if one.least_depth]
    assert len(deep) > 5
    for (a, b, *_), one in deep:
        out = core.check_pair(a.hull_shape(), b.hull_shape(), query="depth")
        assert 0 < one.least_depth <= -out.lower


@pytest.mark.parametrize("threads", [2, 5])
def test_threads_change_nothing(threads):
    pairs = questions(crowd(20))

    def said(found):
        return [
            (one.box_gap, one.boxes, one.least_depth, one.triangles and one.triangles.point)
            for one in found
        ]

    assert said(core.climb_all(pairs, threads=threads)) == said(core.climb_all(pairs, threads=1))


def test_the_last_rung_ends_the_climb():
    (pair, *_) = questions(crowd(2))
    by = {last: core.climb(pair, "aabb", last) for last in ("aabb", "obb", "hull")}
    assert (by["aabb"].boxes, by["aabb"].hulls) == ("", None)
    assert by["obb"].hulls is None
    assert by["hull"].triangles is None
    assert core.climb(pair, "hull", "hull").boxes == ""


def test_a_pair_that_fails_takes_no_other_with_it():
    bodies = crowd(6)
    sheet = core.Mesh(np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0.5)]), np.array([(0, 1, 2)]))
    bodies.append(core.PlacedGeometry(core.Geometry(sheet, True), None, sheet.bounds, 0.0))
    pairs = questions(bodies)
    failed = [pair for pair, one in zip(pairs, core.climb_all(pairs), strict=True) if one is None]
    assert failed
    assert all(pair[1] is bodies[-1] for pair in failed)
    with pytest.raises(ValueError, match="not a solid"):
        core.climb(failed[0])


def test_arguments_are_checked():
    (pair, *_) = questions(crowd(2))
    with pytest.raises(ValueError, match="a rung is"):
        core.climb_all([pair], "parts")
    with pytest.raises(TypeError):
        core.climb_all([(pair[0], None, 0.0, 0.0, False)])
    a, b = pair[0].surface(), pair[1].surface()
    with pytest.raises(IndexError):
        core.crossing_depth(a, b, 10**6, 0)


def test_a_body_where_its_file_puts_it_shares_what_its_mesh_has():
    shared = core.Geometry(two_boxes(), True)
    body = core.PlacedGeometry(shared, None, two_boxes().bounds, 0.0)
    surface, shape = shared.surface(), shared.hull_shape()
    assert body.surface() is surface
    assert body.hull_shape() is shape
    assert (shared.hierarchies, shared.refits, shared.known_convex) == (1, 0, None)
    assert not shared.convex
    assert shared.known_convex is False
