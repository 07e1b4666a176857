"""Quartiles by hand."""

from __future__ import annotations

from bench.accuracy.spread import Spread, spread


def test_quartiles_lie_between_the_values() -> None:
    assert spread([4, 1, 3, 2]) == Spread(4, 1, 1.75, 2.5, 3.25, 4)
    assert spread(iter([1, 2, 3, 4, 5])) == Spread(5, 1, 2, 3, 4, 5)


def test_one_value_is_all_of_them_and_none_is_none() -> None:
    assert spread([7.0]) == Spread(1, 7.0, 7.0, 7.0, 7.0, 7.0)
    assert spread([]) is None
