"""The exact relation of two meshes, above all where every contact is degenerate."""

from __future__ import annotations

import random

import pytest

from satcheck.core import Mesh, MeshRelation, Surface, mesh_relation
from tests.core.voxel_solids import (
    IDENTITY,
    SHEAR,
    Cell,
    Matrix,
    VoxelSolid,
    box,
    mesh_of_soup,
    true_relation,
)

MIRRORED = {"contains": "inside", "inside": "contains"}


def relate(a: Mesh, b: Mesh) -> MeshRelation:
    """The relation both ways round; they must mirror each other."""
    sa, sb = (Surface(m, m.topology().solid) for m in (a, b))
    result, reverse = mesh_relation(sa, sb), mesh_relation(sb, sa)
    assert reverse.relation == MIRRORED.get(result.relation, result.relation)
    return result


def union(*solids: VoxelSolid) -> VoxelSolid:
    return VoxelSolid(frozenset().union(*(s.unit_cells() for s in solids)))


def minus(a: VoxelSolid, b: VoxelSolid) -> VoxelSolid:
    return VoxelSolid(a.unit_cells() - b.unit_cells())


L_SHAPE = union(box((0, 0, 0), (3, 1, 1)), box((0, 0, 0), (1, 3, 1)))
STAIRS = union(*(box((i, 0, 0), (i + 1, 2, i + 1)) for i in range(4)))
PLATE_WITH_HOLE = minus(box((0, 0, 0), (3, 3, 1)), box((1, 1, 0), (2, 2, 1)))
COMB = union(box((0, 0, 0), (7, 1, 1)), *(box((i, 0, 0), (i + 1, 3, 1)) for i in (0, 2, 4, 6)))
HOLLOW = minus(box((0, 0, 0), (5, 5, 5)), box((1, 1, 1), (4, 4, 4)))


def moved(solid: VoxelSolid, x: int, y: int, z: int) -> VoxelSolid:
    return VoxelSolid(solid.cells, solid.size, (x, y, z))


FLIPPED_COMB = VoxelSolid(frozenset((i, 4 - j, k) for i, j, k in COMB.cells))
CUBE = box((0, 0, 0), (4, 4, 4))
SMALL = box((0, 0, 0), (2, 2, 2))
CELL = box((0, 0, 0), (1, 1, 1))

NAMED = {
    "boxes shifted along one axis": (SMALL, moved(SMALL, 1, 0, 0), "penetrating"),
    "half embedded, flush sides": (CUBE, box((1, 0, 0), (2, 5, 4)), "penetrating"),
    "cross of two bars": (box((0, 1, 0), (3, 2, 1)), box((1, 0, 0), (2, 3, 1)), "penetrating"),
    "boxes share a face": (SMALL, moved(SMALL, 2, 0, 0), "touching"),
    "boxes share part of a face": (CUBE, moved(CELL, 4, 1, 1), "touching"),
    "boxes share an edge": (SMALL, moved(SMALL, 2, 2, 0), "touching"),
    "boxes share a corner": (SMALL, moved(SMALL, 2, 2, 2), "touching"),
    "box in the corner of a box": (CUBE, SMALL, "penetrating"),
    "box in the middle of a face": (CUBE, moved(SMALL, 1, 1, 2), "penetrating"),
    "box inside": (CUBE, moved(SMALL, 1, 1, 1), "contains"),
    "stacked L shapes": (L_SHAPE, moved(L_SHAPE, 0, 0, 1), "touching"),
    "L shapes shifted along an arm": (L_SHAPE, moved(L_SHAPE, 1, 0, 0), "penetrating"),
    "L shapes nested diagonally": (L_SHAPE, moved(L_SHAPE, 1, 1, 0), "touching"),
    "stairs on stairs": (STAIRS, moved(STAIRS, 0, 0, 1), "penetrating"),
    "stairs shifted up": (STAIRS, moved(STAIRS, 1, 0, 1), "penetrating"),
    "peg fills a hole": (PLATE_WITH_HOLE, moved(CELL, 1, 1, 0), "touching"),
    "long peg fills a hole": (PLATE_WITH_HOLE, box((1, 1, -1), (2, 2, 2)), "touching"),
    "peg too wide by a cell": (PLATE_WITH_HOLE, box((1, 1, 0), (3, 2, 1)), "penetrating"),
    "combs in mesh": (COMB, moved(FLIPPED_COMB, 1, 0, 0), "touching"),
    "combs one tooth off": (COMB, FLIPPED_COMB, "penetrating"),
    "body in a cavity": (HOLLOW, moved(CELL, 2, 2, 2), "separated"),
    "body fills a cavity": (HOLLOW, box((1, 1, 1), (4, 4, 4)), "touching"),
    "body fills a cavity and more": (HOLLOW, box((1, 1, 1), (4, 4, 5)), "penetrating"),
    "body in a wall": (HOLLOW, moved(CELL, 1, 1, 0), "penetrating"),
    "hollow body in a block": (HOLLOW, box((-1, -1, -1), (6, 6, 6)), "inside"),
}


