"""Lengths in options: numbers with or without a unit, converted to the units of the scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import click
from msgspec.structs import replace

from satcheck.audit import Settings
from satcheck.audit.settings import length_in_units, settings_in_units
from satcheck.scene import Scene
from satcheck.scene.units import Length, parse_length


def length(text: str) -> Length:
    """A click parameter type; click.BadParameter for what is not a length."""
    try:
        return parse_length(text)
    except ValueError as error:
        raise click.BadParameter(str(error)) from None


def millimetres(text: str) -> float:
    """A click parameter type: a length > 0 of which a plain number is in millimetres."""
    given = length(str(text))
    value = replace(given, unit=given.unit or "mm").in_units_of("mm")
    if value == 0:
        raise click.BadParameter(f"{text!r} should be more than 0")
    return value


def in_units_of(value: Length, declared: str | None, option: str) -> float:
    """The length in the declared units of the scene; click.UsageError if they are unknown."""
    try:
        return length_in_units(value, declared, option)
    except ValueError as error:
        raise click.UsageError(str(error)) from None


def settings_of(options: Mapping[str, Any], scene: Scene) -> Settings:
    """options: values of fields of Settings; a Length is converted to the units of the scene."""
    try:
        return settings_in_units(options, scene, names_of_lengths(options))
    except ValueError as error:
        raise click.UsageError(str(error)) from None


def names_of_lengths(options: Mapping[str, Any]) -> dict[str, str]:
    """What the user wrote for each length: `--clearance`, or `satcheck.toml:1: clearance`."""
    return {name: _origin(name) for name, value in options.items() if isinstance(value, Length)}


def _origin(name: str) -> str:
    from satcheck.cli.config import origin

    ctx = click.get_current_context(silent=True)
    return (ctx and origin(ctx, name)) or f"--{name.replace('_', '-')}"
