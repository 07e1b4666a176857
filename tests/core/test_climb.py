"""The ladder of the core: the same answers as its rungs give one by one, and what it leaves out."""

from __future__ import annotations

import math
import random
from threading import Event, Thread
from time import sleep

import numpy as np
import pytest

from satcheck import core

Matrix = tuple[float, ...]
Corner = tuple[float, float, float]
Question = tuple[core.PlacedGeometry, core.PlacedGeometry, float, float, float, float, bool]

BOX = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4)]
BOX += [(2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]


def boxes(*bounds: tuple[Corner, Corner]) -> core.Mesh:
    points: list[Corner] = []
    triangles: list[tuple[int, ...]] = []
    for (x0, y0, z0), (x1, y1, z1) in bounds:
        triangles += [tuple(i + len(points) for i in t) for t in BOX]
        points += [(x, y, z) for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)]
    return core.Mesh(np.array(points, dtype=float), np.array(triangles, dtype=np.int32))


CUBE = boxes(((-1, -1, -1), (1, 1, 1)))
TWO_BOXES = boxes(((-1, -1, -1), (1, 0, 1)), ((-1, 2, -1), (1, 3, 1)))  # not convex


def turned(rng: random.Random) -> Matrix:
    angle = rng.uniform(-3, 3)
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = (rng.uniform(-2, 2) for _ in range(3))
    return (c, -s, 0.0, x, s, c, 0.0, y, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0)


def crowd(count: int) -> list[core.PlacedGeometry]:
    rng = random.Random(3)
    meshes = (TWO_BOXES, CUBE)
    shared = [core.Geometry(mesh, True) for mesh in meshes]
    bodies = []
    for k in range(count):
        matrix = turned(rng)
        bounds = meshes[k % 2].transformed(matrix).bounds
        bodies.append(core.PlacedGeometry(shared[k % 2], matrix, bounds, 1e-12))
    return bodies


def questions(bodies: list[core.PlacedGeometry], tolerance: float = 1e-9) -> list[Question]:
    return [
        (a, b, tolerance, tolerance, tolerance / 2, tolerance / 2, False)
        for k, a in enumerate(bodies)
        for b in bodies[k + 1 :]
    ]


def climbed(pairs: list[Question]) -> list[core.Climb]:
    found = core.Climbing(pairs).results()
    return [one for one in found if one is not None]


def test_rungs_say_what_they_say_alone() -> None:
    pairs = questions(crowd(24))
    seen = {"hulls": 0, "triangles": 0, "boxes": 0}
    for (a, b, *_), found in zip(pairs, climbed(pairs), strict=True):
        relation = core.mesh_relation(a.surface(), b.surface())
        assert (found.relation, found.settled, found.proven) == (relation.relation, True, True)
        if found.triangles is not None:
            seen["triangles"] += 1
            assert found.triangles.relation == relation.relation
            assert found.triangles.triangle_a == relation.triangle_a
        elif found.boxes == "apart" or found.box_gap > 1e-9:
            seen["boxes"] += 1
            assert relation.relation == "separated"
        else:
            seen["hulls"] += 1
            shapes = a.hull_shape(), b.hull_shape()
            convex = found.signed_distance is not None
            alone = core.check_pair(*shapes, query="depth" if convex else "distance")
            assert found.hulls is not None
            assert (found.hulls.outcome, found.hulls.distance) == (alone.outcome, alone.distance)
    assert min(seen.values()) > 10


def test_a_proven_depth_is_no_more_than_the_way_out() -> None:
    pairs = questions(crowd(16))
    depths = [one.least_depth or 0.0 for one in climbed(pairs)]
    assert sum(depth > 0 for depth in depths) > 5
    for (a, b, *_), depth in zip(pairs, depths, strict=True):
        out = core.check_pair(a.hull_shape(), b.hull_shape(), query="depth")
        assert depth <= max(-(out.lower or 0.0), 0.0)


@pytest.mark.parametrize("threads", [2, 5])
def test_threads_change_nothing(threads: int) -> None:
    pairs = questions(crowd(20))

    def said(found: list[core.Climb | None]) -> list[object]:
        return [
            (one.box_gap, one.boxes, one.least_depth, one.triangles and one.triangles.point)
            for one in found
            if one is not None
        ]

    many, one = core.Climbing(pairs, threads=threads), core.Climbing(pairs, threads=1)
    assert said(many.results()) == said(one.results())


def turns_while_a_batch_ends() -> int:
    """How far another thread counts while a batch that nobody takes is given up. It may be none:
    the batch may be done by then, or the other thread may get no processor."""
    climbing = core.Climbing(questions(crowd(150)), threads=2)
    turns, ended = 0, Event()

    def count() -> None:
        nonlocal turns
        while not ended.is_set():
            turns += 1

    other = Thread(target=count)
    other.start()
    while not turns:
        sleep(0)
    before = turns
    del climbing
    after = turns
    ended.set()
    other.join()
    return after - before


