"""Which declarations name a unit, and what lengths mean in it."""

from __future__ import annotations

import pytest

from satcheck.scene.units import MICROMETRES, Length, is_unit, parse_length


@pytest.mark.parametrize("text", ["mm", "Metres", " inches ", "m (assumed)", "mm(file)", "feet"])
def test_known(text):
    assert is_unit(text)


@pytest.mark.parametrize("text", ["furlong", "(mm)", "millimters", "s", " "])
def test_unknown(text):
    assert not is_unit(text)


def test_every_unit_of_a_length_can_be_declared():
    assert all(map(is_unit, MICROMETRES))


@pytest.mark.parametrize(
    ("text", "value", "unit"),
    [
        *(("0.5", 0.5, None), ("2mm", 2.0, "mm"), ("1e-3m", 1e-3, "m"), (" 3 IN ", 3.0, "in")),
        *((".5", 0.5, None), ("1.", 1.0, None), ("+2E+1um", 20.0, "um")),
    ],
)
def test_length_as_written(text, value, unit):
    assert parse_length(text) == Length(value, unit)


@pytest.mark.parametrize(
    "text",
    ["", "mm", "-1", "-1mm", "nan", "inf", "1e999", "5 parsec", "1,5", "1_000", "e5", ".", "1 2"],
)
def test_what_is_no_length_is_refused(text):
    with pytest.raises(ValueError, match="not a length"):
        parse_length(text)


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
def test_length_in_declared_units(text, declared, value):
    assert parse_length(text).in_units_of(declared) == value


@pytest.mark.parametrize("declared", [None, "furlong", "mm (the file may differ)"])
def test_a_suffix_needs_known_units(declared):
    with pytest.raises(ValueError, match=r"5mm: .* so give a plain number"):
        parse_length("5mm").in_units_of(declared)
