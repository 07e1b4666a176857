"""One triangle of a closed mesh missing, turned or doubled: what is proven then holds of the mesh
as it was, for that is one of the ways to fill the hole."""

from __future__ import annotations

import random

import numpy as np
import pytest

from satcheck.core import Mesh, Surface, mesh_relation
from tests.core.box_sums import TURN, random_sum
from tests.core.voxel_solids import IDENTITY, SHEAR, true_relation

OVERLAPS = ("penetrating", "contains", "inside", "coincident")


def damaged(mesh: Mesh, rng: random.Random) -> Surface:
    triangles = np.asarray(mesh.triangles)
    k, kind = rng.randrange(len(triangles)), rng.choice(("missing", "turned", "twice"))
    if kind == "missing":
        changed = np.delete(triangles, k, axis=0)
    elif kind == "turned":
        changed = triangles.copy()
        changed[k] = changed[k, ::-1]
    else:
        changed = np.concatenate([triangles, triangles[k : k + 1]])
    return Surface(Mesh(np.asarray(mesh.vertices), changed), False)


@pytest.mark.parametrize("seed", range(150))
def test_what_is_proven_with_a_hole_holds_without_it(seed: int) -> None:
    rng = random.Random(seed)
    a, b = random_sum(rng, 3, 5), random_sum(rng, 2, rng.randrange(2, 6))
    matrix = (IDENTITY, SHEAR, TURN)[seed % 3]
    truth = true_relation(a, b) in OVERLAPS
    holed = damaged(a.mesh(matrix, seed), rng)
    for other in (Surface(b.mesh(matrix, seed + 1), True), damaged(b.mesh(matrix, seed + 1), rng)):
        found = mesh_relation(holed, other)
        if found.proven:
            assert (found.relation in OVERLAPS) == truth
        else:
            assert found.hole is not None


def test_most_of_it_stays_proven() -> None:
    rng = random.Random(7)
    proven = 0
    for seed in range(60):
        a, b = random_sum(rng, 3, 5), random_sum(rng, 2, 5)
        found = mesh_relation(damaged(a.mesh(seed=seed), rng), Surface(b.mesh(seed=seed), True))
        proven += found.proven
    assert proven > 30


def test_the_rims_of_holes_are_loops_of_their_vertices_the_largest_first() -> None:
    """A box without its lid, and without half of its floor."""
    corners = [(x, y, z) for z in (0, 1) for y in (0, 2) for x in (0, 2)]
    walls = [(0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    faces = [half for a, b, c, d in walls for half in ((a, b, c), (a, c, d))]
    surface = Surface(Mesh(np.array(corners, float), np.array([*faces, (0, 2, 3)])), False)
    lid, floor = ([set(loop) for loop in loops] for loops in surface.rims())
    assert sorted([lid, floor], key=str) == sorted([[{4, 5, 6, 7}], [{0, 1, 3}]], key=str)
    assert Surface(random_sum(random.Random(1), 3, 5).mesh(IDENTITY, 1), True).rims() == []
