"""Lengths that a user gives, in the units of the scene that they are about."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from satcheck.audit.request.settings import Settings
from satcheck.scene import Scene
from satcheck.scene.units import Length, unit_of

# The scenes of a batch have the same settings.
_settings = lru_cache(maxsize=8, typed=True)(Settings)


def settings_in_units(
    values: Mapping[str, Any], scene: Scene, names: Mapping[str, str]
) -> Settings:
    """values: of the fields of Settings by name; a Length is converted to the units of the scene.
    A body alone has no pair that a length could be about: its units do not matter. names: what a
    message calls these values.

    Raises ValueError if the units of the scene are unknown, and what Settings raises.
    """
    lengths = {name: value for name, value in values.items() if isinstance(value, Length)}
    plain = {name: value for name, value in values.items() if name not in lengths}
    if len(scene.bodies) + len(scene.unreadable) > 1 or unit_of(scene.units):
        for name, value in lengths.items():
            plain[name] = length_in_units(value, scene.units, names[name])
    return _settings(**plain)


def length_in_units(value: Length, declared: str | None, name: str) -> float:
    """The length in the declared units of a scene; ValueError if they are unknown."""
    try:
        return value.in_units_of(declared)
    except ValueError as error:
        raise ValueError(f"{name} {error}, or state the unit with --units") from None
