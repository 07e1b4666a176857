"""How thick an overlap is: balls in both bodies, cells that hold none larger, and what shows less.

Half the thickness of what a box and a bracket share is sqrt(2) / (2 + 2 sqrt(2)): a ball that
touches two faces of the box and the edge in the notch of the bracket.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from itertools import product
from typing import Any

import pytest
from msgspec import ValidationError, convert
from msgspec.structs import replace

from satcheck.report.certificate import Cells, Face, Plane
from satcheck.report.report import plain
from satcheck.report.values import Vector
from satcheck.verify import Rejected
from satcheck.verify.pairs import Pair
from satcheck.verify.partition import BOUNDED, CUT, OUTSIDE_A, Partition
from satcheck.verify.thickness import _Sums, at_most, holds_ball
from satcheck.verify.world import Exact
from tests.audit.shapes import Mesh, bracket, moved, unit_box
from tests.verify.reports import Json, pieces, turned
from tests.verify.test_cover import pair_of

ZEROS = (0.0, 0.0, 0.0)
WALL_X, WALL_Y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
ZERO = Fraction(0)
NOTHING = ZERO, ZERO
THICK = Fraction(1, 8)
LESS = Fraction(1, 1 << 70)
# The triangles of the walls of boxes that look along -x and +x, and along -y.
LEFT, RIGHT, BACK = (8, 9), (10, 11), (4, 5)
# Those of the notch of a bracket, x = 2 and y = 2.
ACROSS_X, ACROSS_Y = (6, 7), (4, 5)


def boxes() -> Pair:
    """Two boxes with a slab of 1/4 in common, and faces in one plane."""
    return pair_of(unit_box(), unit_box(0.75))


def slab() -> Cells:
    patches = Face("a", RIGHT), Face("b", LEFT)
    half = ((0, 1.0), (1, 1.0))
    return Cells(ZEROS, (0.75, 0.0, 0.0), (1.0, 1.0, 1.0), patches, (BOUNDED,), (), (), (half,))


def notch() -> Pair:
    return pair_of(bracket(), unit_box(1.5, 1.5, 1.0, edge=2.0))


def arms() -> Cells:
    """Where both walls of the notch are crossed is no bracket."""
    patches = (
        Face("b", LEFT),
        Face("b", BACK),
        Face("a", ACROSS_X),
        Face("a", ACROSS_Y),
    )
    corner = ((0, 0.5), (1, 0.5), (2, 0.125), (3, 0.125))
    sums = corner, ((0, 1.0), (2, 1.0)), ((1, 1.0), (3, 1.0))
    return Cells(
        ZEROS,
        (1.5, 1.5, 1.0),
        (3.5, 3.5, 3.0),
        patches,
        (0, 1, BOUNDED, BOUNDED, 1, BOUNDED, OUTSIDE_A),
        (2.0, 2.0, 2.0),
        (),
        sums,
    )


def cut_arms() -> Cells:
    """The same, cut by the planes of the walls."""
    cells = (CUT, CUT, BOUNDED, BOUNDED, CUT, BOUNDED, OUTSIDE_A)
    cuts = (WALL_X, 2.0), (WALL_Y, 2.0), ((0.0, 0.25, 0.0), 0.5)
    return replace(arms(), cells=cells, at=(), cuts=cuts)


def holds(pair: Pair, cells: Cells, most: Fraction, less: Any = NOTHING) -> None:
    at_most(cells, pair.a, pair.b, most, less)


def is_shown(pair: Pair, cells: Cells, most: Fraction, less: Any = NOTHING) -> bool:
    try:
        holds(pair, cells, most, less)
    except Rejected:
        return False
    return True


def is_held(body: Exact, centre: Vector, radius: Fraction) -> bool:
    try:
        holds_ball(body, centre, radius)
    except Rejected:
        return False
    return True


def test_a_slab_is_as_thick_as_it_is_and_no_less() -> None:
    holds(boxes(), slab(), THICK)
    assert not is_shown(boxes(), slab(), THICK - LESS)


def test_a_tolerance_of_either_body_counts_for_it() -> None:
    pair, cells = boxes(), slab()
    for share in range(9):
        less = share * THICK / 4, (8 - share) * THICK / 4
        assert is_shown(pair, cells, ZERO, less)
        for fewer in ((less[0] - LESS, less[1]), (less[0], less[1] - LESS)):
            assert not is_shown(pair, cells, ZERO, fewer)
    one_sided = replace(cells, sums=(((0, 1.0),),))
    holds(pair, one_sided, ZERO, (2 * THICK, ZERO))
    assert not is_shown(pair, one_sided, ZERO, (ZERO, 2 * THICK))


@pytest.mark.parametrize("cells", [arms(), cut_arms()], ids=["halved", "cut"])
def test_what_is_outside_of_a_body_needs_no_bound(cells: Cells) -> None:
    holds(notch(), cells, Fraction(2, 5))
    true = Fraction(math.sqrt(2) / (2 + 2 * math.sqrt(2)))
    assert not is_shown(notch(), cells, true)


def test_coordinates_may_start_anywhere() -> None:
    x, y, z = origin = (0.25, -8.0, 2.0**-20)
    for cells in (arms(), cut_arms()):
        moved_cells = replace(
            cells,
            origin=origin,
            low=(1.5 - x, 1.5 - y, 1.0 - z),
            high=(3.5 - x, 3.5 - y, 3.0 - z),
            at=(2.0 - x, 2.0 - y, 2.0 - y) if cells.at else (),
            cuts=((WALL_X, 2.0 - x), (WALL_Y, 2.0 - y), (WALL_Y, 2.0 - y)) if cells.cuts else (),
        )
        holds(notch(), moved_cells, Fraction(2, 5))
        for axis, by in product(range(3), (-LESS, LESS)):
            off = [*origin]
            off[axis] += float(by) * 2**30
            with pytest.raises(Rejected, match="leave out"):
                holds(notch(), replace(moved_cells, origin=tuple(off)), Fraction(2, 5))


def test_a_plane_across_is_a_cut_like_any_other() -> None:
    """The diagonal of the notch, twice."""
    twice = replace(
        arms(),
        cells=(CUT, *arms().cells, *arms().cells),
        at=arms().at * 2,
        cuts=(((1.0, -1.0, 0.0), 0.0),),
        sums=arms().sums * 2,
    )
    holds(notch(), twice, Fraction(2, 5))


def test_one_plane_each_shows_how_thick_convex_bodies_are() -> None:
    patches = Plane("a", WALL_X, 1.0), Plane("b", (-0.5, 0.0, 0.0), -0.375)
    cells = replace(slab(), patches=patches, low=(-9.0, -9.0, -9.0), high=(9.0, 9.0, 9.0))
    holds(boxes(), cells, THICK)
    assert not is_shown(boxes(), cells, THICK - LESS)
    for place, plane in ((0, Plane("a", WALL_X, 1 - 2.0**-53)), (1, Plane("b", ZEROS, 9.0))):
        assert not is_shown(
            boxes(), replace(cells, patches=with_entry([*patches], place, plane)), Fraction(9)
        )


def test_a_plane_counts_within_its_reach() -> None:
    """Where y > 2 the bracket ends at x = 2, and where y < 2 it does not."""
    low, high, pair = (1.5, 2.5, 1.0), (2.0, 3.5, 3.0), notch()
    bounds = []
    for reach in (0.125, 0.25, 0.375, 0.46875, 0.5 + 2.0**-50, 0.75):
        patches = Plane("a", WALL_X, 2.0, reach), Face("b", LEFT)
        cells = replace(slab(), low=low, high=high, patches=patches)
        sums = _Sums(cells, Partition(cells, pair.a, pair.b), NOTHING)
        cell = next(cell for _, cell in sums.partition.leaves())
        assert cell is not None
        for most in (Fraction(1, 4), Fraction(7, 16)):
            try:
                sums.are_at_most([(cell, cells.sums[0])], most)
            except Rejected:
                continue
            bounds.append((reach, most))
    quarter, more = Fraction(1, 4), Fraction(7, 16)
    assert bounds == [(0.375, quarter), (0.46875, quarter), (0.46875, more)]


def test_a_ball_in_both_is_in_either() -> None:
    pair = boxes()
    for body, (centre, radius) in product(
        (pair.a, pair.b), (((0.875, 0.5, 0.5), THICK), ((0.8125, 0.25, 0.25), THICK / 2))
    ):
        holds_ball(body, centre, radius)
    for centre, radius in (
        ((0.875, 0.5, 0.5), THICK + LESS),
        ((0.875 + 2.0**-50, 0.5, 0.5), THICK),
        ((0.875, 0.125 - 2.0**-50, 0.5), THICK),
        ((1.5, 0.5, 0.5), THICK),
        ((1.0, 0.5, 0.5), ZERO),  # on the surface
    ):
        bodies = pair.a, pair.b
        assert not all(is_held(body, centre, radius) for body in bodies)


def test_a_face_within_a_body_bounds_its_balls() -> None:
    points, faces = unit_box(edge=4.0)
    inner = unit_box(1.0, 1.0, 1.0)
    both = points + inner[0], faces + [tuple(v + 8 for v in face) for face in inner[1]]
    body = pair_of(both, unit_box()).a
    holds_ball(body, (1.5, 1.5, 1.5), Fraction(1, 2))
    with pytest.raises(Rejected):
        holds_ball(body, (1.5, 1.5, 1.5), Fraction(1, 2) + LESS)
    holds_ball(pair_of(turned(unit_box()), unit_box()).a, (0.5, 0.5, 0.5), Fraction(1, 2))


def test_far_from_the_origin_float64_decides_less_and_rationals_the_rest() -> None:
    away = 2.0**40
    pair = pair_of(moved(unit_box(), away, 0.0, 0.0), moved(unit_box(0.75), away, 0.0, 0.0))
    cells = replace(slab(), low=(away + 0.75, 0.0, 0.0), high=(away + 1.0, 1.0, 1.0))
    holds(pair, cells, THICK)
    assert not is_shown(pair, cells, THICK - LESS)


@pytest.mark.parametrize("weight", [5e-324, 1e-300, 1e300, 1e308])
def test_the_size_of_all_weights_means_nothing(weight: float) -> None:
    cells = replace(slab(), sums=(((0, weight), (1, weight)),))
    holds(boxes(), cells, THICK)
    assert not is_shown(boxes(), cells, THICK - LESS)
    assert not is_shown(boxes(), cells, THICK / 1024)


def test_many_small_weights_are_not_lost_beside_a_large_one() -> None:
    small, count = 2.0**-55, 1 << 10
    patches = Face("b", LEFT), Face("b", RIGHT)
    cells = replace(slab(), patches=patches, sums=(((0, 1.0), *[(1, small)] * count),))
    share = count * Fraction(small)
    at_end = (Fraction(1, 4) + share * Fraction(3, 4)) / (1 + share)
    holds(boxes(), cells, at_end)
    assert not is_shown(boxes(), cells, Fraction(1, 4) * (1 + Fraction(1, 1 << 45)))


def test_a_ball_is_too_large_however_near_or_far_the_surface_is() -> None:
    """Squares of these lengths are no floats."""
    tip = [(0.0, 0.0, 0.0), (0.5, 0.5, 0.125), (0.5, 0.125, 0.5), (0.125, 0.5, 0.5)]
    cavity: Mesh = tip, [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)]
    hollow = pair_of(pieces(unit_box(-1.0, -1.0, -1.0, edge=2.0), cavity), unit_box()).a
    for off in (2.0**-500, 2.0**-600, 2.0**-1000):
        assert is_held(hollow, (-off, -off, -off), Fraction(off))
        assert not is_held(hollow, (-off, -off, -off), Fraction(2 * off))
        assert not is_held(hollow, (-off, -off, -off), Fraction(1, 4))
    large = pair_of(unit_box(-1e200, -1e200, -1e200, edge=2e200), unit_box()).a
    assert is_held(large, ZEROS, Fraction(1e200))
    assert not is_held(large, ZEROS, Fraction(1e201))


def with_entry(values: list[Any], place: int, entry: Any) -> list[Any]:
    return [*values[:place], entry, *values[place + 1 :]]


def changed(made: Json) -> Iterator[Json]:
    """Cells with one entry changed, dropped, or added."""
    for key in ("cells", "at", "cuts", "sums", "patches"):
        for place, entry in enumerate(made[key]):
            yield {**made, key: made[key][:place] + made[key][place + 1 :]}
            yield {**made, key: [*made[key], entry]}
            for false in OTHERS[key](entry):
                yield {**made, key: with_entry(made[key], place, false)}
    for key, axis, by in product(("low", "high"), range(3), (-0.5, -0.0625, 0.0625, 0.5)):
        yield {**made, key: with_entry(made[key], axis, made[key][axis] + by)}


def other_patches(patch: Json) -> Iterator[Json]:
    yield from ({**patch, "triangles": [t]} for t in range(-1, 21))
    yield {**patch, "triangles": [*patch["triangles"], 0]}
    yield {**patch, "triangles": []}
    yield {**patch, "body": "b" if patch["body"] == "a" else "a"}
    for normal, height in product(([1.0, 0.0, 0.0], [0.0, -1.0, 0.0]), (-2.0, 0.5, 2.0, 9.0)):
        plane = {"kind": "plane", "body": patch["body"], "normal": normal, "height": height}
        yield plane
        yield {**plane, "reach": 0.5}


def other_sums(terms: list[Any]) -> Iterator[list[Any]]:
    for place, (patch, weight) in enumerate(terms):
        for other in (-1.0, 0.0, 0.25, 8.0):
            yield with_entry(terms, place, [patch, other])
        for number in (-1, 0, 1, 2, 3, 4):
            yield with_entry(terms, place, [number, weight])


OTHERS: dict[str, Callable[[Any], Iterable[Any]]] = {
    "cells": lambda _: range(-1, 8),
    "at": lambda _: (1.0, 1.5, 1.9375, 2.0625, 3.5),
    "cuts": lambda _: ([n, h] for n in (WALL_X, WALL_Y, ZEROS) for h in (1.5, 1.75, 2.25, 9.0)),
    "patches": other_patches,
    "sums": other_sums,
}


@pytest.mark.parametrize(
    ("pair", "cells", "half"),
    [
        (boxes(), slab(), 0.125),
        (notch(), arms(), math.sqrt(2) / (2 + 2 * math.sqrt(2))),
        (notch(), cut_arms(), math.sqrt(2) / (2 + 2 * math.sqrt(2))),
    ],
    ids=["boxes", "notch", "cut notch"],
)
def test_what_is_changed_in_cells_shows_no_more_than_is_true(
    pair: Pair, cells: Cells, half: float
) -> None:
    """Below the thickness nothing is accepted, whatever the cells say."""
    for other in changed(plain(cells)):
        with pytest.raises((Rejected, ValidationError)):
            holds(pair, convert(other, Cells), Fraction(half) * 255 / 256)


def test_a_sum_of_no_weight_or_of_a_strange_patch_is_none() -> None:
    for terms in (((0, 0.0), (1, 0.0)), (), ((2, 1.0),)):
        with pytest.raises(Rejected):
            holds(boxes(), replace(slab(), sums=(terms,)), Fraction(9))
