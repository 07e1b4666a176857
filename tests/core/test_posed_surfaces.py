"""Concave bodies in many poses: what is called apart or deep is so, by the meshes in the world."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from satcheck import core
from satcheck.core.transform import Transform, about_fixed_axes, placed
from tests.core.voxel_solids import VoxelSolid, box

OPEN, APART, DEEP, UNDECIDED = 0, 1, 2, 3
OVERLAPS = {"penetrating", "contains", "inside", "coincident"}
STILL = placed((1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0), (0.0, 0.0, 0.0))


def solid(*parts: VoxelSolid, without: VoxelSolid | None = None) -> core.Mesh:
    cells = frozenset[tuple[int, int, int]]().union(*(part.unit_cells() for part in parts))
    return VoxelSolid(cells - (without.unit_cells() if without else frozenset())).mesh()


CUBE = solid(box((0, 0, 0), (1, 1, 1)))
L_SHAPE = solid(box((0, 0, 0), (3, 1, 1)), box((0, 0, 0), (1, 3, 1)))
STAIRS = solid(*(box((i, 0, 0), (i + 1, 2, i + 1)) for i in range(4)))
COMB = solid(box((0, 0, 0), (7, 1, 1)), *(box((i, 0, 0), (i + 1, 3, 1)) for i in (0, 2, 4, 6)))
PLATE = solid(box((0, 0, 0), (3, 3, 1)), without=box((1, 1, 0), (2, 2, 1)))
HOLLOW = solid(box((0, 0, 0), (5, 5, 5)), without=box((1, 1, 1), (4, 4, 4)))
ORIGIN = np.flatnonzero((np.asarray(CUBE.vertices) == 0).all(axis=1)).item()
# The cube without the faces at a corner.
CUP = core.Mesh(
    np.asarray(CUBE.vertices),
    np.asarray(CUBE.triangles)[(np.asarray(CUBE.triangles) != ORIGIN).all(axis=1)],
)
BODIES = (CUBE, L_SHAPE, STAIRS, COMB, PLATE, HOLLOW)


def opened(mesh: core.Mesh) -> core.Mesh:
    """The mesh without its first triangle."""
    return core.Mesh(np.asarray(mesh.vertices), np.asarray(mesh.triangles)[1:])


def body_of(mesh: core.Mesh) -> core.PosedBody:
    return core.PosedBody(core.Geometry(mesh, mesh.topology().solid))


def sort(
    a: core.Mesh, at_a: Transform, b: core.Mesh, at_b: Transform, gap: float, depth: float
) -> int:
    """By the surfaces alone: no ball proves anything."""
    pairs = [(0, 1, gap, math.inf, depth)]
    codes, _ = core.sift([body_of(a), body_of(b)], pairs, np.array([[at_a[:12], at_b[:12]]]), 1)
    return int(codes[0, 0])


def in_world(mesh: core.Mesh, at: Transform) -> core.Surface:
    moved = mesh.transformed(at)
    return core.Surface(moved, mesh.topology().solid)


def moved_by(at: Transform, x: float, y: float, z: float) -> Transform:
    step = {3: x, 7: y, 11: z}
    return tuple(c + step.get(k, 0.0) for k, c in enumerate(at))


def turned(draw: random.Random, size: float, far: float) -> Transform:
    angles = [(math.cos(t), math.sin(t)) for t in (draw.uniform(-3, 3) for _ in range(3))]
    rows = [c * size for c in about_fixed_axes(*angles)]
    x, y, z = (draw.uniform(-2, 2) * size + far for _ in range(3))
    return placed(rows, (x, y, z))


@pytest.mark.parametrize("opening", [False, True])
@pytest.mark.parametrize(("size", "far"), [(1.0, 0.0), (1e-9, 0.0), (1e9, 0.0), (1.0, 1e6)])
def test_random_poses_agree_with_the_exact_relation(opening: bool, size: float, far: float) -> None:
    draw = random.Random(repr((opening, size, far)))
    seen: dict[int, int] = dict.fromkeys((OPEN, APART, DEEP, UNDECIDED), 0)
    for _ in range(400):
        a, b = draw.choice(BODIES), draw.choice(BODIES)
        at_a, at_b = turned(draw, size, far), turned(draw, size, far)
        gap, depth = (draw.choice((0.0, 1e-6, 0.1)) * size for _ in range(2))
        a = opened(a) if opening else a
        code = sort(a, at_a, b, at_b, gap, depth)
        seen[code] += 1
        first, second = in_world(a, at_a), in_world(b, at_b)
        if code == APART:
            assert core.mesh_relation(first, second).relation == "separated"
            assert core.compare_gap(first, second, gap) == 1
        if code == DEEP:
            for _ in range(5):
                x, y, z = (draw.gauss(0, 1) for _ in range(3))
                step = depth * (1 - 1e-9) / math.hypot(x, y, z)
                way = moved_by(at_a, x * step, y * step, z * step)
                assert core.mesh_relation(in_world(a, way), second).relation in OVERLAPS
    assert seen[DEEP] > 100
    assert seen[APART] > 20
    assert seen[OPEN] > 0


def test_a_block_in_the_notch_of_an_angle() -> None:
    """Its gap, or its depth, is the limit but for a few roundings. The hulls always meet."""
    draw, seen = random.Random(4), set()
    c, s = math.cos(0.5), math.sin(0.5)
    for k in range(400):
        limit, sign = draw.choice((0.0, 1e-6, 0.01)), draw.choice((1, -1))
        gap = sign * (limit + draw.choice((1, -1)) * 2.0 ** -draw.uniform(2, 53) * 0.2)
        turn = (0.5 * c, 0.0, 0.5 * s, 0.0, 0.5, 0.0, -0.5 * s, 0.0, 0.5 * c)
        at = placed(turn, (1.8, 1.0 + gap, 0.5))
        code = sort(L_SHAPE, STILL, CUBE, at, limit, limit)
        seen.add(code)
        block = CUBE.transformed(at)
        height = min(block.vertex(v)[1] for v in range(8)) - 1.0  # exact: both are near 1
        assert code != APART or height > limit, k
        assert code != DEEP or -height > limit, k
    assert seen == {OPEN, APART, DEEP}


def test_closed_bodies_that_cross_are_deep_by_a_point_beside_the_crossing() -> None:
    """Thin combs: no ball inside is large, and their hulls mostly meet outside of both."""
    thin = tuple(0.02 * c if k == 10 else c for k, c in enumerate(STILL))
    comb = COMB.transformed(thin)
    body, draw = body_of(comb), random.Random(6)
    tolerance, seen = 1e-6, []
    for _ in range(300):
        at, other = turned(draw, 1.0, 0.0), turned(draw, 1.0, 0.0)
        matrices = np.array([[at[:12], other[:12]]])
        pairs = [(0, 1, tolerance, 0.5 * tolerance, math.inf)]
        code = int(core.sift([body, body], pairs, matrices, 1)[0][0, 0])
        relation = core.mesh_relation(in_world(comb, at), in_world(comb, other)).relation
        assert code == (DEEP if relation in OVERLAPS else APART)
        seen.append(code)
    assert seen.count(DEEP) > 40


def test_a_body_in_the_material_is_not_apart_and_one_in_the_cavity_is() -> None:
    tenth = tuple(0.1 * c if k % 5 == 0 and k < 12 else c for k, c in enumerate(STILL))
    in_wall, in_cavity = moved_by(tenth, 2.0, 2.0, 0.45), moved_by(tenth, 2.0, 2.0, 2.0)
    through = moved_by(tenth, 2.03, 2.04, 0.95)
    for inner in (CUBE, opened(CUBE)):  # 0.45 from the surface
        assert sort(HOLLOW, STILL, inner, in_wall, 0.4, 0.4) == DEEP
        assert sort(inner, in_wall, HOLLOW, STILL, 0.4, 0.4) == DEEP
        assert sort(HOLLOW, STILL, inner, in_wall, 0.5, 0.5) == OPEN
        assert sort(HOLLOW, STILL, inner, in_wall, 0.0, 0.1) == OPEN
        assert sort(HOLLOW, STILL, inner, in_wall, 0.0, math.inf) == OPEN
    assert sort(HOLLOW, STILL, CUBE, in_cavity, 0.5, 0.0) == APART
    assert sort(CUBE, in_cavity, HOLLOW, STILL, 0.5, 0.0) == APART
    assert sort(HOLLOW, STILL, CUBE, through, 0.0, 0.0) != APART


def test_holes_may_be_filled() -> None:
    """A body in the hull of the rim of the cup is undecided, and beyond the rim it is in the
    material."""
    tenth = tuple(0.1 * c if k in (0, 5, 10) else c for k, c in enumerate(STILL))
    for at, code in ((0.45, UNDECIDED), (0.85, OPEN), (0.1, APART)):
        there = moved_by(tenth, at, at, at)
        assert sort(CUP, STILL, CUBE, there, 0.0, 0.0) == code
        assert sort(CUBE, there, CUP, STILL, 0.0, 0.0) == code


def beside(at: Transform, point: tuple[float, float, float], linear: Transform) -> Transform:
    """A placement that takes the origin to where `at` takes the point."""
    x, y, z = (
        sum(at[4 * row + k] * point[k] for k in range(3)) + at[4 * row + 3] for row in range(3)
    )
    step = {3: x, 7: y, 11: z}
    return tuple(step.get(k, c) for k, c in enumerate(linear))


@pytest.mark.parametrize(("size", "far"), [(1.0, 0.0), (1e-9, 0.0), (1e9, 0.0), (1.0, 1e6)])
def test_what_the_fill_of_a_hole_decides_is_so_in_the_world(size: float, far: float) -> None:
    """Small bodies within the hulls of cups, and at their edges."""
    draw, seen = random.Random(repr((size, far))), []
    for _ in range(300):
        b = draw.choice((*BODIES, CUP, opened(COMB)))
        at_a, turn = turned(draw, size, far), turned(draw, 0.1 * size, 0.0)
        x, y, z = (draw.uniform(-0.2, 1) for _ in range(3))
        pair = [(CUP, at_a), (b, beside(at_a, (x, y, z), turn))]
        draw.shuffle(pair)
        (a, at_a), (b, at_b) = pair
        code = sort(a, at_a, b, at_b, draw.choice((0.0, 1e-6)) * size, math.inf)
        hole = core.mesh_relation(in_world(a, at_a), in_world(b, at_b)).hole
        seen.append((code, hole is not None))
    assert (UNDECIDED, False) not in seen
    assert seen.count((UNDECIDED, True)) > 40
    assert seen.count((OPEN, True)) < 0.1 * seen.count((UNDECIDED, True))


def test_a_hole_that_rounding_closes_decides_nothing() -> None:
    """A cube in two pieces, 1e-12 apart. Far from the origin rounding joins them."""
    corners, triangles = np.asarray(CUBE.vertices), np.asarray(CUBE.triangles)
    of_lid = (triangles == ORIGIN).any(axis=1)
    vertices = np.vstack((corners, corners + 1e-12))
    split = core.Mesh(vertices, np.where(of_lid[:, None], triangles + len(corners), triangles))
    tenth = tuple(0.1 * c if k in (0, 5, 10) else c for k, c in enumerate(STILL))
    for far, code in ((0.0, UNDECIDED), (1e6, OPEN)):
        at = moved_by(STILL, far, far, far)
        there = beside(at, (0.45, 0.45, 0.45), tenth)
        assert sort(split, at, CUBE, there, 0.0, math.inf) == code
        hole = core.mesh_relation(in_world(split, at), in_world(CUBE, there)).hole
        assert (hole is not None) == (code == UNDECIDED)


def test_what_no_fill_meets_is_apart_and_what_crosses_is_deep() -> None:
    tenth = tuple(0.1 * c if k in (0, 5, 10) else c for k, c in enumerate(STILL))
    assert sort(opened(HOLLOW), STILL, CUBE, moved_by(tenth, 2, 2, 2), 0.0, 0.0) == APART
    draw = random.Random(3)
    poses = [moved_by(turned(draw, 1.0, 0.0), 2.5, 2.5, 2.5) for _ in range(50)]
    codes = {sort(opened(HOLLOW), STILL, COMB, at, 0.0, 0.0) for at in poses}
    assert codes == {DEEP}


def test_placements_that_mirror_stretch_or_collapse() -> None:
    draw, seen = random.Random(8), set()
    for _ in range(300):
        factors = [draw.choice((-1, 1)) * 2.0 ** draw.randint(-3, 3) for _ in range(3)]
        base = turned(draw, 1.0, 0.0)
        at = tuple(c * (factors[k % 4] if k % 4 < 3 and k < 12 else 1) for k, c in enumerate(base))
        other = turned(draw, 1.0, 0.0)
        code = sort(L_SHAPE, at, STAIRS, other, 1e-3, 1e-3)
        seen.add(code)
        relation = core.mesh_relation(in_world(L_SHAPE, at), in_world(STAIRS, other)).relation
        assert code != APART or relation == "separated"
        assert code != DEEP or relation in OVERLAPS
    assert seen >= {APART, DEEP}
    flat = tuple(0.0 if k in (8, 9, 10) else c for k, c in enumerate(STILL))
    assert sort(L_SHAPE, flat, STAIRS, STILL, 0.0, 0.0) == OPEN
