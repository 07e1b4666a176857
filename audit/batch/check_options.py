"""Options for reading and checking worlds: what a process needs to know about the call."""

from __future__ import annotations

from collections.abc import Mapping

from satcheck.audit import Settings
from satcheck.audit.request.in_units import settings_in_units
from satcheck.core.errors import SatcheckError
from satcheck.report.settings import StatedConfig
from satcheck.scene import Scene
from satcheck.scene.loader import LoadOptions
from satcheck.scene.units import Length

# The files of a world, in the order in which they are read; the first one names it.
World = tuple[str, ...]
SettingValue = bool | int | float | str | tuple[str, ...] | Length | None


class CheckOptions(LoadOptions, frozen=True, kw_only=True):
    """settings: values of `audit.Settings` by name, lengths as given. names: what messages call
    these lengths. places: state where scene files name the bodies of findings. baseline: a file of
    known findings. config: what a report states of a config file."""

    settings: Mapping[str, SettingValue] = {}
    names: Mapping[str, str] = {}
    places: bool = True
    baseline: str | None = None
    config: StatedConfig | None = None

    def settings_for(self, scene: Scene) -> Settings:
        """Lengths are in the units of the scene. Raises SatcheckError (`bad-setting`)."""
        try:
            return settings_in_units(self.settings, scene, self.names)
        except ValueError as error:
            raise SatcheckError("bad-setting", str(error)) from None
