"""Errors of signed distances, and what counts as right."""

from __future__ import annotations

import pytest

from satcheck.audit.tradeoff.result import Figure, Truth
from satcheck.report.report import Relation

DEEP = Truth("penetrating", Figure(-2.0, -2.0, -1.5), pad=1e-9)


@pytest.mark.parametrize(
    ("value", "error"),
    [(-3.0, -1.0), (-2.0, 0.0), (-1.75, 0.0), (-1.0, 0.5), (0.5, 2.0), (-2.0 - 1e-10, 0.0)],
)
def test_the_error_is_to_the_nearest_value_that_is_possible(value: float, error: float) -> None:
    assert DEEP.error(Figure(value, value, None)) == error


def test_without_bounds_on_both_sides_there_is_no_error() -> None:
    said = Figure(-1.0, -1.0, -1.0)
    assert Truth("separated", Figure(1.0, 1.0, None), 0.0).error(said) is None
    assert Truth("separated", None, 0.0).error(said) is None
    assert DEEP.error(None) is None


def test_a_thickness_is_off_by_what_it_is_beyond_the_true_interval() -> None:
    truth = Truth("penetrating", None, 1e-9, thickness=Figure(0.5, 0.25, 0.5))
    for value, error in ((0.125, -0.125), (0.25, 0.0), (0.5, 0.0), (2.0, 1.5)):
        assert truth.thickness_error(Figure(value, None, value)) == error
    assert truth.thickness_error(None) is None
    assert DEEP.thickness_error(Figure(1.0, None, 1.0)) is None


@pytest.mark.parametrize(
    ("truth", "overlap", "relation", "right"),
    [
        ("penetrating", True, "penetrating", True),
        ("inside", True, "penetrating", True),
        ("separated", True, "penetrating", False),
        ("touching", True, "penetrating", False),
        ("separated", False, "separated", True),
        ("touching", False, "separated", False),
        ("touching", False, None, True),
        ("penetrating", False, None, False),
        ("penetrating", None, "indeterminate", None),
        (None, True, "penetrating", None),
    ],
)
def test_right_is_what_agrees_about_the_overlap_and_else_about_the_relation(
    truth: Relation | None, overlap: bool | None, relation: Relation | None, right: bool | None
) -> None:
    assert Truth(truth, None, 0.0).is_right(overlap, relation) is right
