"""The options of a call for all its worlds: how they are read and checked, and their limits."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from msgspec import Struct

from satcheck.audit import Settings
from satcheck.audit.baseline import measuring
from satcheck.audit.settings import settings_in_units
from satcheck.core.errors import SatcheckError
from satcheck.report.settings import StatedConfig
from satcheck.scene import Scene
from satcheck.scene.loader import LoadOptions
from satcheck.scene.units import Length

# The files of a world, in the order in which they are read; the first one names it.
World = tuple[str, ...]
SettingValue = bool | int | float | str | tuple[str, ...] | Length | None
# A measured time is at least this long, as clocks are coarse.
_SHORTEST_SECONDS = 1e-3


def named_files(world: World) -> World:
    """Return the files that the world is called by, as an asset."""
    folder, *files = world
    has_foreign = files and all(Path(name).is_relative_to(folder) for name in files)
    return (folder,) if has_foreign else world  # files in it that no reader knows


def name_of(world: World) -> str:
    """Return what a report calls the world as an asset: its files."""
    return ", ".join(named_files(world))


class CheckOptions(LoadOptions, frozen=True, kw_only=True):
    """settings: values of `audit.Settings` by name, lengths as given. names: what messages call
    these lengths. baseline: a file of known findings. config: what a report states of a config
    file."""

    settings: Mapping[str, SettingValue] = {}
    names: Mapping[str, str] = {}
    baseline: str | None = None
    config: StatedConfig | None = None

    def settings_for(self, scene: Scene) -> Settings:
        """Lengths are in the units of the scene. Raises SatcheckError (`bad-setting`)."""
        try:
            settings = settings_in_units(self.settings, scene, self.names.__getitem__)
            return settings if self.baseline is None else measuring(settings)
        except ValueError as error:
            raise SatcheckError("bad-setting", str(error)) from None


class Limits(Struct, frozen=True):
    """For one world. seconds: wall-clock time. megabytes: address space of its process, in MiB."""

    seconds: float = 600.0
    megabytes: int = 4096


class Pace:
    """size: worlds that are sent together. It begins at 1, as the first world may take long, and at
    most doubles with each measure."""

    def __init__(self, largest: int) -> None:
        self._largest = largest
        self.size = 1

    def measure(self, worlds: int, took: float, wanted: float) -> None:
        """took, wanted: seconds, for these worlds and for the next ones."""
        fitting = round(worlds * wanted / max(took, _SHORTEST_SECONDS))
        self.size = max(1, min(2 * self.size, fitting, self._largest))
