"""When a rung is faster than another by more than chance."""

from __future__ import annotations

from satcheck.studies.tradeoff import Times


def test_faster_is_what_lies_below_the_middle_half_of_the_other() -> None:
    quick, slow = Times((1.0, 1.1, 1.2, 1.3, 9.0)), Times((2.0, 1.9, 2.2, 0.1, 2.1))
    assert quick.is_below(slow)  # one slow run of the one, one fast run of the other
    assert not slow.is_below(quick)


def test_what_overlaps_is_neither() -> None:
    one, other = Times((1.0, 1.1, 1.2, 1.3, 1.4)), Times((1.1, 1.2, 1.3, 1.4, 1.5))
    assert not one.is_below(other)
    assert not other.is_below(one)
    assert not one.is_below(one)


def test_single_runs_are_compared_as_they_are() -> None:
    assert Times((1.0,)).is_below(Times((1.1,)))
    assert not Times((1.1,)).is_below(Times((1.0,)))


def test_the_document_has_microseconds() -> None:
    found = Times((0.5, 0.25, 1.0)).to_dict()
    assert found == {"median": 5e5, "low": 2.5e5, "high": 1e6, "runs": 3}
