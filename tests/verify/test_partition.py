"""Convex cells: their corners, what enters them, and trees that leave nothing out."""

from __future__ import annotations

from itertools import product

import pytest
from msgspec.structs import replace

from satcheck.report.certificate import Cells
from satcheck.verify import Rejected
from satcheck.verify.exact import Homogeneous
from satcheck.verify.partition import BOX, Partition, Polygon, clip, enters
from tests.audit.shapes import unit_box
from tests.verify.test_cover import pair_of

CUBE = [(x, y, z, 1) for x, y, z in product((0, 2), repeat=3)]


def cube() -> list[Polygon]:
    return [[CUBE[v] for v in face] for face in BOX]


def corners(faces: list[Polygon] | None) -> set[tuple[int, ...]]:
    assert faces is not None
    assert all(p[3] == 1 for face in faces for p in face)
    return {p[:3] for face in faces for p in face}


def cells(*kinds: int, at: tuple[float, ...] = ()) -> Cells:
    zero = (0.0, 0.0, 0.0)
    return Cells(zero, zero, (1.0, 1.0, 1.0), (), kinds, at, (), ())


def edges(faces: list[Polygon]) -> list[tuple[Homogeneous, Homogeneous]]:
    return [(face[k - 1], face[k]) for face in faces for k in range(len(face))]


def test_each_edge_runs_once_in_either_direction() -> None:
    faces: list[Polygon] | None = cube()
    for space in ((1, 2, 3, 7), (-1, 1, 0, 1), (1, 1, 1, 3), (0, 0, -1, -1), (1, 0, 0, 1)):
        assert faces is not None
        run = edges(faces)
        assert len(set(run)) == len(run)
        assert {(q, p) for p, q in run} == set(run)
        faces = clip(faces, space)


def test_a_clipped_box_has_the_corners_that_are_left_and_those_of_the_cut() -> None:
    half = clip(cube(), (1, 0, 0, 1))
    assert corners(half) == set(product((0, 1), (0, 2), (0, 2)))
    assert half is not None
    assert corners(clip(half, (0, 1, 0, 1))) == set(product((0, 1), (0, 1), (0, 2)))


def test_three_cuts_that_meet_make_a_corner_of_their_own() -> None:
    faces: list[Polygon] | None = cube()
    for normal in ((1, 0, 0), (0, 1, 0), (0, 0, 1)):
        assert faces is not None
        faces = clip(faces, (*normal, 1))
    assert corners(faces) == set(product((0, 1), repeat=3))


def test_a_cut_through_corners_keeps_them() -> None:
    tetrahedron = clip(cube(), (1, 1, 1, 2))
    assert corners(tetrahedron) == {(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)}
    other = clip(cube(), (-1, -1, -1, -2))
    assert corners(other) == set(product((0, 2), repeat=3)) - {(0, 0, 0)}


def test_what_has_no_inside_is_nothing() -> None:
    assert clip(cube(), (1, 0, 0, 0)) is None
    assert clip(cube(), (-1, -1, -1, -6)) is None
    assert corners(clip(cube(), (1, 0, 0, 2))) == set(product((0, 2), repeat=3))


def test_a_triangle_enters_where_it_has_a_point_inside() -> None:
    spaces = [(1, 0, 0, 2), (-1, 0, 0, 0), (0, 1, 0, 2), (0, -1, 0, 0), (0, 0, 1, 2)]
    spaces += [(0, 0, -1, 0)]
    assert enters([(-1, 1, 1), (3, 1, 1), (3, 3, 1)], spaces)
    assert not enters([(0, 0, 0), (2, 0, 0), (0, 2, 0)], spaces)  # flush with a face
    assert not enters([(3, 1, 1), (1, 3, 1), (4, 4, 1)], spaces)  # along an edge
    assert enters([(1, 1, 1)] * 3, spaces)
    assert not enters([(2, 1, 1)] * 3, spaces)


@pytest.mark.parametrize(
    "made",
    [
        cells(),
        cells(0, 6),
        cells(6, 6),
        cells(0, 6, 6),
        cells(0, 6, 6, at=(0.0,)),
        cells(0, 6, 6, at=(1.0,)),
        cells(0, 6, 6, at=(0.5, 0.5)),
        cells(0, 0, 6, 6, 6, at=(0.5, 0.75)),
        cells(3, 6, 6),
        replace(cells(6), high=(1.0, 1.0, 0.0)),
        replace(cells(3, 6, 6), cuts=(((0.0, 0.0, 0.0), 1.0),)),
    ],
)
def test_a_tree_that_is_none_is_rejected(made: Cells) -> None:
    pair = pair_of(unit_box(), unit_box(0.5))
    with pytest.raises(Rejected):
        list(Partition(made, pair.a, pair.b).leaves())


def test_leaves_fill_the_root() -> None:
    pair = pair_of(unit_box(), unit_box(0.5))
    made = cells(0, 1, 6, 3, 6, 6, 6, at=(0.5, 0.25))
    partition = Partition(replace(made, cuts=(((1.0, 0.0, 0.0), 0.5),)), pair.a, pair.b)
    leaves = [cell for _, cell in partition.leaves()]
    assert leaves[2] is None  # the plane x = 0.5 bounds the cell that it cuts
    boxes = [cell.box(partition.frame) for cell in leaves if cell is not None]
    volume = sum(float((high - low).prod()) for low, high in boxes)
    assert 1 <= volume <= 1 + 2.0**-48  # each end of a cut cell is rounded outward
