"""Solids of which a point may be covered twice are told from those of which none is."""

from __future__ import annotations

import pytest

from satcheck.core import Mesh, Surface, covers_once, has_sheets
from tests.core.test_mesh_relation import CELL, CUBE, HOLLOW, NAMED, SMALL, random_pair
from tests.core.voxel_solids import IDENTITY, SHEAR, Matrix, mesh_of_soup


def both(a: Mesh, b: Mesh) -> Mesh:
    """One mesh of two; corners at the same place are welded."""
    return mesh_of_soup(
        corner for mesh in (a, b) for t in range(mesh.triangle_count) for corner in mesh.corners(t)
    )


def once(mesh: Mesh) -> bool:
    return covers_once(Surface(mesh, True))


CASES = {
    "apart": ((9.0, 0.0, 0.0), True),
    "crossing": ((0.5, 0.25, 0.125), False),
    "flush sides, overlapping": ((1.0, 0.0, 0.0), False),
    "one face in common": ((2.0, 0.0, 0.0), True),
    "part of a face in common": ((2.0, 0.5, 0.5), True),
    "one edge in common": ((2.0, 2.0, 0.0), True),
    "one corner in common": ((2.0, 2.0, 2.0), True),
    "an edge on a face": ((2.0, 1.0, 2.0), True),
}


@pytest.mark.parametrize("name", CASES)
def test_two_boxes_in_one_mesh(name: str) -> None:
    offset, expected = CASES[name]
    assert once(both(SMALL.mesh(seed=1), SMALL.mesh(seed=2).translated(offset))) == expected


def test_a_shell_within_a_shell() -> None:
    assert once(HOLLOW.mesh())  # the inner one faces inward: a cavity
    assert not once(both(CUBE.mesh(), CELL.mesh().translated((1.0, 1.0, 1.0))))


def test_the_same_shell_twice() -> None:
    assert not once(both(CUBE.mesh(seed=1), CUBE.mesh(seed=2)))
    assert not once(both(CUBE.mesh(), CUBE.mesh()))


@pytest.mark.parametrize("matrix", [IDENTITY, SHEAR], ids=["aligned", "sheared"])
def test_boundaries_of_lattice_solids(matrix: Matrix) -> None:
    solids = [solid for a, b, _ in NAMED.values() for solid in (a, b)]
    solids += [solid for seed in range(40) for solid in random_pair(seed)]
    assert all(once(solid.mesh(matrix, seed)) for seed, solid in enumerate(solids))


def test_two_lattice_solids_in_one_mesh() -> None:
    """They cover a point twice exactly when they have a cell in common."""
    seen = set()
    for seed in range(150):
        a, b = random_pair(seed)
        disjoint = a.unit_cells().isdisjoint(b.unit_cells())
        found = once(both(a.mesh(seed=seed), b.mesh(seed=seed + 1)))
        assert found == disjoint, seed
        seen.add(disjoint)
    assert seen == {False, True}


def test_sheets_are_told_from_walls_and_cavities() -> None:
    """A face and its reverse: within a solid they are no sheet, outside of it they are one."""
    for solid in (CUBE.mesh(), HOLLOW.mesh(), both(CUBE.mesh(), CELL.mesh())):
        assert not has_sheets(Surface(solid, True), 0.0)
    triangle = ((0.5, 0.5, 0.5), (0.75, 0.5, 0.5), (0.5, 0.75, 0.5))
    sheet = mesh_of_soup((*triangle, *triangle[::-1]))
    assert not has_sheets(Surface(both(CUBE.mesh(), sheet), True), 0.0)
    assert has_sheets(Surface(both(CUBE.mesh(), sheet.translated((9.0, 0.0, 0.0))), True), 0.0)
    alone = Surface(both(CUBE.mesh(), sheet.translated((9.0, 0.0, 0.0))), True)
    width = 0.25 / 2**0.5  # of the triangle
    assert has_sheets(alone, 0.99 * width)
    assert not has_sheets(alone, 1.01 * width)
