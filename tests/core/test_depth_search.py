"""Depth intervals against closed forms, against sampling, under maps that must change nothing."""

from __future__ import annotations

import itertools
import math
import random
import signal
import threading
import time
from typing import Any

import numpy as np
import pytest

from satcheck.audit import Settings
from satcheck.core import DepthInterval, Mesh, Surface, mesh_relation, search_depth
from tests.core.voxel_solids import Cell, VoxelSolid, box
from tests.oracles.free_directions import along, directions, is_free, sampled_depth

WORK = 200_000_000
DEFAULT = Settings().work


def search(a: Mesh, b: Mesh, upper: float, width: float = 0.01, work: int = WORK) -> DepthInterval:
    return search_depth(
        Surface(a, True), Surface(b, True), upper=upper, lower=0.0, width=width, work=work
    )


def voxel_depth(a: VoxelSolid, b: VoxelSolid) -> float:
    """Two unit cells share no interior when their corners differ by 1 along some axis. The nearest
    translation that frees all pairs has whole coordinates, then, and is no difference of two cells.
    """
    forbidden = {
        (q[0] - p[0], q[1] - p[1], q[2] - p[2]) for p in a.unit_cells() for q in b.unit_cells()
    }
    reach = range(-12, 13)
    free = (t for t in itertools.product(reach, reach, reach) if t not in forbidden)
    return min(math.hypot(*t) for t in free)


def random_solid(rng: random.Random) -> VoxelSolid:
    """A connected blob of cells with notches, holes and branches."""
    cells: set[Cell] = {(0, 0, 0)}
    while len(cells) < 14:
        x, y, z = rng.choice(sorted(cells))
        step = rng.choice([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)])
        cells.add((x + step[0], y + step[1], z + step[2]))
    return VoxelSolid(frozenset(cells))


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("share", [0.25, 0.75, 2.0])
def test_a_limit_ends_the_search(seed: int, share: float) -> None:
    """As soon as the depth is at least the limit; a limit that is never reached changes nothing."""
    rng = random.Random(seed)
    a, b = (Surface(random_solid(rng).mesh(), True) for _ in range(2))
    goal: dict[str, Any] = {"upper": 14.0, "lower": 0.0, "width": 0.01, "work": WORK}
    whole = search_depth(a, b, **goal)
    limit = share * whole.upper
    found = search_depth(a, b, **goal, limit=limit)
    assert found.work <= whole.work
    if share < 1:
        assert found.stop == "decided"
        assert found.lower >= limit * (1 - 1e-9)
        assert whole.lower <= found.upper
    else:
        assert (found.stop, found.lower, found.upper) == ("narrow", whole.lower, whole.upper)


@pytest.mark.parametrize("seed", range(24))
def test_voxel_solids_have_their_depth(seed: int) -> None:
    rng = random.Random(seed)
    a, b = random_solid(rng), random_solid(rng)
    truth = voxel_depth(a, b)
    found = search(a.mesh(seed=seed), b.mesh(seed=seed + 1), upper=14.0)
    assert found.lower <= truth * (1 + 1e-9)
    assert truth * (1 - 1e-12) <= found.upper
    assert found.stop == "narrow"
    assert found.upper - found.lower <= 0.01 * found.upper
    assert found.way_out is not None
    assert is_free(a.mesh(seed=seed), Surface(b.mesh(seed=seed + 1), True), found.way_out)


def test_out_through_the_wall_of_a_box_with_a_cavity() -> None:
    """A cube in the cavity of a hollow box, pushed 1 into a wall: back is nearer than out."""
    hollow = VoxelSolid(box((0, 0, 0), (7, 7, 7)).cells - box((2, 2, 2), (5, 5, 5)).cells)
    cube = box((4, 3, 3), (6, 4, 4))
    assert voxel_depth(cube, hollow) == 1.0
    found = search(cube.mesh(), hollow.mesh(), upper=8.0)
    assert found.lower == pytest.approx(1.0)
    assert found.way_out == pytest.approx((-1.0, 0.0, 0.0))


