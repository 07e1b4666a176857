"""Lengths on the command line: `0.5` is in the units of the files, `5mm` needs declared units."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.cli.refusals import wrong_usage

if TYPE_CHECKING:
    from satcheck.scene.units import Length


def length(text: str) -> Length:
    """A click parameter type; click.BadParameter for what is not a length."""
    import click

    from satcheck.scene.units import parse_length

    try:
        return parse_length(text)
    except ValueError as error:
        raise click.BadParameter(str(error)) from None


def in_units_of(given: Length, declared: str | None, option: str) -> float:
    """The length in the declared units of the scene; click.UsageError if they are unknown."""
    try:
        return given.in_units_of(declared)
    except ValueError as error:
        raise wrong_usage(f"{option} {error}, or state the unit with --units") from None
