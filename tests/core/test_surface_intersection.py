"""Where surfaces meet: against rational clipping, set operations and geometry that is known."""

from __future__ import annotations

import math
import random
from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
import pytest
import trimesh

from satcheck.core import Mesh, Surface, SurfaceIntersection, surface_intersection
from tests.core.test_mesh_relation import CELL, CUBE, HOLLOW, SMALL, moved, random_pair
from tests.core.voxel_solids import FACES, SHEAR, Cell, VoxelSolid, mesh_of_soup
from tests.oracles.triangle_intersection import area, common_points

Point = tuple[float, float, float]
PLENTY = 10**7
SQRT3 = math.sqrt(3.0)


def meet(a: Mesh, b: Mesh) -> SurfaceIntersection:
    """Both ways round: a swap mirrors what it has to and changes nothing else."""
    sa, sb = (Surface(m, m.topology().solid) for m in (a, b))
    found, mirror = surface_intersection(sa, sb, PLENTY), surface_intersection(sb, sa, PLENTY)
    assert shape_of(found) == shape_of(mirror)
    assert sorted((j, i) for i, j in mirror.triangle_pairs) == found.triangle_pairs
    for patch in found.patches:
        assert math.hypot(*patch.normal) == pytest.approx(1.0, abs=1e-15)
    return found


def shape_of(found: SurfaceIntersection) -> object:
    """Everything that does not depend on which surface comes first."""
    patches = sorted(
        (patch.opposed, sorted(sorted(outline) for outline in patch.outlines))
        for patch in found.patches
    )
    return [(c.closed, c.points) for c in found.curves], patches, found.points


def sheet(*triangles: Sequence[Sequence[float]]) -> Mesh:
    return mesh_of_soup([(p[0], p[1], p[2]) for triangle in triangles for p in triangle])


def of_trimesh(mesh: trimesh.Trimesh) -> Mesh:
    return Mesh(np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64))


def collinear(t: Sequence[Point]) -> bool:
    u, v = (np.subtract(t[k], t[0]) for k in (1, 2))
    return not np.cross(u, v).any()


def check_against_clipping(a: Sequence[Point], b: Sequence[Point]) -> int:
    """Returns how many corners the intersection has."""
    truth = common_points(a, b)
    corners = sorted((float(p[0]), float(p[1]), float(p[2])) for p in truth)
    found = meet(sheet(a), sheet(b))
    kinds = (len(found.points), len(found.curves), len(found.patches))
    assert kinds == (len(truth) == 1, len(truth) == 2, len(truth) > 2), (a, b)
    listed = [*found.points, *(p for c in found.curves for p in c.points)]
    listed += [p for patch in found.patches for outline in patch.outlines for p in outline]
    assert sorted(listed) == corners, (a, b)  # each coordinate rounded once
    for patch in found.patches:
        assert patch.area == pytest.approx(area(truth), rel=1e-14)
    assert len(found.triangle_pairs) == (1 if truth else 0)
    return len(truth)


def lattice_triangle(rng: random.Random, extent: int, *, flat: bool) -> list[Point]:
    def corner() -> Point:
        x, y = (float(rng.randrange(extent)) for _ in range(2))
        return (x, y, 1.0 if flat else float(rng.randrange(extent)))

    return [corner() for _ in range(3)]


@pytest.mark.parametrize("flat", [False, True])
def test_two_triangles_on_a_lattice(flat: bool) -> None:
    rng, seen = random.Random(1), Counter[int]()
    while sum(seen.values()) < 1500:
        a, b = (lattice_triangle(rng, 4, flat=flat) for _ in range(2))
        if len(set(a)) == len(set(b)) == 3 and not (collinear(a) and collinear(b)):
            seen[check_against_clipping(a, b)] += 1
    assert all(seen[k] for k in range(7 if flat else 3)), seen


def test_two_triangles_anywhere() -> None:
    """Also far from the origin, where rounding each coordinate once leaves little of a triangle."""
    rng, seen = random.Random(2), Counter[int]()
    for far in (0.0, 1e3, 1e9):
        for _ in range(150):
            a, b = (
                [(far + rng.random(), far + rng.random(), far + rng.random()) for _ in range(3)]
                for _ in range(2)
            )
            seen[check_against_clipping(a, b)] += 1
    assert seen[2] > 50