def test_python_goes_on_while_a_batch_that_nobody_takes_ends() -> None:
    """Else no thread would hear Ctrl-C meanwhile. One that holds Python lets nobody count, however
    often it is tried."""
    assert any(turns_while_a_batch_ends() for _ in range(50))


def test_a_capped_climb_settles_nothing_that_it_cannot_prove() -> None:
    shared = core.Geometry(TWO_BOXES, True)
    body = core.PlacedGeometry(shared, None, TWO_BOXES.bounds, 0.0)
    within_notch = boxes(((-0.5, 0.5, -0.5), (0.5, 1.5, 0.5)))
    other = core.PlacedGeometry(core.Geometry(within_notch, True), None, within_notch.bounds, 0.0)
    request = (body, other, 0.0, 0.0, 0.0, 0.0, False)
    capped, whole = core.climb(request, last="hull"), core.climb(request)
    assert (capped.relation, capped.settled, capped.proven) == ("penetrating", False, False)
    assert (whole.relation, whole.settled, whole.proven) == ("separated", True, True)


def test_boxes_closer_than_asked_leave_the_pair_to_the_next_rung() -> None:
    a = core.PlacedGeometry(core.Geometry(CUBE, True), None, CUBE.bounds, 0.0)
    beside = boxes(((1.5, -1, -1), (3, 1, 1)))
    b = core.PlacedGeometry(core.Geometry(beside, True), None, beside.bounds, 0.0)
    near = core.climb((a, b, 1.0, 0.0, 0.0, 0.0, False), last="aabb")
    assert (near.relation, near.settled, near.proven) == ("separated", False, True)
    assert near.gap_lower == near.box_gap > 0
    far = core.climb((a, b, 0.25, 0.0, 0.0, 0.0, False))
    assert (far.relation, far.settled, far.gap_lower) == ("separated", True, far.box_gap)


@pytest.mark.parametrize(
    ("tolerance", "band"), [(0.0, "deeper"), (0.25, "deeper"), (0.5, "within")]
)
def test_the_touch_band_of_two_convex_bodies_is_exact(tolerance: float, band: str) -> None:
    cube = core.Geometry(CUBE, True)
    a = core.PlacedGeometry(cube, None, CUBE.bounds, 0.0)
    into = boxes(((0.5, -0.75, -0.75), (3, 0.75, 0.75)))
    b = core.PlacedGeometry(core.Geometry(into, True), None, into.bounds, 0.0)
    climb = core.climb((a, b, tolerance, tolerance, tolerance / 2, tolerance / 2, False))
    assert (climb.relation, climb.band) == ("penetrating", band)


def test_the_last_rung_ends_the_climb() -> None:
    (pair, *_) = questions(crowd(2))
    lowest = core.climb(pair, last="aabb")
    assert (lowest.boxes, lowest.hulls) == ("", None)
    assert core.climb(pair, last="obb").hulls is None
    assert core.climb(pair, last="hull").triangles is None
    assert core.climb(pair, "hull", "hull").boxes == ""


def test_a_pair_that_fails_takes_no_other_with_it() -> None:
    bodies = crowd(6)
    sheet = core.Mesh(np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0.5)]), np.array([(0, 1, 2)]))
    bodies.append(core.PlacedGeometry(core.Geometry(sheet, True), None, sheet.bounds, 0.0))
    pairs = questions(bodies)
    climbs = core.Climbing(pairs).results()
    failed = [pair for pair, climb in zip(pairs, climbs, strict=True) if climb is None]
    assert failed
    assert all(pair[1] is bodies[-1] for pair in failed)
    with pytest.raises(ValueError, match="not a solid"):
        core.climb(failed[0])


def test_arguments_are_checked() -> None:
    (pair, *_) = questions(crowd(2))
    with pytest.raises(ValueError, match="a rung is"):
        core.Climbing([pair], "parts")
    with pytest.raises(ValueError, match="lacks a body"):
        core.Climbing([(pair[0], None, 0.0, 0.0, 0.0, 0.0, False)])  # type: ignore[list-item]
    a, b = pair[0].surface(), pair[1].surface()
    with pytest.raises(IndexError):
        core.crossing_depth(a, b, 10**6, 0)


def test_a_body_where_its_file_puts_it_shares_what_its_mesh_has() -> None:
    shared = core.Geometry(TWO_BOXES, True)
    body = core.PlacedGeometry(shared, None, TWO_BOXES.bounds, 0.0)
    surface, shape = shared.surface(), shared.hull_shape()
    assert body.surface() is surface
    assert body.hull_shape() is shape
    assert (shared.hierarchies, shared.refits, shared.known_convex) == (1, 0, None)
    assert not shared.convex
    assert shared.known_convex is False
