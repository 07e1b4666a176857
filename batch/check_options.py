"""How the worlds of a batch are read and checked: what a process needs to know about the call."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import Struct

from satcheck.audit import Settings
from satcheck.audit.request.in_units import settings_in_units
from satcheck.core.errors import SatcheckError
from satcheck.report.config import StatedConfig
from satcheck.scene import Scene, load_scene
from satcheck.scene.input_kind import GeometryKind
from satcheck.scene.known_meshes import KnownMeshes
from satcheck.scene.mesh_files import DEFAULT_MEGABYTES_PER_FILE, DEFAULT_SECONDS_PER_FILE
from satcheck.scene.read_options import ReadOptions
from satcheck.scene.scene_builder import Split
from satcheck.scene.units import Length

# The files of a world, in the order in which they are read; the first one names it.
World = tuple[str, ...]
SettingValue = bool | int | float | str | Length | None


class CheckOptions(Struct, frozen=True, kw_only=True):
    """split, packages, geometry, allow_outside, units, rules, reading, seconds_per_file,
    megabytes_per_file: as in `load_scene`. settings: values of `audit.Settings` by name, lengths as
    given. names: what messages call these lengths. places: state where scene files name the bodies
    of findings. baseline: a file of known findings. config: what a report states of a config
    file."""

    split: Split | None = None
    packages: Mapping[str, str] | None = None
    geometry: GeometryKind = "collision"
    allow_outside: bool = False
    units: str | None = None
    rules: tuple[str, ...] = ()
    reading: ReadOptions = ReadOptions()
    seconds_per_file: float = DEFAULT_SECONDS_PER_FILE
    megabytes_per_file: int = DEFAULT_MEGABYTES_PER_FILE
    settings: Mapping[str, SettingValue] = {}
    names: Mapping[str, str] = {}
    places: bool = True
    baseline: str | None = None
    config: StatedConfig | None = None

    def load(self, world: World, *, hashed: bool = True, known: KnownMeshes | None = None) -> Scene:
        """hashed, known: as in `load_scene`. Raises what `load_scene` raises."""
        return load_scene(
            world,
            split=self.split,
            packages=self.packages,
            geometry=self.geometry,
            allow_outside=self.allow_outside,
            units=self.units,
            hashed=hashed,
            known=known,
            rules=self.rules,
            reading=self.reading,
            seconds_per_file=self.seconds_per_file,
            megabytes_per_file=self.megabytes_per_file,
        )

    def settings_for(self, scene: Scene) -> Settings:
        """Lengths are in the units of the scene. Raises SatcheckError (`bad-setting`)."""
        try:
            return settings_in_units(self.settings, scene, self.names)
        except ValueError as error:
            raise SatcheckError("bad-setting", str(error)) from None
