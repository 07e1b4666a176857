"""Lengths as options: what is no length, or has no meaning, is wrong usage."""

from __future__ import annotations

import click
import pytest

from satcheck.cli.option import in_units_of, length


def test_a_length_with_a_unit() -> None:
    assert in_units_of(length("5mm"), "m", "--clearance") == 0.005


def test_what_is_no_length_is_wrong_usage() -> None:
    with pytest.raises(click.BadParameter, match="not a length"):
        length("5 parsec")


@pytest.mark.parametrize("declared", [None, "furlong", "mm (the file may differ)"])
def test_a_suffix_needs_known_units(declared: str | None) -> None:
    with pytest.raises(click.UsageError, match="--clearance 5mm"):
        in_units_of(length("5mm"), declared, "--clearance")
