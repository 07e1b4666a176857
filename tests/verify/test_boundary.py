"""Sheets and faces within the material: on piles of boxes, beside voxels."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from msgspec import UNSET, UnsetType

from satcheck.report.certificate import SurfacesProof
from satcheck.report.report import OVERLAPS
from satcheck.report.values import Relation
from satcheck.verify.cells import boundary_of
from satcheck.verify.exact import Rejected, cross, dot, sub
from satcheck.verify.pairs import Pair
from satcheck.verify.relations import prove
from satcheck.verify.surfaces import meeting
from satcheck.verify.world import Exact, World
from tests.audit.shapes import BOX_FACES, box
from tests.core.box_sums import BoxSum, SignedBox
from tests.core.voxel_solids import true_relation

RELATIONS = ("separated", "touching", "penetrating", "contains", "inside", "coincident")
EDGE = 5  # of the grid
MEETS = 3  # pairs of triangles that are named for one falsehood
# Boxes by their corners, and how often their surfaces run around them.
Pile = list[tuple[tuple[int, ...], tuple[int, ...], int]]


def solid(pile: Pile, split: int = 0) -> Exact:
    """split: which diagonals, by bits."""
    points: list[Any] = []
    triangles: list[tuple[int, int, int]] = []
    for number, (low, high, times) in enumerate(pile):
        corners, _ = box(low, high)  # type: ignore[arg-type]
        for face in BOX_FACES:
            p, q, r, s = (len(points) + k for k in (face if times > 0 else face[::-1]))
            either = [(p, q, r), (p, r, s)], [(q, r, s), (q, s, p)]
            triangles += either[(split >> number) & 1] * abs(times)
        points += corners
    return Exact(World(np.array(points, dtype=float), np.array(triangles), True), 0)


def voxels(pile: Pile) -> Any:
    """Which cells of the grid, with a margin around it, the pile fills."""
    winding = np.zeros((EDGE + 2,) * 3, dtype=int)
    for low, high, times in pile:
        x, y, z = (slice(p + 1, q + 1) for p, q in zip(low, high, strict=True))
        winding[x, y, z] += times
    return winding != 0


def sum_of(pile: Pile) -> BoxSum:
    boxes = [
        SignedBox(low, high, 1 if times > 0 else -1)  # type: ignore[arg-type]
        for low, high, times in pile
        for _ in range(abs(times))
    ]
    return BoxSum(tuple(boxes))


def relation_of(a: Pile, b: Pile) -> str:
    return true_relation(sum_of(a), sum_of(b))


def has_sheets(pile: Pile) -> bool:
    return bool(sum_of(pile).sheets())


def random_pile(rng: np.random.Generator, low: int, high: int, boxes: int) -> Pile:
    """Boxes between two planes of x, every third with a wall, or the same box again, beside it."""
    pile: Pile = []
    for _ in range(rng.integers(1, boxes + 1)):
        pile += [(*random_box(rng, low, high), 1)]
        if rng.random() < 0.3:
            pile += [(*pile[-1][:2], 1)]
        if rng.random() < 0.3:
            ends = random_box(rng, 0, EDGE)
            pile += [(*ends, 1), (*ends, -1)]
    return pile


def random_box(
    rng: np.random.Generator, low: int, high: int
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    ranges = (low, high), (1, EDGE - 1), (1, EDGE - 1)
    ends = [sorted(rng.choice(np.arange(p, q + 1), 2, replace=False).tolist()) for p, q in ranges]
    return tuple(e[0] for e in ends), tuple(e[1] for e in ends)


def pile_pairs() -> Iterator[tuple[Pile, Pile, Pair, int]]:
    """Piles anywhere, side by side, within each other, and that fill the same box."""
    rng = np.random.default_rng(8)
    whole: Pile = [((0, 0, 0), (EDGE, EDGE, EDGE), 1)]
    for number in range(18):
        a, b = (random_pile(rng, 1, EDGE - 1, 2) for _ in range(2))
        kind = number % 6
        if kind in (1, 2):
            a, b = random_pile(rng, 0, 2, 2), random_pile(rng, 1 + kind, EDGE, 2)
        if kind in (3, 5):
            a = [*a, *whole]
        if kind in (4, 5):
            b = [*b, *whole]
        splits = rng.integers(0, 256, 2).tolist()
        yield a, b, Pair(solid(a, splits[0]), solid(b, splits[1])), number


def proves(relation: Relation, pair: Pair, triangles: tuple[int, int] | UnsetType = UNSET) -> bool:
    try:
        prove(relation, SurfacesProof(triangles), pair, Fraction(0), Fraction(0))
    except Rejected:
        return False
    return True


def test_piles_of_boxes_are_what_their_voxels_are() -> None:
    seen = dict.fromkeys(RELATIONS, 0)
    for a, b, pair, number in pile_pairs():
        truth = relation_of(a, b)
        seen[truth] += 1
        assert proves(truth, pair) or has_sheets(a) or has_sheets(b), (number, truth)
        contacts = meeting(pair.a, pair.b)[:MEETS]
        for relation in set(RELATIONS) - {truth}:
            # Only evidence of overlaps names triangles, and only that of penetration is read there.
            named = ((0, 0),) if relation in OVERLAPS else ()
            for triangles in (UNSET, *named, *(contacts if relation == "penetrating" else ())):
                assert not proves(relation, pair, triangles), (number, truth, relation, triangles)
    assert min(seen.values()) > 1, seen


def area(body: Exact) -> float:
    """Of the boundary."""
    total = 0.0
    for t in range(len(body.world.triangles)):
        for p, q, r in boundary_of(body, t):
            normal = cross(sub(q, p), sub(r, p))
            total += float(dot(normal, normal)) ** 0.5 / 2
    return total


@pytest.mark.parametrize(
    ("pile", "expected"),
    [
        ([((0, 0, 0), (4, 4, 4), 1)], 96.0),
        ([((0, 0, 0), (4, 4, 4), 1), ((1, 1, 1), (3, 3, 3), -1)], 120.0),  # hollow
        ([((0, 0, 0), (4, 4, 4), 1), ((1, 1, 1), (3, 3, 3), 1)], 96.0),
        ([((0, 0, 0), (4, 4, 4), 1), ((2, 2, 2), (6, 6, 6), 1)], 168.0),
        ([((0, 0, 0), (4, 4, 4), 1), ((2, 2, 2), (6, 6, 6), -1)], 192.0),
        ([((0, 0, 0), (4, 4, 4), 1), ((0, 0, 0), (4, 4, 4), -1)], 192.0),  # sheets
        ([((0, 0, 0), (2, 2, 2), 1), ((2, 0, 0), (4, 2, 2), 1)], 40.0),
    ],
)
@pytest.mark.parametrize("split", [0, 1, 3])
def test_the_boundary_of_a_pile(pile: Pile, expected: float, split: int) -> None:
    assert area(solid(pile, split)) == expected
