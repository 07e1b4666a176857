"""The exact relation of two meshes, above all where every contact is degenerate."""

from __future__ import annotations

import random

import pytest

from satcheck._native.core import MeshRelation
from satcheck.core import Mesh, Surface, mesh_relation
from tests.core.box_sums import TURN, BoxSum, SignedBox, random_sum
from tests.core.voxel_solids import (
    IDENTITY,
    SHEAR,
    Cell,
    Cells,
    Matrix,
    VoxelSolid,
    box,
    mesh_of_soup,
    true_relation,
)

MIRRORED = {"contains": "inside", "inside": "contains"}


def relate(a: Mesh, b: Mesh) -> MeshRelation:
    """The relation both ways round; they must mirror each other."""
    return relate_surfaces(*(Surface(m, m.topology().solid) for m in (a, b)))


def relate_solids(a: Mesh, b: Mesh) -> MeshRelation:
    """The same, whatever the signed volume."""
    return relate_surfaces(Surface(a, True), Surface(b, True))


def relate_surfaces(sa: Surface, sb: Surface) -> MeshRelation:
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


def boxes(*signed: tuple[Cell, Cell, int]) -> BoxSum:
    return BoxSum(tuple(SignedBox(low, high, sign) for low, high, sign in signed))


POCKET = boxes(((0, 0, 0), (5, 5, 5), 1), ((1, 1, 2), (4, 4, 5), -1))
SHELLS = boxes(((0, 0, 0), (4, 4, 4), 1), ((2, 0, 0), (6, 4, 4), 1))
CROSSED = boxes(((0, 0, 0), (4, 4, 4), 1), ((1, 1, 1), (6, 3, 3), 1))
NESTED = boxes(((0, 0, 0), (6, 6, 6), 1), ((2, 2, 2), (4, 4, 4), 1))
FIN = boxes(((0, 0, 0), (2, 2, 2), 1), ((3, 0, 0), (4, 2, 2), 1), ((3, 0, 0), (4, 2, 2), -1))
# Its sheets cross those of FIN along edges of both.
TALL_FIN = boxes(((3, 0, 3), (4, 2, 4), 1), ((3, 1, -1), (4, 3, 1), 1), ((3, 1, -1), (4, 3, 1), -1))
SPLIT_CUBE = boxes(((0, 0, 0), (2, 4, 4), 1), ((2, 0, 0), (4, 4, 4), 1))

SELF_MEETING: dict[str, tuple[Cells, Cells, str]] = {
    "through the lid of a pocket": (POCKET, box((2, 2, 3), (3, 3, 7)), "penetrating"),
    "on the floor of a pocket": (POCKET, box((2, 2, 2), (3, 3, 5)), "touching"),
    "into the floor of a pocket": (POCKET, box((2, 2, 1), (3, 3, 7)), "penetrating"),
    "fills a pocket": (POCKET, box((1, 1, 2), (4, 4, 5)), "touching"),
    "below the lid of a pocket": (POCKET, box((2, 2, 3), (3, 3, 4)), "separated"),
    "rests on the lid of a pocket": (POCKET, box((2, 2, 5), (3, 3, 7)), "touching"),
    "rests on the lid and the rim": (POCKET, box((0, 2, 5), (3, 3, 7)), "touching"),
    "across a face inside the material": (SHELLS, box((1, 1, 1), (5, 3, 3)), "contains"),
    "across a face inside, and out": (SHELLS, box((1, 1, 1), (7, 3, 3)), "penetrating"),
    "flush with a face inside": (SHELLS, box((2, 1, 1), (3, 3, 3)), "contains"),
    "around the bar of a crossed pair": (CROSSED, box((4, 0, 0), (5, 5, 1)), "touching"),
    "on the edge where shells cross": (CROSSED, box((4, 3, 1), (5, 4, 3)), "touching"),
    "inside a nested shell": (NESTED, box((1, 1, 1), (5, 5, 5)), "contains"),
    "within a shell that cancels": (FIN, box((3, 0, 0), (4, 2, 2)), "touching"),
    "through a shell that cancels": (FIN, box((3, 0, 0), (5, 1, 2)), "penetrating"),
    "around a shell that cancels": (box((-1, -1, -1), (5, 3, 3)), FIN, "contains"),
    "a shell that cancels sticks out": (box((0, 0, 0), (3, 2, 2)), FIN, "penetrating"),
    "shells that cancel, crossed": (FIN, TALL_FIN, "penetrating"),
    "a cube in two halves": (SPLIT_CUBE, CUBE, "coincident"),
    "a cube and a cube with a shell in it": (NESTED, box((0, 0, 0), (6, 6, 6)), "coincident"),
}


@pytest.mark.parametrize("matrix", [IDENTITY, TURN], ids=["aligned", "turned"])
@pytest.mark.parametrize("name", SELF_MEETING)
def test_meshes_that_meet_themselves(name: str, matrix: Matrix) -> None:
    a, b, expected = SELF_MEETING[name]
    assert true_relation(a, b) == expected
    for seed in range(4):
        result = relate_solids(a.mesh(matrix, seed), b.mesh(matrix, seed + 7))
        assert (result.relation, result.proven) == (expected, True)


@pytest.mark.parametrize("seed", range(300))
def test_random_sums_of_boxes(seed: int) -> None:
    rng = random.Random(seed)
    a, b = random_sum(rng, 4, 5), random_sum(rng, 3, rng.randrange(2, 6))
    matrix = (IDENTITY, SHEAR, TURN)[seed % 3]
    result = relate_solids(a.mesh(matrix, seed), b.mesh(matrix, seed + 1))
    assert (result.relation, result.proven) == (true_relation(a, b), True)


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
    assert result.relation == truth, f"seed {seed}: {result.relation}"
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


def test_holes_are_filled_somehow_unless_they_are_meant() -> None:
    ball = CUBE.mesh()
    triangle = [(1.0, 1.0, 1.0), (2.0, 1.0, 1.0), (1.0, 2.0, 1.0)]
    inside = mesh_of_soup(triangle)
    assert relate(ball, inside).relation == "contains"
    vertices, triangles = ball.to_bytes()
    open_box = Mesh.from_bytes(vertices, triangles[:-24])
    assert relate(open_box, inside).relation == "contains"
    sheet = Surface(open_box, False, sheets=True)
    assert mesh_relation(sheet, Surface(inside, False, sheets=True)).relation == "separated"
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