Square = frozenset[Cell]  # four lattice points


def unit_squares(solid: VoxelSolid) -> dict[Square, set[Cell]]:
    """The unit squares of the boundary, each with its outward directions."""
    cells = solid.unit_cells()
    squares: dict[Square, set[Cell]] = {}
    for cell in cells:
        for step, corners in FACES:
            if add(cell, step) not in cells:
                square = frozenset(add(cell, corner) for corner in corners)
                squares.setdefault(square, set()).add(step)
    return squares


def add(p: Cell, q: Cell) -> Cell:
    return (p[0] + q[0], p[1] + q[1], p[2] + q[2])


def unit_edges(squares: Iterable[Square]) -> set[frozenset[Cell]]:
    pairs = (frozenset(pair) for square in squares for pair in combinations(square, 2))
    return {pair for pair in pairs if sum(abs(p - q) for p, q in zip(*pair, strict=True)) == 1}


class Shared(NamedTuple):
    """What two boundaries have in common: a complex of squares, edges and points of the lattice."""

    opposed: int
    agreeing: int
    edges: int
    points: int


def shared(a: VoxelSolid, b: VoxelSolid) -> Shared:
    in_a, in_b = unit_squares(a), unit_squares(b)
    squares = in_a.keys() & in_b.keys()
    facing = [s == t for square in squares for s in in_a[square] for t in in_b[square]]
    edges = (unit_edges(in_a) & unit_edges(in_b)) - unit_edges(squares)
    points = a.surface_points() & b.surface_points()
    covered = {p for cell in (*squares, *edges) for p in cell}
    return Shared(facing.count(False), facing.count(True), len(edges), len(points - covered))


def test_lattice_solids_against_what_they_share() -> None:
    seen = Counter[str]()
    for seed in range(300):
        a, b = random_pair(seed)
        found = meet(a.mesh(seed=seed), b.mesh(seed=seed + 1))
        truth = shared(a, b)
        opposed, agreeing = (
            math.fsum(p.area for p in found.patches if p.opposed == side) for side in (True, False)
        )
        length = math.fsum(c.length for c in found.curves)
        assert (opposed, agreeing, length, len(found.points)) == truth, seed
        seen.update(name for name, count in truth._asdict().items() if count)
    assert all(seen[name] > 5 for name in Shared._fields), seen


@pytest.mark.parametrize("seed", range(40))
def test_the_triangles_of_a_flat_face_leave_no_trace(seed: int) -> None:
    a, b = random_pair(seed)
    one = meet(a.mesh(SHEAR, 1), b.mesh(SHEAR, 2))
    other = meet(a.mesh(SHEAR, 3), b.mesh(SHEAR, 4))
    assert shape_of(one) == shape_of(other)


def test_boxes_that_cross() -> None:
    found = meet(CUBE.mesh(), CUBE.mesh().translated((2.5, 1.0, 0.5)))
    (loop,) = found.curves
    assert loop.closed
    assert len(loop.points) == 6
    assert loop.length == 2 * (1.5 + 3.0 + 3.5)
    assert not found.patches
    assert not found.points


def test_boxes_face_to_face() -> None:
    found = meet(CUBE.mesh(), CUBE.mesh().translated((4.0, 1.0, 0.5)))
    (patch,) = found.patches
    corners = [(4.0, 1.0, 0.5), (4.0, 4.0, 0.5), (4.0, 4.0, 4.0), (4.0, 1.0, 4.0)]
    assert patch.outlines == [corners]
    assert (patch.normal, patch.opposed, patch.area) == ((1.0, 0.0, 0.0), True, 10.5)
    assert not found.curves
    assert not found.points


