"""The thickness of overlaps: proven intervals against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh

from satcheck.core import Mesh, Surface, search_thickness
from tests.core.voxel_solids import VoxelSolid, box

WORK = 100_000_000


def tetrahedron(height: float) -> Surface:
    """The corner x, y, z >= 0, x + y + z <= height."""
    corners = [(0, 0, 0), (height, 0, 0), (0, height, 0), (0, 0, height)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    return Surface(Mesh(np.array(corners, float), np.array(faces, np.uint32)), True)


def cube(low: int, high: int) -> Surface:
    return Surface(box((low,) * 3, (high,) * 3).mesh(), True)


def test_the_insphere_of_a_corner_that_reaches_into_a_cube() -> None:
    found = search_thickness(tetrahedron(3.0), cube(-1, 4), width=0.01, work=WORK)
    truth = 2 * 3.0 / (3 + math.sqrt(3))
    assert found.lower <= truth <= found.upper
    assert found.stop == "narrow"
    assert found.upper - found.lower <= 0.01 * found.upper
    assert found.centre is not None
    assert found.radius == pytest.approx(found.lower / 2, rel=1e-9)


def test_a_limit_ends_the_search_early() -> None:
    exact = search_thickness(tetrahedron(3.0), cube(-1, 4), width=1e-6, work=WORK)
    for limit in (0.5, 2.0):
        found = search_thickness(tetrahedron(3.0), cube(-1, 4), width=1e-6, work=WORK, limit=limit)
        assert found.stop == "decided"
        assert (found.lower > limit) == (exact.lower > limit)
        assert (found.upper <= limit) == (exact.upper <= limit)
        assert found.boxes <= exact.boxes


def test_a_known_bound_makes_the_search_shorter() -> None:
    truth = 2 * 3.0 / (3 + math.sqrt(3))
    a, b = tetrahedron(3.0), cube(-1, 4)
    alone = search_thickness(a, b, width=1e-3, work=WORK)
    found = search_thickness(a, b, width=1e-3, work=WORK, most=truth * (1 + 1e-6))
    assert found.stop == "narrow"
    assert found.lower <= truth <= found.upper <= truth * (1 + 2e-6)
    assert found.boxes <= alone.boxes


def test_no_work_leaves_a_wide_interval() -> None:
    """A cube within the hollow of a box whose walls it enters by 1."""
    hollow = VoxelSolid(box((0, 0, 0), (8, 8, 8)).cells - box((2, 2, 2), (6, 6, 6)).cells)
    a, b = Surface(hollow.mesh(), True), cube(1, 7)
    spent = search_thickness(a, b, width=1e-6, work=0)
    assert spent.stop == "work spent"
    assert spent.lower <= 1.0 <= spent.upper


@pytest.mark.parametrize(
    "wrong",
    [{"width": -0.1}, {"less_a": -1.0}, {"less_b": math.inf}, {"limit": math.nan}, {"most": 0.0}],
)
def test_wrong_lengths_are_refused(wrong: dict[str, float]) -> None:
    given = {"width": 0.01, **wrong}
    with pytest.raises(ValueError, match=next(iter(wrong))):
        search_thickness(cube(0, 1), cube(0, 2), work=WORK, **given)  # type: ignore[arg-type]


def test_an_open_surface_is_refused() -> None:
    mesh = Mesh(np.eye(3), np.array([(0, 1, 2)], np.uint32))
    with pytest.raises(ValueError, match="solid"):
        search_thickness(Surface(mesh, False), cube(0, 1), width=0.01, work=WORK)


def prism_ring(
    outer: float, inner: float, turn: float, low: float, high: float, n: int, twist: float = 0.0
) -> Surface:
    """A ring of n facets along z; a prism if inner is 0. turn: in facets, and how far they turn on
    the way from low to high."""
    steps = 2 * math.pi / n * np.add.outer((turn, turn + twist), np.arange(n))
    radii = (outer, inner or outer / 2)
    points = [
        (r * math.cos(angle), r * math.sin(angle), z)
        for z, angles in zip((low, high), steps, strict=True)
        for r in radii
        for angle in angles
    ]
    quads = []
    for k in range(n):
        j = (k + 1) % n
        bottom, top = (k, j, n + j, n + k), (2 * n + k, 2 * n + j, 3 * n + j, 3 * n + k)
        quads += [bottom[::-1], top, (k, j, 2 * n + j, 2 * n + k)]
        if inner:
            quads.append((n + j, n + k, 3 * n + k, 3 * n + j))
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    if not inner:
        faces += [
            t
            for k in range(1, n - 1)
            for t in ((n, n + k + 1, n + k), (3 * n, 3 * n + k, 3 * n + k + 1))
        ]
    return Surface(Mesh(np.array(points), np.array(faces, np.uint32)), True)


def test_surfaces_off_by_exactly_the_sagitta_explain_facets_that_interlock() -> None:
    """The overlap ends where the distance to a facet is the tolerance, but for rounding."""
    n = 24
    bolt, hole = prism_ring(5, 0, 0.5, -10, 10, n), prism_ring(9, 5, 0, -4, 4, n)
    sagitta = 5 * (1 - math.cos(math.pi / n))
    found = search_thickness(
        bolt, hole, width=0.0, work=WORK, less_a=sagitta, less_b=sagitta, limit=1e-10 * sagitta
    )
    assert found.stop == "decided"
    assert found.upper <= 1e-10 * sagitta


def test_slivers_between_long_triangles() -> None:
    """Triangles that turn a little from one end to the other: no two lie in one plane, and
    planes around a sliver differ by half a degree. Slivers are half as thick as the sagitta."""
    n = 280
    bolt, hole = prism_ring(5, 0, 0.3, -10, 10, n, 0.2), prism_ring(9, 5, 0, -10, 10, n - 14, 0.1)
    sagitta = 5 * (1 - math.cos(math.pi / (n - 14)))
    for share, is_real in ((0.55, False), (0.45, True)):
        off = share * sagitta
        found = search_thickness(
            bolt, hole, width=0.0, work=WORK // 2, less_a=off, less_b=off, limit=0.0
        )
        assert found.stop == "decided"
        assert (found.lower > 0) == is_real


def sphere_and_mould(*, shift: float = 0.0, larger: float = 1.0) -> tuple[Surface, Surface]:
    """A ball of 5,120 triangles that is moved across one of them, and a block with its hollow."""
    ball = trimesh.creation.icosphere(subdivisions=4)
    points, faces = np.array(ball.vertices), np.array(ball.faces, np.uint32)
    block = box((-2, -2, -2), (2, 2, 2)).mesh()
    hollow = faces[:, ::-1] + np.uint32(len(block.vertices))
    corners = np.vstack((np.array(block.vertices), points))
    mould = Mesh(corners, np.vstack((np.array(block.triangles, np.uint32), hollow)))
    moved = larger * points + shift * ball.face_normals[0]
    return Surface(Mesh(moved, faces), True), Surface(mould, True)


@pytest.mark.parametrize("swap", [False, True])
def test_a_flush_sphere_is_proven_at_once(swap: bool) -> None:
    pair = sphere_and_mould()
    found = search_thickness(*(pair[::-1] if swap else pair), width=0.01, work=WORK)
    assert found.stop == "narrow"
    assert found.upper <= 1e-10  # rounding, 256 roundoffs of the size a few times


@pytest.mark.parametrize("shift", [1e-3, 1e-6, 1e-9])
def test_a_sphere_moved_in_its_mould(shift: float) -> None:
    """A move across a triangle makes a slab over it. No ball in both is thicker, for that move back
    frees the sphere."""
    found = search_thickness(*sphere_and_mould(shift=shift), width=0.01, work=2 * WORK)
    assert found.lower <= shift * (1 + 1e-6)
    assert shift * (1 - 1e-6) <= found.upper <= 3 * shift


def test_a_sphere_too_large_for_its_mould() -> None:
    """Each triangle is a slab of `growth` times its height above the centre, at most 1."""
    growth = 1e-6
    found = search_thickness(*sphere_and_mould(larger=1 + growth), width=0.01, work=2 * WORK)
    assert found.lower <= growth * (1 + 1e-6)
    assert 0.99 * growth <= found.upper <= 3 * growth


def waves(*, up: bool, shift: float = 0.0) -> Surface:
    """A block of the unit square that ends in waves, above or below them."""
    n = 40
    grid = np.linspace(0, 1, n + 1)
    x, y = (a.ravel() for a in np.meshgrid(grid, grid, indexing="ij"))
    heights = (0.1 * np.sin(7 * x) * np.cos(5 * y) + shift, np.full_like(x, 1.0 if up else -1.0))
    points = np.vstack([np.column_stack((x, y, z)) for z in heights])
    place = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = (
        part.ravel() for part in (place[:-1, :-1], place[1:, :-1], place[1:, 1:], place[:-1, 1:])
    )
    far = len(x)
    ring = np.concatenate((place[:-1, 0], place[-1, :-1], place[:0:-1, -1], place[0, :0:-1]))
    after = np.roll(ring, -1)
    faces = np.vstack(
        [
            np.column_stack(t)
            for t in (
                (a, b, c),
                (a, c, d),
                (a + far, c + far, b + far),
                (a + far, d + far, c + far),
                (after, ring, ring + far),
                (after, ring + far, after + far),
            )
        ]
    )
    return Surface(Mesh(points, (faces[:, ::-1] if up else faces).astype(np.uint32)), True)


def test_flush_waves_and_waves_pressed_together() -> None:
    """Waves of 3,200 triangles. Pressed together they overlap by no more than they were moved."""
    flush = search_thickness(waves(up=False), waves(up=True), width=0.01, work=WORK)
    assert flush.upper <= 1e-9
    pressed = search_thickness(
        waves(up=False), waves(up=True, shift=-0.01), width=0.01, work=4 * WORK
    )
    assert 0 < pressed.lower <= 0.01
    assert pressed.upper <= 0.03


@pytest.mark.parametrize("work", [10_000_000, 20_000_000, 30_000_000])
def test_a_budget_is_kept_to_about_a_cell(work: int) -> None:
    """Cells are divided 64 at a time, and fewer at the end. A cell and its halves are three."""
    pair = waves(up=False), waves(up=True, shift=-0.01)
    spent = search_thickness(*pair, width=1e-12, work=work)
    assert spent.stop == "work spent"
    assert work <= spent.work <= work + 3 * spent.work / spent.boxes


def test_a_search_says_how_far_it_is() -> None:
    seen: list[tuple[float, float, float]] = []
    found = search_thickness(
        waves(up=False),
        waves(up=True, shift=-0.01),
        width=1e-12,
        work=2 * WORK,
        progress=lambda *state: seen.append(state),
    )
    assert len(seen) > 1
    assert seen == sorted(seen, key=lambda state: state[2])
    for lower, upper, share in seen:
        assert lower <= found.lower <= found.upper <= upper
        assert share > 0