@pytest.mark.parametrize("matrix", [IDENTITY, SHEAR], ids=["aligned", "sheared"])
@pytest.mark.parametrize("name", NAMED)
def test_named_degenerate_pairs(name: str, matrix: Matrix) -> None:
    a, b, expected = NAMED[name]
    assert true_relation(a, b) == expected
    for seed in range(4):
        result = relate(a.mesh(matrix, seed), b.mesh(matrix, seed + 7))
        assert (result.relation, result.proven) == (expected, True)


def random_solid(rng: random.Random, extent: int) -> VoxelSolid:
    size = rng.choice((1, 1, 2, 3))
    cells: set[Cell] = {(0, 0, 0)}
    for _ in range(rng.randrange(1, 12)):
        i, j, k = rng.choice(sorted(cells))
        step = rng.choice(((1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1)))
        cells.add((i + step[0], j + step[1], k + step[2]))
    if rng.random() < 0.2:
        cells.add((rng.randrange(-3, 4), rng.randrange(-3, 4), rng.randrange(-3, 4)))
    x, y, z = (rng.randrange(-extent, extent + 1) for _ in range(3))
    return VoxelSolid(frozenset(cells), size, (x, y, z))


def random_pair(seed: int) -> tuple[VoxelSolid, VoxelSolid]:
    rng = random.Random(seed)
    return random_solid(rng, 1), random_solid(rng, 3)


def check_random_pair(seed: int) -> str:
    a, b = random_pair(seed)
    matrix = SHEAR if seed % 2 else IDENTITY
    truth = true_relation(a, b)
    result = relate(a.mesh(matrix, seed), b.mesh(matrix, seed + 1))
    assert result.proven
    allowed = {"coincident", "penetrating"} if truth == "same" else {truth}
    assert result.relation in allowed, f"seed {seed}: {result.relation}, truth {truth}"
    return truth


def test_random_lattice_solids() -> None:
    seen = [check_random_pair(seed) for seed in range(400)]
    for relation in ("penetrating", "touching", "separated"):
        assert seen.count(relation) > 20


def test_identical_geometry_is_coincident_in_any_order() -> None:
    mesh = L_SHAPE.mesh(SHEAR, 3)
    vertices, triangles = mesh.to_bytes()
    corners = [triangles[i : i + 12] for i in range(0, len(triangles), 12)]
    turned = b"".join(c[4:] + c[:4] for c in reversed(corners))
    assert relate(mesh, Mesh.from_bytes(vertices, turned)).relation == "coincident"


def test_open_surfaces_have_no_inside() -> None:
    ball = CUBE.mesh()
    triangle = [(1.0, 1.0, 1.0), (2.0, 1.0, 1.0), (1.0, 2.0, 1.0)]
    inside = mesh_of_soup(triangle)
    assert relate(ball, inside).relation == "contains"
    vertices, triangles = ball.to_bytes()
    open_box = Mesh.from_bytes(vertices, triangles[:-24])
    assert relate(open_box, inside).relation == "separated"
    piercing = mesh_of_soup([(1.0, 1.5, -1.0), (2.0, 1.5, -1.0), (1.5, 1.25, 1.0)])
    assert relate(open_box, piercing).relation == "penetrating"


def test_evidence_points_at_the_overlap() -> None:
    a = CUBE.mesh()
    result = relate(a, a.translated((2.25, 2.125, 2.5)))
    assert result.relation == "penetrating"
    assert result.triangle_a >= 0
    assert result.triangle_b >= 0
    assert result.point is not None
    assert all(2 <= c <= 4 for c in result.point)
    assert result.triangle_tests > 0


def test_far_from_the_origin_one_ulp_decides() -> None:
    far = 2.0**40
    ulp = 2.0**-12
    a = CUBE.mesh().translated((far, far, far))
    for shift, expected in (
        (4.0, "touching"),
        (4.0 + ulp, "separated"),
        (4.0 - ulp, "penetrating"),
    ):
        result = relate(a, a.translated((shift, 0.0, 0.0)))
        assert (result.relation, result.proven) == (expected, True)