def test_a_patch_with_a_hole() -> None:
    """A hollow block cut open, on a plate."""
    cells = frozenset(cell for cell in HOLLOW.cells if cell[2] >= 1)
    plate = VoxelSolid(frozenset((i, j, 0) for i in range(-1, 6) for j in range(-1, 6)))
    (patch,) = meet(plate.mesh(), VoxelSolid(cells).mesh()).patches
    assert patch.area == 25 - 9
    assert [len(outline) for outline in patch.outlines] == [4, 4]
    assert patch.outlines[0][0] == (0.0, 0.0, 1.0)
    assert patch.outlines[1][0] == (1.0, 1.0, 1.0)
    assert patch.normal == (0.0, 0.0, 1.0)


def test_edges_and_corners() -> None:
    edge = meet(SMALL.mesh(), moved(SMALL, 2, 2, 0).mesh())
    assert [c.points for c in edge.curves] == [[(2.0, 2.0, 0.0), (2.0, 2.0, 2.0)]]
    assert not edge.curves[0].closed
    assert (edge.patches, edge.points) == ([], [])
    corner = meet(SMALL.mesh(), moved(SMALL, 2, 2, 2).mesh())
    assert (corner.curves, corner.patches) == ([], [])
    assert corner.points == [(2.0, 2.0, 2.0)]


def test_nothing_where_nothing_meets() -> None:
    for b in (moved(CELL, 9, 9, 9), moved(CELL, 1, 1, 1)):  # outside, inside
        found = meet(CUBE.mesh(), b.mesh())
        assert shape_of(found) == ([], [], [])
        assert found.triangle_pairs == []


def test_a_solid_meets_itself_in_all_its_faces() -> None:
    mesh = HOLLOW.mesh(SHEAR)
    found = meet(mesh, mesh)
    assert len(found.patches) == 12  # flat faces, diagonals gone
    assert not any(patch.opposed for patch in found.patches)
    corners = (np.array(mesh.corners(t)) for t in range(mesh.triangle_count))
    truth = math.fsum(np.linalg.norm(np.cross(c[1] - c[0], c[2] - c[0])) / 2 for c in corners)
    assert math.fsum(p.area for p in found.patches) == pytest.approx(truth, rel=1e-14)
    assert not found.curves


def turned(seed: int) -> np.ndarray:
    matrix = trimesh.transformations.random_rotation_matrix(np.random.default_rng(seed).random(3))
    return np.asarray(matrix)


