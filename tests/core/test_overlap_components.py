"""Components of overlaps: against set operations on lattice cells, and shapes that are known."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import trimesh

from satcheck.core import Mesh, OverlapComponents, Surface, overlap_components, passes_through
from tests.core.test_mesh_relation import NAMED, random_pair
from tests.core.voxel_solids import IDENTITY, SHEAR, Cell, VoxelSolid

PLENTY = 10**6
STEPS: list[Cell] = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
Cells = frozenset[Cell]
# A side of a cell: the cell within, and the step out of it.
Side = tuple[Cell, Cell]


def plus(p: Cell, q: Cell) -> Cell:
    return p[0] + q[0], p[1] + q[1], p[2] + q[2]


def joined(parts: set[Cell] | set[Side], links: set[tuple[object, object]]) -> list[set[object]]:
    """The sets into which links join the parts."""
    sets: dict[object, set[object]] = {part: {part} for part in parts}
    for p, q in links:
        if sets[p] is not sets[q]:
            sets[p] |= sets[q]
            sets.update(dict.fromkeys(sets[q], sets[p]))
    return list({id(members): members for members in sets.values()}.values())


def components(cells: Cells) -> list[Cells]:
    links = {(c, plus(c, s)) for c in cells for s in STEPS if plus(c, s) in cells}
    return [frozenset(members) for members in joined(set(cells), links)]  # type: ignore[arg-type]


def neighbours(cells: Cells, side: Side) -> Iterator[Side]:
    """The next sides of the boundary of the cells, over the four edges of one."""
    cell, out = side
    for way in STEPS:
        if way in (out, (-out[0], -out[1], -out[2])):
            continue
        beside = plus(cell, way)
        if beside not in cells:
            yield cell, way
        elif plus(beside, out) not in cells:
            yield beside, out
        else:
            yield plus(beside, out), (-way[0], -way[1], -way[2])


def true_passing(cells: Cells, a: Cells, b: Cells) -> bool | None:
    """Whether a piece of A's surface joins two of B's around a component of both: None where that
    depends on whether sides that lie in both surfaces belong to both, or to none."""
    sides = {(c, s) for c in cells for s in STEPS if plus(c, s) not in cells}
    in_both = {(c, s) for c, s in sides if plus(c, s) not in a and plus(c, s) not in b}
    answers = set()
    for shared in (in_both, set[Side]()):
        of_a = {(c, s) for c, s in sides if plus(c, s) in b} | shared
        of_b = {(c, s) for c, s in sides if plus(c, s) in a} | shared
        links = [
            {(p, q) for p in of for q in neighbours(cells, p) if q in of} for of in (of_a, of_b)
        ]
        pieces_a, pieces_b = joined(of_a, links[0]), joined(of_b, links[1])  # type: ignore[arg-type]
        around = [
            {q for p in piece for q in (p, *neighbours(cells, p))}  # type: ignore[arg-type]
            for piece in pieces_a
        ]
        answers.add(any(sum(not near.isdisjoint(p) for p in pieces_b) > 1 for near in around))
    return answers.pop() if len(answers) == 1 else None


def check_lattice(a: VoxelSolid, b: VoxelSolid, *, seed: int, sheared: bool) -> None:
    matrix = SHEAR if sheared else IDENTITY
    first, second = (Surface(s.mesh(matrix, seed + k), True) for k, s in enumerate((a, b)))
    found = overlap_components(first, second, PLENTY)
    cells_a, cells_b = a.unit_cells(), b.unit_cells()
    truth = components(cells_a & cells_b)
    assert found.resolved
    assert len(found.components) == len(truth)
    passing = sorted(
        (str(true_passing(c, cells_a, cells_b)), str(true_passing(c, cells_b, cells_a)))
        for c in truth
    )
    assert sorted((str(c.a_through_b), str(c.b_through_a)) for c in found.components) == passing
    unit = abs(np.linalg.det(np.array(matrix, dtype=float)))
    volumes = [len(c) * unit for c in truth]
    assert sorted(c.volume for c in found.components) == pytest.approx(sorted(volumes))
    if not sheared:
        corners = [np.array(sorted(c)) for c in truth]
        boxes = [(tuple(c.min(axis=0)), tuple(c.max(axis=0) + 1)) for c in corners]
        assert sorted(c.bounds for c in found.components) == sorted(boxes)
    assert mirrored(overlap_components(second, first, PLENTY)) == plain(found)


def plain(found: OverlapComponents) -> list[object]:
    return [
        (c.bounds, c.point, c.curves, c.curve_length, c.a_through_b, c.b_through_a)
        for c in found.components
    ]


def mirrored(found: OverlapComponents) -> list[object]:
    return [
        (c.bounds, c.point, c.curves, c.curve_length, c.b_through_a, c.a_through_b)
        for c in found.components
    ]


@pytest.mark.parametrize("name", NAMED)
def test_named_degenerate_pairs(name: str) -> None:
    a, b, _ = NAMED[name]
    for seed, sheared in itertools.product(range(2), (False, True)):
        check_lattice(a, b, seed=seed, sheared=sheared)


@pytest.mark.parametrize("seed", range(80))
def test_random_lattice_solids(seed: int) -> None:
    check_lattice(*random_pair(seed), seed=seed, sheared=seed % 2 == 1)


# trimesh has no types that mypy could use.
creation: Any = trimesh.creation
rotation: Any = trimesh.transformations.rotation_matrix


def block(size: tuple[float, float, float], at: tuple[float, float, float] = (0, 0, 0)) -> Any:
    return creation.box(size).apply_translation(at)


def pin(radius: float, length: float) -> Any:
    return creation.cylinder(radius, length, sections=12)


def annulus(inner: float, outer: float, height: float) -> Any:
    return creation.annulus(inner, outer, height, sections=12)


def turned_over(mesh: Any) -> Any:
    mesh.invert()
    return mesh


def of(*parts: Any) -> Surface:
    mesh: Any = trimesh.util.concatenate(parts)
    of_core = Mesh(np.array(mesh.vertices, np.float64), np.array(mesh.faces, np.int64))
    return Surface(of_core, of_core.topology().solid)


HOLLOW = (block((4, 4, 4)), turned_over(block((3, 3, 3), (0.1, 0.1, 0.1))))
TINES = [block((0.3, 0.3, 2), (x, 0, 0)) for x in (-1, 0, 1)]
SHAPES = {
    "pin through a plate": (of(pin(0.3, 4)), of(block((4, 4, 1), (0.1, 0.05, 0.1))), [True]),
    "pin through both walls": (of(pin(0.3, 8)), of(*HOLLOW), [True, True]),
    "pin into a plate": (of(pin(0.3, 4)), of(block((4, 4, 1), (0, 0, 2))), [False]),
    "three tines": (of(*TINES), of(block((6, 6, 1), (0, 0, -1))), [False, False, False]),
    "press fit": (of(pin(1.01, 4)), of(annulus(1, 3, 2)), [False]),
    "facets of a bolt": (
        of(pin(1, 4).apply_transform(rotation(0.26, (0, 0, 1)))),
        of(annulus(1, 3, 2)),
        [False] * 12,
    ),
    "ends flush": (of(pin(0.3, 4)), of(block((4, 4, 1), (0, 0, 1.5))), [None]),
    "box in a box": (of(block((1, 1, 1))), of(block((4, 4, 4))), [False]),
    "bars of one height": (of(block((4, 1, 1))), of(block((1, 4, 1))), [None]),
}


@pytest.mark.parametrize("name", SHAPES)
def test_passing_through(name: str) -> None:
    a, b, passing = SHAPES[name]
    found = overlap_components(a, b, PLENTY)
    assert found.resolved
    assert [c.a_through_b for c in found.components] == passing
    passes = True in passing  # where it depends on the owner of shared faces, nothing passes
    assert passes_through(a, b, PLENTY) is passes_through(b, a, PLENTY) is passes
    assert mirrored(overlap_components(b, a, PLENTY)) == plain(found)


def test_what_is_not_resolved() -> None:
    plate = of(block((4, 4, 1)))
    crossed = [pin(0.3, 4).apply_transform(rotation(turn, (1, 0, 0))) for turn in (0.3, -0.3)]
    assert not overlap_components(of(*crossed), plate, PLENTY).resolved
    assert passes_through(of(*crossed), plate, PLENTY) is None
    lidless = block((1, 1, 1))
    lidless.update_faces(np.arange(12) > 1)
    assert not overlap_components(of(lidless), plate, PLENTY).resolved
    assert not overlap_components(of(pin(0.3, 4)), plate, 3).resolved
    assert passes_through(of(pin(0.3, 4)), plate, 3) is None


FACES = np.array(
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
     (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
)  # fmt: skip


def spanned(low: tuple[float, float, float], high: tuple[float, float, float]) -> Any:
    corners = list(itertools.product(*zip(low, high, strict=True)))
    return trimesh.Trimesh(corners, FACES, process=False)


def test_a_way_through_a_line_along_which_the_surfaces_meet() -> None:
    """A first ray from the small box to the outside goes through the end of the hollow at `wall`,
    where it cuts the side of the other solid. Volumes grow with the wall, and linearly."""
    a = of(
        spanned((0, 0, 0), (16, 16, 16)),
        turned_over(spanned((2, 2, 2), (15.5, 14, 14))),
        spanned((6, 6, 6), (9, 9, 9)),
        spanned((12, 3, 3), (15, 13, 13)),
    )

    def volumes(wall: float) -> list[float]:
        outer = spanned((1, 1, 1), (15.75, 15, 15))
        hollow = turned_over(spanned((14.5, 1.5, 1.5), (15.25, wall, 14.5)))
        found = overlap_components(a, of(outer, hollow), PLENTY)
        assert found.resolved
        return [each.volume for each in found.components]

    wall = 6.857982247881678
    beside = np.mean([volumes(wall - 0.25), volumes(wall + 0.25)], axis=0)
    assert volumes(wall) == pytest.approx(beside, rel=1e-12)