def torus(turns: int, sides: int, radius: float = 2.0, tube: float = 0.75) -> Mesh:
    points, faces = [], []
    for i in range(turns):
        u = 2 * math.pi * i / turns
        for j in range(sides):
            v = 2 * math.pi * j / sides
            r = radius + tube * math.cos(v)
            points.append((r * math.cos(u), r * math.sin(u), tube * math.sin(v)))
            k, m = (i + 1) % turns, (j + 1) % sides
            here, along_u = i * sides + j, k * sides + j
            faces += [(here, along_u, k * sides + m), (here, k * sides + m, i * sides + m)]
    return Mesh(np.array(points), np.array(faces, dtype=np.uint32))


Point = tuple[float, float, float]

CROSSED = (0.4, 0.9, 1.1)  # where the second torus lies: it leans into the tube of the first


def test_no_shorter_translation_frees_interlocked_rings() -> None:
    a = torus(24, 12)
    b = torus(20, 10).transformed((1, 0, 0, 1.5, 0, 0, -1, 0.3, 0, 1, 0, 0.2, 0, 0, 0, 1))
    found = search(a, b, upper=6.0)
    assert found.stop == "narrow"
    surface = Surface(b, True)
    assert found.way_out is not None
    assert is_free(a, surface, found.way_out)
    for way in directions(400):
        for share in (0.5, 0.9, 0.999):
            t = along(way, share * found.lower)
            assert not is_free(a, surface, t)
    assert found.lower <= sampled_depth(a, surface, found.upper * 1.01, 60)


def test_a_finer_tessellation_changes_the_depth_by_no_more_than_the_width() -> None:
    """Triangles in four, by the middles of their edges: the same solid up to one rounding."""
    a, b = torus(16, 8), torus(16, 8).translated(CROSSED)
    coarse = search(a, b, upper=6.0)
    fine = search(subdivided(a), subdivided(b), upper=6.0)
    assert max(coarse.lower, fine.lower) <= min(coarse.upper, fine.upper)
    assert abs(fine.upper - coarse.upper) <= 0.01 * coarse.upper


def subdivided(mesh: Mesh) -> Mesh:
    """Every triangle in four, by the middles of its edges, which are rounded."""
    points = [tuple(p) for p in mesh.vertices.tolist()]
    middles: dict[tuple[int, int], int] = {}

    def middle(i: int, j: int) -> int:
        key = (min(i, j), max(i, j))
        if key not in middles:
            middles[key] = len(points)
            points.append(tuple(0.5 * (p + q) for p, q in zip(points[i], points[j], strict=True)))
        return middles[key]

    faces = []
    for i, j, k in mesh.triangles.tolist():
        a, b, c = middle(i, j), middle(j, k), middle(k, i)
        faces += [(i, a, c), (a, j, b), (c, b, k), (a, b, c)]
    return Mesh(np.array(points), np.array(faces, dtype=np.uint32))


def test_swapping_the_meshes_negates_the_way_out() -> None:
    a, b = torus(16, 8), torus(14, 9).translated(CROSSED)
    there, back = search(a, b, upper=6.0), search(b, a, upper=6.0)
    assert (there.lower, there.upper, there.work) == (back.lower, back.upper, back.work)
    assert there.way_out is not None
    assert back.way_out == tuple(0.0 - c for c in there.way_out)


def test_scaling_by_a_power_of_two_scales_the_interval() -> None:
    a, b = torus(16, 8), torus(14, 9).translated(CROSSED)
    plain = search(a, b, upper=6.0)
    for scale in (2.0**-40, 2.0**30):
        matrix = (scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, 1)
        scaled = search(a.transformed(matrix), b.transformed(matrix), upper=6.0 * scale)
        assert (scaled.lower, scaled.upper) == (plain.lower * scale, plain.upper * scale)


@pytest.mark.parametrize("scale", [2.0**-149, 2.0**-146, 2.0**145, 2.0**147])
def test_at_the_ends_of_the_numeric_range_the_interval_is_wide_at_worst(scale: float) -> None:
    a, b = torus(16, 8), torus(14, 9).translated(CROSSED)
    plain = search(a, b, upper=6.0)
    matrix = (scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, 1)
    found = search(a.transformed(matrix), b.transformed(matrix), upper=6.0 * scale)
    assert found.lower <= plain.upper * scale
    assert plain.lower * scale <= found.upper


