"""What placed bodies share of their mesh, against the same made anew from the placed mesh."""

from __future__ import annotations

import random

import numpy as np
import pytest

from satcheck.core import (
    Geometry,
    Hull,
    Mesh,
    PairResult,
    PlacedGeometry,
    Shape,
    Surface,
    check_pair,
    mesh_relation,
    placed_bounds,
)

Matrix = tuple[float, ...]
IDENTITY: Matrix = (1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0)


def bumpy_ball(seed: int, bumps: float = 0.3, rings: int = 9, sectors: int = 12) -> Mesh:
    """Closed, star-shaped; convex in places only. With bumps 0 all vertices are near the hull."""
    rng = np.random.default_rng(seed)
    around = 2 * np.pi * np.arange(sectors) / sectors
    down = np.pi * np.arange(1, rings) / rings
    radius = 1 + bumps * rng.uniform(-1, 1, (len(down), sectors))
    ring = np.stack(
        [
            np.sin(down)[:, None] * np.cos(around),
            np.sin(down)[:, None] * np.sin(around),
            np.cos(down)[:, None] * np.ones(sectors),
        ],
        axis=-1,
    )
    vertices = [*(radius[..., None] * ring).reshape(-1, 3), [0, 0, 1.0], [0, 0, -1.0]]
    top, bottom = len(vertices) - 2, len(vertices) - 1
    faces = []
    for s in range(sectors):
        t = (s + 1) % sectors
        faces += [(top, s, t), (bottom, (rings - 2) * sectors + t, (rings - 2) * sectors + s)]
        for r in range(rings - 2):
            a, b, c, d = (
                r * sectors + s,
                r * sectors + t,
                (r + 1) * sectors + s,
                (r + 1) * sectors + t,
            )
            faces += [(a, c, b), (b, c, d)]
    return Mesh(np.array(vertices), np.array(faces, dtype=np.int64))


def matrices(seed: int, count: int) -> list[Matrix]:
    """Turned, stretched, sheared and mirrored; near and far; some along the axes, some exact."""
    source = random.Random(seed)
    found: list[Matrix] = [IDENTITY, (-1.0, 0, 0, 5, 0, 2.0, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1.0)]
    while len(found) < count:
        scale, far = 10 ** source.uniform(-3, 3), 10 ** source.uniform(-3, 6)
        entries = [scale * source.gauss(0, 1) for _ in range(9)]
        places = [far * source.gauss(0, 1) for _ in range(3)]
        rows = [[*entries[3 * k : 3 * k + 3], places[k]] for k in range(3)]
        found.append((*rows[0], *rows[1], *rows[2], 0.0, 0.0, 0.0, 1.0))
    return found


def test_bounds_are_those_of_the_placed_mesh() -> None:
    meshes = [bumpy_ball(k, bumps) for k, bumps in enumerate((0.3, 0.0, 0.01))]
    asked = [(mesh, matrix) for mesh in meshes for matrix in matrices(7, 60)]
    found = placed_bounds([mesh for mesh, _ in asked], [matrix for _, matrix in asked])
    assert found == [mesh.transformed(matrix).bounds for mesh, matrix in asked]


def scaled(factor: float, move: float = 0.0) -> Matrix:
    return (factor, 0, 0, move, 0, factor, 0, 0, 0, 0, factor, 0, 0, 0, 0, 1.0)


@pytest.mark.parametrize(
    "matrix",
    [
        scaled(1e46),
        scaled(1e44),
        scaled(1e-46),
        scaled(1e-44),
        scaled(1e-60, 1e-60),
        scaled(1.0, 1e45),
        scaled(0.0),
        scaled(1.0, float("nan")),
        (*scaled(1.0)[:15], 2.0),
        (1.0, 0, 0, -0.4, 0, 1.0, 0, 0, 0, 0, 1.0, 1e-85, 0, 0, 0, 1.0),
    ],
)
def test_no_bounds_where_the_mesh_cannot_be_placed(matrix: Matrix) -> None:
    mesh = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), np.array([[0, 2, 1]]))
    (found,) = placed_bounds([mesh], [matrix])
    try:
        expected = mesh.transformed(matrix).bounds
    except (ValueError, OverflowError):
        expected = None
    assert found == expected


def test_bounds_are_the_same_on_any_number_of_threads() -> None:
    meshes, places = [bumpy_ball(1)] * 500, matrices(3, 500)
    assert placed_bounds(meshes, places, 1) == placed_bounds(meshes, places, 3)
    with pytest.raises(ValueError, match="differ in number"):
        placed_bounds(meshes, places[1:])


def test_a_refitted_surface_gives_the_answers_of_a_new_one() -> None:
    mesh = bumpy_ball(2)
    known = Surface(mesh, True)
    relations = set()
    for matrix in matrices(5, 80):
        placed = mesh.transformed(matrix)
        refitted, new = known.refit(placed), Surface(placed, True)
        assert refitted.refitted
        assert refitted.solid
        assert np.array_equal(refitted.mesh.vertices, new.mesh.vertices)
        assert np.array_equal(refitted.mesh.triangles, new.mesh.triangles)
        low, high = np.array(placed.bounds)
        size = float(np.max(high - low))
        for point in np.random.default_rng(1).uniform(low - 0.1 * size, high + 0.1 * size, (20, 3)):
            at = (float(point[0]), float(point[1]), float(point[2]))
            assert refitted.winding_number(at) == new.winding_number(at)
            assert refitted.nearest(at)[0] == new.nearest(at)[0]
        for share in (0.05, 0.4, 0.9, 2.5):
            other = Surface(placed.translated((share * size, 0.0, 0.0)), True)
            found = mesh_relation(refitted, other)
            expected = mesh_relation(new, other)
            assert (found.relation, found.proven) == (expected.relation, expected.proven)
            relations.add(found.relation)
    assert relations == {"penetrating", "separated"}


