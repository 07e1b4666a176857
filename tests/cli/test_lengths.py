"""Lengths as typed, and as the scene's units make of them."""

from __future__ import annotations

import click
import pytest

from satcheck.cli.lengths import Length, length


@pytest.mark.parametrize(
    ("text", "value", "unit"),
    [("0.5", 0.5, None), ("2mm", 2.0, "mm"), ("1e-3m", 1e-3, "m"), (" 3 IN ", 3.0, "in")],
)
def test_length_as_typed(text: str, value: float, unit: str | None) -> None:
    assert length(text) == Length(value, unit)


@pytest.mark.parametrize("text", ["", "mm", "-1", "-1mm", "nan", "inf", "1e999", "5 parsec", "1,5"])
def test_what_is_no_length_is_refused(text: str) -> None:
    with pytest.raises(click.BadParameter, match="not a length"):
        length(text)


@pytest.mark.parametrize(
    ("text", "declared", "value"),
    [
        ("5mm", "m", 0.005),
        ("0.5in", "mm", 12.7),
        ("1ft", "in", 12.0),
        ("3um", "mm", 0.003),
        ("2cm", "millimeters", 20.0),
        ("7", None, 7.0),
        ("7", "furlong", 7.0),
    ],
)
def test_length_in_the_units_of_the_scene(text: str, declared: str | None, value: float) -> None:
    assert length(text).in_units_of(declared, "--clearance") == value


@pytest.mark.parametrize("declared", [None, "furlong", "mm (the file may differ)"])
def test_a_suffix_needs_known_units(declared: str | None) -> None:
    with pytest.raises(click.UsageError, match="--clearance 5mm"):
        length("5mm").in_units_of(declared, "--clearance")
