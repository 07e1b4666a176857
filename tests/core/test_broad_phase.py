"""The walk of the tree against all pairs."""

from __future__ import annotations

import math
import random
import tracemalloc

import pytest

from satcheck.core import ClosePairs, box_gap

Point = tuple[float, float, float]
Box = tuple[Point, Point]

UNIT: Box = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))


def box_at(low: list[float], size: list[float]) -> Box:
    x, y, z = low
    return (x, y, z), (x + size[0], y + size[1], z + size[2])


def boxes_of_all_forms(seed: int, count: int, span: float) -> list[Box]:
    """Small and large boxes, beams along each axis, plates across each, points."""
    source = random.Random(seed)
    forms = [(1, 1, 1), (9, 9, 9), (20, 0.1, 0.1), (0.1, 20, 0.1), (0.1, 0.1, 20), (20, 20, 0)]
    forms += [(0, 20, 20), (20, 0, 20), (0, 0, 0)]
    boxes = []
    for _ in range(count):
        low = [source.uniform(0, span) for _ in range(3)]
        form = source.choice(forms)
        size = [source.uniform(0.5, 1) * length for length in form]
        boxes.append(box_at(low, size))
    return boxes


def close_pairs(
    boxes: list[Box],
    reach: list[float],
    kinds: list[int],
    exempt_kinds: list[tuple[int, int]] | None = None,
    exempt: list[tuple[int, int]] | None = None,
) -> list[tuple[int, int]]:
    """All pairs; taken a few at a time, they are the same ones."""
    found = ClosePairs(boxes, reach, kinds, exempt_kinds or [], exempt or [])
    first = found.take(3)
    pairs = first + found.take()
    assert len(first) == min(3, len(pairs))
    assert found.take() == []
    assert found.count() == len(pairs)
    return pairs


def among_all_pairs(boxes: list[Box], reach: list[float]) -> list[tuple[int, int]]:
    return [
        (i, j)
        for i in range(len(boxes))
        for j in range(i + 1, len(boxes))
        if box_gap(boxes[i], boxes[j]) <= reach[i] + reach[j]
    ]


@pytest.mark.parametrize("reach", [0.0, 0.25])
@pytest.mark.parametrize(("seed", "span"), [(1, 5), (2, 50), (3, 300)])
def test_the_walk_finds_exactly_the_close_pairs(reach: float, seed: int, span: float) -> None:
    boxes = boxes_of_all_forms(seed, 400, span)
    reaches = [reach * (1 + k % 7) for k in range(len(boxes))]
    found = close_pairs(boxes, reaches, [0] * len(boxes))
    assert found == among_all_pairs(boxes, reaches)
    assert found, "a test without close pairs tests nothing"


def test_touching_boxes_are_close() -> None:
    row: list[Box] = [((float(k), 0.0, 0.0), (k + 1.0, 1.0, 1.0)) for k in range(5)]
    assert close_pairs(row, [0.0] * 5, [0] * 5) == [(0, 1), (1, 2), (2, 3), (3, 4)]


@pytest.mark.parametrize("gap", [0.1, 0.3, 1e-17, 7.0 / 3])
def test_boxes_just_as_far_apart_as_they_reach_are_close(gap: float) -> None:
    """The reaches are rounded, and so are the boxes grown by them."""
    low = 1.0 + gap
    boxes: list[Box] = [UNIT, ((low, 0.0, 0.0), (low + 1, 1.0, 1.0))]
    asked = box_gap(*boxes)
    third = asked / 3
    for reach in ([asked, 0.0], [third, asked - third]):
        close = [(0, 1)] if asked <= reach[0] + reach[1] else []
        assert close_pairs(boxes, reach, [0, 0]) == close
    beyond = math.nextafter(asked, 0.0) if asked else 0.0
    assert close_pairs(boxes, [beyond, 0.0], [0, 0]) == ([] if asked else [(0, 1)])


def test_exempt_pairs_are_left_out() -> None:
    boxes = boxes_of_all_forms(4, 300, 20)
    source = random.Random(5)
    kinds = [source.randrange(6) for _ in boxes]
    exempt_kinds = [(0, 0), (1, 3), (4, 4), (2, 5)]
    every = close_pairs(boxes, [0.0] * 300, kinds)
    exempt = [*every[::7], (0, 299)]
    found = close_pairs(boxes, [0.0] * 300, kinds, exempt_kinds, exempt)
    assert found == [
        (i, j)
        for i, j in every
        if (i, j) not in exempt and tuple(sorted((kinds[i], kinds[j]))) not in exempt_kinds
    ]
    assert len(found) < len(every) - len(every) // 7


def test_a_crowd_of_one_kind_is_no_pair() -> None:
    """More boxes in one place than all their pairs could be gone through."""
    crowd = [UNIT] * 200_000
    kinds = [1] * (len(crowd) - 1) + [2]
    assert len(close_pairs(crowd, [0.0] * len(crowd), kinds, [(1, 1)])) == len(crowd) - 1


def test_one_box_has_no_pair() -> None:
    assert close_pairs([UNIT], [0.0], [0]) == []
    assert close_pairs([], [], []) == []


def test_lengths_have_to_agree() -> None:
    with pytest.raises(ValueError, match="differ in length"):
        close_pairs([UNIT], [0.0, 0.0], [0])


def test_pairs_need_memory_only_as_they_are_taken() -> None:
    """A report stops long before the last pair of a crowd."""
    crowd = [UNIT] * 3000
    tracemalloc.start()
    try:
        found = ClosePairs(crowd, [0.0] * len(crowd), [0] * len(crowd))
        assert len(found.take(10)) == 10
        assert found.count() == len(crowd) * (len(crowd) - 1) // 2
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < found.count()  # less than a byte for each pair


@pytest.mark.parametrize("exempt_kinds", [[], [(0, 0)], [(0, 1)], [(0, 0), (1, 2)]])
def test_pairs_of_heaps_are_counted(exempt_kinds: list[tuple[int, int]]) -> None:
    """Boxes of three kinds in heaps, as moved copies; some heaps touch, some are a reach apart."""
    source = random.Random(len(exempt_kinds))
    boxes = [box_at([2.0 * source.randrange(3), 0.0, 0.0], [2.0] * 3) for _ in range(150)]
    kinds = sorted(source.randrange(3) for _ in boxes)
    reach = [source.choice([0.0, 1.0]) for _ in boxes]
    found = close_pairs(boxes, reach, kinds, exempt_kinds)
    close = among_all_pairs(boxes, reach)
    assert found == [(i, j) for i, j in close if (kinds[i], kinds[j]) not in exempt_kinds]
