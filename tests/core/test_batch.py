"""The batched entry point: the same answers as one by one, the same bits at any thread count."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
import pytest
from numpy.typing import NDArray

from satcheck.core import (
    OUTCOMES,
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Hull,
    Sphere,
    check_pair,
    check_pairs,
)
from tests.oracles.random_shapes import Points, pose, random_hull, random_quaternion

PAIRS = 400
NUMBERS = ("distance", "lower", "upper", "normal", "witness_a", "witness_b")
COUNTS = ("portal_rounds", "gjk_iterations", "epa_iterations", "axes_tested")


Indices = NDArray[np.uint32]
Query = Literal["overlap", "depth", "distance"]
QUERIES: tuple[Query, ...] = ("overlap", "depth", "distance")


def scene() -> tuple[list[Any], Indices, Indices, Points, Points]:
    rng = np.random.default_rng(1)
    shapes: list[Any] = [Hull(random_hull(rng, n)) for n in (1, 4, 7, 12, 30, 90)]
    shapes += [Box((0.5, 0.3, 0.7)), Sphere(0.5), Capsule(0.2, 0.4), Cylinder(0.4, 0.5)]
    shapes += [Cone(0.5, 0.4), Ellipsoid((0.3, 0.5, 0.7))]
    index = rng.integers(len(shapes), size=(2, PAIRS)).astype(np.uint32)
    poses = np.array(
        [
            [pose(rng.normal(size=3) * 0.5, random_quaternion(rng)) for _ in range(PAIRS)]
            for _ in "ab"
        ]
    )
    return shapes, index[0], index[1], poses[0], poses[1]


@pytest.mark.parametrize("query", QUERIES)
def test_any_thread_count_gives_the_same_bits(query: Query) -> None:
    inputs = scene()
    one = check_pairs(*inputs, query=query, threads=1)
    for threads in (0, 2, 8):
        many = check_pairs(*inputs, query=query, threads=threads)
        for name in ("outcome", *NUMBERS, *COUNTS):
            assert getattr(one, name).tobytes() == getattr(many, name).tobytes()


@pytest.mark.parametrize("query", QUERIES)
def test_batch_equals_one_by_one(query: Query) -> None:
    shapes, index_a, index_b, poses_a, poses_b = scene()
    batch = check_pairs(shapes, index_a, index_b, poses_a, poses_b, query=query)
    for i in range(PAIRS):
        single = check_pair(
            shapes[index_a[i]],
            shapes[index_b[i]],
            tuple(poses_a[i].tolist()),
            tuple(poses_b[i].tolist()),
            query=query,
        )
        assert OUTCOMES[batch.outcome[i]] == single.outcome
        for name in COUNTS:
            assert getattr(batch, name)[i] == getattr(single, name)
        if query == "overlap":
            assert single.distance is None
            assert math.isnan(batch.distance[i])
            continue
        for name in NUMBERS:
            assert getattr(batch, name)[i].tolist() == pytest.approx(getattr(single, name), abs=0)


def test_overlapping_and_separated_pairs_are_both_there() -> None:
    outcome = check_pairs(*scene(), query="overlap").outcome
    names, counts = np.unique(np.array(OUTCOMES)[outcome], return_counts=True)
    assert dict(zip(names.tolist(), (counts > PAIRS // 10).tolist(), strict=True)) == {
        "penetrating": True,
        "separated": True,
    }


def test_arrays_are_whole_read_only_and_outlive_the_results() -> None:
    found = check_pairs(*scene(), query="depth")
    for name in ("outcome", "method", *NUMBERS, *COUNTS):
        assert getattr(found, name).flags.c_contiguous
        assert not getattr(found, name).flags.writeable
    normal, copy = found.normal, np.array(found.normal)
    del found
    check_pairs(*scene(), query="depth")  # would be where the results were
    assert normal.tobytes() == copy.tobytes()


def test_what_was_not_asked_for_is_nan() -> None:
    found = check_pairs(*scene(), query="overlap")
    for name in NUMBERS:
        values = getattr(found, name)
        assert values.shape[0] == PAIRS
        assert values.dtype == np.float64
        assert np.isnan(values).all()
        assert not values.flags.writeable


def test_no_pairs_at_all() -> None:
    none = np.empty(0, np.uint32)
    for query in QUERIES:
        found = check_pairs(
            [Sphere(1.0)], none, none, np.empty((0, 7)), np.empty((0, 7)), query=query
        )
        assert len(found) == 0
        assert found.outcome.shape == found.distance.shape == (0,)
        assert found.normal.shape == (0, 3)


def bad_batches() -> list[tuple[Any, ...]]:
    still = np.array([[0.0, 0, 0, 0, 0, 0, 1]])
    zero, one = np.zeros(1, np.uint32), np.ones(1, np.uint32)
    shapes = [Sphere(1.0)]
    return [
        (shapes, one, zero, still, still),  # index out of range
        (shapes, zero, one, still, still),
        (shapes, np.zeros(2, np.uint32), zero, still, still),  # lengths differ
        (shapes, zero, zero, np.zeros((2, 7)), still),
        (shapes, zero, zero, still[:, :6], still),  # not seven numbers
        (shapes, zero, zero, still * math.nan, still),
        (shapes, zero, zero, still * 0, still),  # no rotation
    ]


@pytest.mark.parametrize("batch", bad_batches())
def test_nonsense_is_refused(batch: tuple[Any, ...]) -> None:
    with pytest.raises((ValueError, IndexError, TypeError), match=r"\w"):
        check_pairs(*batch)