def test_parts_of_a_refitted_surface_are_where_it_is() -> None:
    """Two balls in one mesh, one of which holds a third body."""
    ball = bumpy_ball(3)
    vertices = np.concatenate([ball.vertices, ball.vertices + np.array([10.0, 0, 0])])
    triangles = np.concatenate([ball.triangles, ball.triangles + ball.vertex_count]).astype(
        np.int64
    )
    known = Surface(Mesh(vertices, triangles), True)
    place = (0.0, -2.0, 0, 5, 2.0, 0, 0, -7, 0, 0, 2.0, 1, 0, 0, 0, 1.0)
    refitted = known.refit(known.mesh.transformed(place))
    seed = (
        bumpy_ball(4)
        .transformed(scaled(0.1))
        .transformed((1.0, 0, 0, 5, 0, 1.0, 0, 13, 0, 0, 1.0, 1, 0, 0, 0, 1.0))
    )
    assert mesh_relation(refitted, Surface(seed, True)).relation == "contains"


def test_vertices_that_rounding_brings_together_are_welded() -> None:
    """Far away the two ends of a short edge are one point: another topology, another tree."""
    mesh = bumpy_ball(5)
    away = 2.0**52
    far = mesh.transformed((1.0, 0, 0, away, 0, 1.0, 0, away, 0, 0, 1.0, away, 0, 0, 0, 1.0))
    surface = Surface(mesh, True).refit(far)
    assert not surface.refitted
    assert surface.mesh.vertex_count < mesh.vertex_count


def test_a_translated_surface_gives_the_answers_of_a_new_one() -> None:
    mesh, other = bumpy_ball(7), Surface(bumpy_ball(8), True)
    low, high = mesh.bounds
    for share in (0.0, 0.3, 0.9, 2.5):
        offset = (share * (high[0] - low[0]), 0.0, 0.1)
        moved, new = Surface(mesh, True).translated(offset), Surface(mesh.translated(offset), True)
        assert np.array_equal(moved.mesh.vertices, new.mesh.vertices)
        assert mesh_relation(moved, other).relation == mesh_relation(new, other).relation
    far = Surface(mesh, True).translated((2.0**52,) * 3)
    assert far.mesh.vertex_count < mesh.vertex_count  # rounding has merged points


def test_another_mesh_is_not_refitted() -> None:
    a, b = bumpy_ball(6), bumpy_ball(6, sectors=13)
    surface = Surface(a, True).refit(b)
    assert not surface.refitted
    assert surface.mesh.triangle_count == b.triangle_count


def bounds_of(found: PairResult) -> tuple[float, float]:
    assert found.lower is not None
    assert found.upper is not None
    return found.lower, found.upper


def placed_hull(mesh: Mesh, matrix: Matrix) -> Shape:
    return PlacedGeometry(Geometry(mesh, False), matrix, None, 0.0).hull_shape()


@pytest.mark.parametrize("bumps", [0.3, 0.01, 0.0])
def test_a_placed_hull_is_the_hull_of_the_placed_mesh(bumps: float) -> None:
    mesh = bumpy_ball(8, bumps)
    probe = Hull([(0.0, 0, 0), (1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0)])
    asked = 0
    for matrix in matrices(9, 60):
        placed = placed_hull(mesh, matrix)
        expected = Hull(mesh.transformed(matrix).convex_hull())
        low, high = np.array(mesh.transformed(matrix).bounds)
        for corner in (low, high, 0.5 * (low + high), high + 0.3 * (high - low)):
            pose = (float(corner[0]), float(corner[1]), float(corner[2]))
            found = check_pair(placed, probe, None, pose)
            wanted = check_pair(expected, probe, None, pose)
            assert found.outcome == wanted.outcome
            assert bounds_of(found)[0] <= bounds_of(wanted)[1]
            assert bounds_of(wanted)[0] <= bounds_of(found)[1]
            asked += 1
    assert asked > 100


def test_touching_placed_hulls_touch_exactly() -> None:
    """The exact stage computes the faces that the support points leave out."""
    cube = Mesh(
        np.array([[x, y, z] for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)]),
        np.array([[0, 1, 3]]),
    )
    here = placed_hull(cube, scaled(0.5))
    outcomes = [
        check_pair(here, placed_hull(cube, scaled(0.5, move))).outcome
        for move in (0.5, 0.5 + 2.0**-52, 0.5 - 2.0**-53)
    ]
    assert outcomes == ["touching", "separated", "penetrating"]
    beside = placed_hull(cube, scaled(0.5, 0.5))
    assert check_pair(here, beside, method="sat").outcome == "touching"


def test_inner_vertices_are_left_out() -> None:
    ring = bumpy_ball(10, 0.3)
    assert placed_hull(ring, scaled(2.0)).vertex_count < ring.vertex_count
    ball = bumpy_ball(10, 0.0)
    assert placed_hull(ball, scaled(2.0)).vertex_count == ball.vertex_count


def test_a_hull_that_rounding_could_turn_inside_out_is_that_of_the_placed_mesh() -> None:
    ball, far = bumpy_ball(11), scaled(1.0, 1e12)
    expected = Hull(ball.transformed(far).convex_hull())
    assert placed_hull(ball, far).vertex_count == expected.vertex_count
    flat = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    assert placed_hull(flat, IDENTITY).dimension == 2
    with pytest.raises(ValueError, match="singular"):
        placed_hull(ball, scaled(0.0))
