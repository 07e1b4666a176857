"""The core against rational arithmetic: tetrahedra on a small grid, alone and two in one mesh."""

from __future__ import annotations

import random

import pytest

from satcheck.core import Surface, mesh_relation
from tests.core.voxel_solids import Point, mesh_of_soup
from tests.oracles.exact_solids import combinations_met, exact

Soup = list[tuple[Point, Point, Point]]

BOTH, ONLY_A, ONLY_B = (True, True), (True, False), (False, True)


def tetrahedron(rng: random.Random, extent: int) -> Soup:
    """Wound outward; not flat."""
    while True:
        p, q, r, s = (
            (
                float(rng.randrange(extent)),
                float(rng.randrange(extent)),
                float(rng.randrange(extent)),
            )
            for _ in range(4)
        )
        volume = sum(
            (q[i] - p[i])
            * (
                (r[(i + 1) % 3] - p[(i + 1) % 3]) * (s[(i + 2) % 3] - p[(i + 2) % 3])
                - (r[(i + 2) % 3] - p[(i + 2) % 3]) * (s[(i + 1) % 3] - p[(i + 1) % 3])
            )
            for i in range(3)
        )
        if volume != 0:
            faces = [(p, r, q), (p, q, s), (q, r, s), (r, p, s)]
            return faces if volume > 0 else [(a, c, b) for a, b, c in faces]


def occurring(relation: str) -> set[tuple[bool, bool]]:
    """What a relation says about which of (in A, in B) occur, the outside of both left out."""
    return {
        "separated": {ONLY_A, ONLY_B},
        "touching": {ONLY_A, ONLY_B},
        "penetrating": {BOTH, ONLY_A, ONLY_B},
        "contains": {BOTH, ONLY_A},
        "inside": {BOTH, ONLY_B},
        "coincident": {BOTH},
    }[relation]


def check(a: Soup, b: Soup) -> str:
    found = mesh_relation(
        *(Surface(mesh_of_soup(p for t in soup for p in t), True) for soup in (a, b))
    )
    met = combinations_met(exact(a), exact(b)) - {(False, False)}
    assert found.proven
    expected = occurring(found.relation)
    nested_in_contact = found.relation == "penetrating" and met in ({BOTH, ONLY_A}, {BOTH, ONLY_B})
    assert met == expected or nested_in_contact
    return found.relation


@pytest.mark.parametrize("seed", range(12))
def test_two_tetrahedra(seed: int) -> None:
    rng = random.Random(seed)
    check(tetrahedron(rng, 4), tetrahedron(rng, 4))


@pytest.mark.parametrize("seed", range(3))
def test_two_overlapping_tetrahedra_in_one_mesh(seed: int) -> None:
    rng = random.Random(seed)
    check(tetrahedron(rng, 3) + tetrahedron(rng, 3), tetrahedron(rng, 3))


def test_known_combinations() -> None:
    rng = random.Random(0)
    one = tetrahedron(rng, 4)
    far = [tuple((x + 9, y, z) for x, y, z in t) for t in one]
    assert combinations_met(exact(one), exact(one)) == {(False, False), BOTH}
    assert combinations_met(exact(one), exact(far)) == {(False, False), ONLY_A, ONLY_B}