def test_an_interval_that_ran_out_of_work_is_wide_but_right() -> None:
    a, b = torus(16, 8), torus(14, 9).translated(CROSSED)
    full = search(a, b, upper=6.0)
    assert full.stop == "narrow"
    for work in (1, full.work // 8, full.work // 2):
        part = search(a, b, upper=6.0, work=work)
        assert part.stop == "work spent"
        assert part.upper - part.lower > 0.01 * part.upper
        assert part.lower <= full.upper
        assert full.lower <= part.upper


def turned(mesh: Mesh, seed: int) -> Mesh:
    """By any rotation, so that no two faces of different meshes are parallel."""
    matrix = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    matrix[:, 0] *= np.linalg.det(matrix)
    return Mesh(mesh.vertices @ matrix.T, mesh.triangles)


def bars(sizes_and_middles: list[tuple[Point, Point]]) -> Mesh:
    """Boxes in one mesh, which may overlap."""
    cube = box((0, 0, 0), (1, 1, 1)).mesh()
    points = [
        (cube.vertices - 0.5) * np.array(size) + np.array(middle)
        for size, middle in sizes_and_middles
    ]
    faces = [cube.triangles + np.uint32(k * len(cube.vertices)) for k in range(len(points))]
    return Mesh(np.concatenate(points), np.concatenate(faces))


@pytest.mark.parametrize("seed", range(3))
def test_bars_among_bars_converge(seed: int) -> None:
    """Thin bars make forbidden sets that overlap but little, with long seams between them."""
    places = list(itertools.product(np.linspace(-0.4, 0.4, 6).tolist(), repeat=2))
    rods = bars([((0.03, 0.03, 1.0), (x, y, 0.0)) for x, y in places])
    edges: list[tuple[Point, Point]] = []
    for p, q in itertools.product((-0.5, 0.5), repeat=2):
        edges += [
            ((1.0, 0.05, 0.05), (0.0, p, q)),
            ((0.05, 1.0, 0.05), (p, 0.0, q)),
            ((0.05, 0.05, 1.0), (p, q, 0.0)),
        ]
    frame = turned(bars(edges), seed).translated((0.1, 0.2, 0.15))
    found = search(rods, frame, upper=3.0, work=DEFAULT)
    assert found.stop == "narrow"
    assert found.upper - found.lower <= 0.01 * found.upper
    surface = Surface(frame, True)
    assert found.way_out is not None
    assert is_free(rods, surface, found.way_out)
    for way in directions(300):
        for share in (0.5, 0.9, 0.999):
            assert not is_free(rods, surface, along(way, share * found.lower))


def test_a_crossing_in_the_last_digit_hides_no_overlap() -> None:
    """A corner of one ring on a corner of the other, up to rounding: no set can be grown there, and
    the rings overlap elsewhere."""
    overlaps = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        a, b = turned(torus(9, 6), seed), turned(torus(7, 5, radius=1.5), seed + 1000)
        i, k = rng.integers(len(a.vertices)), rng.integers(len(b.vertices))
        a = a.translated(tuple((b.vertices[k] - a.vertices[i]).tolist()))
        surface = Surface(b, True)
        if any(is_free(a, surface, along(way, 1e-9)) for way in directions(50)):
            continue
        overlaps += 1
        assert search(a, b, upper=8.0).stop == "narrow"
    assert overlaps > 10


FAR = 1e9


def on_grid(mesh: Mesh, size: float) -> Mesh:
    """Of about this size, on whole numbers of the last place of coordinates about FAR."""
    ulp = math.ulp(FAR)
    return Mesh(np.round(mesh.vertices * (size / ulp)) * ulp, mesh.triangles)


@pytest.mark.parametrize("size", [2e-6, 1e-3, 1.0])
def test_far_from_the_origin_nothing_changes(size: float) -> None:
    a = on_grid(torus(12, 5), size)
    b = on_grid(torus(5, 4).translated(CROSSED), size)
    upper = 6.0 * size
    near = search(a, b, upper)
    away = (FAR, FAR, -FAR)
    started = time.process_time()
    far = search(a.translated(away), b.translated(away), upper)
    taken = time.process_time() - started
    assert far.stop == near.stop == "narrow"
    assert max(near.lower, far.lower) <= min(near.bound, far.bound)
    assert far.upper - far.lower <= 0.01 * far.upper
    assert far.upper <= far.bound <= far.upper * (1 + 1e-12)
    assert taken < 10e-9 * max(far.work, 100_000_000)


def test_no_more_work_is_done_than_was_allowed() -> None:
    """A part far away: no centre helps, and moved coordinates are whole ulps, where triangles lie
    in one plane again and again. The last query may go beyond."""
    size, allowed = 2e-6, 20_000_000
    a = on_grid(torus(12, 8), size).translated((FAR, FAR, 0.0))
    b = on_grid(torus(9, 7).translated(CROSSED), size).translated((FAR, FAR, 0.0))
    cube = box((0, 0, 0), (1, 1, 1)).mesh()
    both = Mesh(
        np.concatenate([b.vertices, cube.vertices]),
        np.concatenate([b.triangles, cube.triangles + np.uint32(len(b.vertices))]),
    )
    found = search(a, both, upper=6.0 * size, work=allowed)
    assert found.stop == "work spent"
    assert allowed <= found.work <= 1.2 * allowed


def test_a_search_that_is_asked_again_answers_the_same() -> None:
    """Closings and hulls of holes are made by the first query that needs them, and no search pays
    for them: neither the second time nor after somebody else made them."""
    ring = torus(32, 16)
    holed = Mesh(ring.vertices, ring.triangles[np.arange(len(ring.triangles)) % 37 != 5])
    other = torus(14, 9).translated(CROSSED)

    def answers(work: int, times: int, prepared: bool) -> list[tuple[object, ...]]:
        a, b = Surface(other, True), Surface(holed, False)
        if prepared:
            mesh_relation(a, b)
        found = [
            search_depth(a, b, upper=6.0, lower=0.0, width=0.01, work=work) for _ in range(times)
        ]
        return [(d.lower, d.upper, d.way_out, d.work, d.boxes, d.stop) for d in found]

    whole = search_depth(
        Surface(other, True), Surface(holed, False), upper=6.0, lower=0.0, width=0.01, work=WORK
    )
    assert whole.stop == "narrow"
    intervals = set()
    for k in range(1, 61):
        work = whole.work * k // 60
        first, second, prepared = answers(work, 2, False) + answers(work, 1, True)
        assert first == second == prepared
        intervals.add(first[:2])
    assert len(intervals) > 1


def with_dust(mesh: Mesh, exponent: float, seed: int) -> Mesh:
    """Its coordinates that are 0 get many sizes, down to 10^exponent."""
    rng = np.random.default_rng(seed)
    shape = mesh.vertices.shape
    dust = 10.0 ** rng.uniform(exponent, -20, shape) * rng.choice([-1, 1], shape)
    return Mesh(np.where(mesh.vertices == 0, dust, mesh.vertices), mesh.triangles)


@pytest.mark.parametrize("seed", [2, 4])
def test_long_numbers_cost_more(seed: int) -> None:
    """Exact arithmetic decides the signs of faces that dust keeps out of one plane: the longer its
    numbers, the fewer tests of the meshes may be made."""
    rng, allowed = random.Random(seed), 20_000_000
    a, b = random_solid(rng).mesh(), random_solid(rng).mesh()
    tests = []
    for exponent in (-120, -250):
        dusty_a, dusty_b = with_dust(a, exponent, seed), with_dust(b, exponent, seed + 50)
        found = search(dusty_a, dusty_b, upper=14.0, work=allowed)
        assert found.stop == "work spent"
        assert allowed <= found.work <= 1.2 * allowed
        tests.append(found.mesh_tests)
    assert tests[1] < 0.6 * tests[0]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("across", range(3))
def test_nothing_is_moved_across_a_plane(seed: int, across: int) -> None:
    """Blobs of squares, one of them three layers thick: along the axis the way out is 2 long."""
    rng = random.Random(seed)
    flat = [{c[:2] for c in random_solid(rng).cells} for _ in "ab"]

    def layers(squares: set[tuple[int, int]], heights: range) -> VoxelSolid:
        cells = ((*square[:across], h, *square[across:]) for square in squares for h in heights)
        return VoxelSolid(frozenset((x, y, z) for x, y, z in cells))

    a, b = layers(flat[0], range(-1, 2)), layers(flat[1], range(1))
    truth = voxel_depth(layers(flat[0], range(-20, 21)), b)
    found = search_depth(
        Surface(a.mesh(seed=seed), True),
        Surface(b.mesh(seed=seed), True),
        upper=14.0,
        lower=0.0,
        width=0.01,
        work=WORK,
        across=across,
    )
    assert found.lower <= truth * (1 + 1e-9)
    assert truth * (1 - 1e-12) <= found.upper
    assert found.stop == "narrow"
    assert found.way_out is not None
    assert found.way_out[across] == 0.0
    assert is_free(a.mesh(seed=seed), Surface(b.mesh(seed=seed), True), found.way_out)


def test_open_surfaces_are_parted_where_triangles_no_longer_cross() -> None:
    sheet = Mesh(
        np.array([(0.0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)]),
        np.array([(0, 1, 2), (0, 2, 3)], dtype=np.uint32),
    )
    fin = Mesh(
        np.array([(1.0, 1, -0.5), (3, 1, -0.5), (2, 1, 3.0)]),
        np.array([(0, 1, 2)], dtype=np.uint32),
    )
    a, b = Surface(fin, False), Surface(sheet, False)
    found = search_depth(a, b, upper=4.0, lower=0.0, width=0.01, work=WORK)
    assert found.lower == pytest.approx(0.5, rel=0.01)
    assert found.upper == pytest.approx(0.5, rel=0.01)
    assert mesh_relation(a, b).relation == "penetrating"


@pytest.mark.parametrize(
    "wrong",
    [
        {"upper": -1.0},
        {"upper": math.inf},
        {"lower": math.nan},
        {"width": 1.0},
        {"width": -0.1},
        {"across": 3},
        {"limit": 0.0},
        {"limit": math.nan},
    ],
)
def test_what_is_no_goal_is_refused(wrong: dict[str, Any]) -> None:
    cube = Surface(box((0, 0, 0), (1, 1, 1)).mesh(), True)
    goal: dict[str, Any] = {"upper": 1.0, "lower": 0.0, "width": 0.01} | wrong
    with pytest.raises(ValueError, match="must"):
        search_depth(cube, cube, work=1, **goal)


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="no signals to a thread")
def test_ctrl_c_ends_a_search() -> None:
    """It has work for an hour; who does not hear the signal never comes back."""
    a, b = torus(24, 12), torus(20, 10).translated(CROSSED)
    main = threading.get_ident()
    later = threading.Timer(0.2, signal.pthread_kill, (main, signal.SIGINT))
    later.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            search(a, b, upper=6.0, width=0.0, work=3_600_000_000_000)
    finally:
        later.cancel()


class EnoughError(Exception):
    """Raised by a caller that has seen enough of a search."""


def test_a_search_says_how_far_it_is() -> None:
    """Its interval only becomes narrower, and holds what a search without an audience proves."""
    a, b = Surface(torus(24, 12), True), Surface(torus(20, 10).translated(CROSSED), True)
    seen: list[tuple[float, float, float]] = []

    def progress(lower: float, upper: float, share: float) -> None:
        seen.append((lower, upper, share))
        if len(seen) == 3:
            raise EnoughError

    with pytest.raises(EnoughError):
        search_depth(a, b, upper=6.0, lower=0.0, width=0.0, work=10**12, progress=progress)
    truth = search_depth(a, b, upper=6.0, lower=0.0, width=0.01, work=WORK)
    for (lower, upper, share), (lower_after, upper_after, share_after) in itertools.pairwise(seen):
        assert lower <= lower_after <= truth.upper
        assert truth.lower <= upper_after <= upper
        assert 0 < share < share_after < 1