@pytest.mark.parametrize("seed", range(12))
def test_closed_solids_in_general_position_meet_in_loops(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shapes = [
        trimesh.creation.torus(1.0, 0.4, major_sections=13, minor_sections=7),
        trimesh.creation.cylinder(0.5, 3.0, sections=5 + seed),
    ]
    for shape in shapes:
        shape.apply_transform(turned(int(rng.integers(1000))))
        shape.apply_translation(rng.random(3) / 2)
    found = meet(*map(of_trimesh, shapes))
    assert found.curves
    assert all(curve.closed for curve in found.curves)
    assert not found.patches
    assert not found.points
    assert on_both(found.curves[0].points, *shapes) < 1e-12


def on_both(points: Iterable[Point], *shapes: trimesh.Trimesh) -> float:
    """The largest distance of one of the points from one of the surfaces."""
    listed = np.array(list(points))
    naive = trimesh.proximity.closest_point_naive
    return max(float(naive(s, listed)[1].max()) for s in shapes)  # type: ignore[no-untyped-call]


@pytest.mark.parametrize("height", [0.0, 0.3, -0.55])
def test_a_ball_on_a_block_is_cut_as_by_a_plane(height: float) -> None:
    ball = trimesh.creation.icosphere(subdivisions=3)
    ball.apply_transform(turned(5))
    block = trimesh.creation.box(bounds=np.array([[-9, -9, -9], [9, 9, height]]))
    (loop,) = meet(of_trimesh(ball), of_trimesh(block)).curves
    section = ball.section(plane_origin=[0, 0, height], plane_normal=[0, 0, 1])
    assert loop.closed
    assert loop.length == pytest.approx(section.length, rel=1e-9)


def test_the_curve_of_two_balls_converges_to_a_circle() -> None:
    circle = 2 * math.pi * SQRT3 / 2  # unit balls, centres 1 apart
    errors = []
    for subdivisions in (2, 3, 4):
        balls = [trimesh.creation.icosphere(subdivisions=subdivisions) for _ in range(2)]
        balls[1].apply_transform(turned(3))
        balls[1].apply_translation((1.0, 0.0, 0.0))
        (loop,) = meet(*map(of_trimesh, balls)).curves
        assert loop.closed
        errors.append(circle - loop.length)
    # Chords of triangles half as wide miss a quarter as much.
    assert errors[0] > 3 * errors[1] > 9 * errors[2] > 0


def test_open_surfaces_meet_too() -> None:
    square = sheet([(0, 0, 0), (4, 0, 0), (4, 4, 0)], [(0, 0, 0), (4, 4, 0), (0, 4, 0)])
    wall = sheet([(1, 1, -1), (3, 1, -1), (3, 1, 1)], [(1, 1, -1), (3, 1, 1), (1, 1, 1)])
    (curve,) = meet(square, wall).curves
    assert (curve.closed, curve.points) == (False, [(1.0, 1.0, 0.0), (3.0, 1.0, 0.0)])


def test_curves_end_where_they_branch() -> None:
    hinge = [(0, 0, -1), (0, 0, 1)]
    fan = sheet(*([*hinge, end] for end in ((2, 0, 0), (-2, 1, 0), (-2, -1, 0))))
    found = meet(fan, sheet([(-9, -9, 0), (9, -9, 0), (0, 9, 0)]))
    assert len(found.curves) == 3
    assert all((0.0, 0.0, 0.0) in (c.points[0], c.points[-1]) for c in found.curves)


def test_a_sliver_without_area_does_not_break_the_curve() -> None:
    """The top edge of a roof is split on one slope only; a collinear triangle fills the gap."""
    left = [[(0, 0, 0), (4, 0, 0), (4, 2, 2)], [(0, 0, 0), (4, 2, 2), (0, 2, 2)]]
    right = [[(0, 4, 0), (0, 2, 2), (1, 2, 2)], [(0, 4, 0), (1, 2, 2), (4, 2, 2)]]
    sliver = [(0, 2, 2), (4, 2, 2), (1, 2, 2)]
    roof = sheet(*left, *right, [(0, 4, 0), (4, 2, 2), (4, 4, 0)], sliver)
    wall = sheet([(2.5, -9, -9), (2.5, 30, -9), (2.5, -9, 30)])
    (curve,) = meet(roof, wall).curves
    assert curve.points == [(2.5, 0.0, 0.0), (2.5, 2.0, 2.0), (2.5, 4.0, 0.0)]


def with_slivers(mesh: Mesh, rng: random.Random, count: int) -> Mesh:
    """Splits one of the two triangles at an edge, and closes the gap without area, so many times.

    Slivers are split too. Midpoints are exact: lattice points have few bits.
    """
    soup = [mesh.corners(t) for t in range(mesh.triangle_count)]
    for _ in range(count):
        k, turn = rng.randrange(len(soup)), rng.randrange(3)
        u, v, x = (soup[k][(turn + i) % 3] for i in range(3))
        m = ((u[0] + v[0]) / 2, (u[1] + v[1]) / 2, (u[2] + v[2]) / 2)
        soup[k : k + 1] = [(u, m, x), (m, v, x), (u, v, m)]
    return mesh_of_soup(corner for triangle in soup for corner in triangle)


def test_slivers_leave_no_trace() -> None:
    """A split sliver may be split so that its halves overlap; all that goes too."""
    for seed in range(60):
        a, b = random_pair(seed)
        rng = random.Random(seed)
        plain = meet(a.mesh(seed=seed), b.mesh(seed=seed + 1))
        split = meet(
            with_slivers(a.mesh(seed=seed), rng, 12), with_slivers(b.mesh(seed=seed + 1), rng, 12)
        )
        assert shape_of(plain) == shape_of(split), seed


def test_too_many_pairs_are_not_listed() -> None:
    a = Surface(CUBE.mesh(), True)
    found = surface_intersection(a, a, 10)
    assert not found.complete
    assert (found.curves, found.patches, found.points, found.triangle_pairs) == ([], [], [], [])
