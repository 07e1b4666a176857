"""Placements of parts inside parts: their product, their names, and circles."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest

from satcheck.scene import Refused
from satcheck.scene.files.placing import instances, multiply, tidy_name

UNIT_ROUNDOFF = Fraction(1, 2**53)


def random_matrix(random):
    rows = [random.uniform(-4, 4) for _ in range(12)]
    return (*rows, 0.0, 0.0, 0.0, 1.0)


def exact_product(a, b):
    return [
        sum(Fraction(a[4 * row + k]) * Fraction(b[4 * k + column]) for k in range(4))
        for row in range(4)
        for column in range(4)
    ]


def magnitudes(a, b):
    return exact_product([abs(x) for x in a], [abs(x) for x in b])


def test_a_product_is_the_exact_one_up_to_rounding():
    """Of three products and at most three sums: relative to their magnitudes, at most 4 u each."""
    random = Random(1)
    for _ in range(200):
        a, b = random_matrix(random), random_matrix(random)
        for got, exact, size in zip(
            multiply(a, b), exact_product(a, b), magnitudes(a, b), strict=True
        ):
            assert abs(Fraction(got) - exact) <= size * ((1 + UNIT_ROUNDOFF) ** 4 - 1)


def test_nothing_is_rounded_where_nothing_is_to_be_done():
    matrix = random_matrix(Random(2))
    unit = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    assert multiply(None, matrix) == multiply(matrix, None) == matrix
    assert multiply(unit, matrix) == multiply(matrix, unit) == matrix
    assert multiply(None, None) is None


def names_of(graph, roots, only=""):
    found = instances(
        [(root, None) for root in roots],
        children=lambda key: [(child, None) for child in graph.get(key, [])],
        has_mesh=lambda key: key.startswith(only),
        name=lambda key: key.rstrip("0123456789"),
        kind="part",
    )
    return [instance.path for instance in found]


def test_instances_come_depth_first_in_the_order_given():
    graph = {"a1": ["b1", "c1", "b2"], "c1": ["b1"]}
    assert names_of(graph, ["a1", "b1", "a2"]) == ["a", "a/b", "a/c", "a/c/b", "a/b-2", "b", "a-2"]
    only_b = names_of(graph, ["a1"], only="b")
    assert only_b == ["a/b", "a/c/b", "a/b-2"]


@pytest.mark.parametrize("graph", [{"a": ["a"]}, {"a": ["b"], "b": ["c"], "c": ["b"]}])
def test_a_circle_is_refused(graph):
    with pytest.raises(Refused, match="contains itself") as caught:
        names_of(graph, ["a"])
    assert caught.value.code == "reference-cycle"


@pytest.mark.parametrize(
    ("name", "tidy"),
    [
        ("Wheel", "Wheel"),
        (" a\tb\n", "a b"),
        ("#3", "3"),
        ("Teil Nr. 7 (\u00fcber)", "Teil Nr. 7 (\u00fcber)"),
        ("\ud800", "x"),
        ("\x1b[31m", "[31m"),
        ("", "x"),
        (7, "x"),
        (None, "x"),
        ("n" * 500, "n" * 80),
    ],
)
def test_names_are_printable_and_short(name, tidy):
    assert tidy_name(name, "x") == tidy
