"""How worlds are read: the options of `load_scene` that a call gives for all its worlds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from msgspec import Struct

from satcheck.scene import Scene, load_scene
from satcheck.scene.known_meshes import KnownMeshes
from satcheck.scene.mesh_files import DEFAULT_MEGABYTES_PER_FILE, DEFAULT_SECONDS_PER_FILE
from satcheck.scene.read_options import GeometryKind, ReadOptions
from satcheck.scene.scene_builder import Split


class LoadOptions(Struct, frozen=True, kw_only=True):
    """As in `load_scene`."""

    split: Split | None = None
    packages: Mapping[str, str] | None = None
    geometry: GeometryKind | None = None
    folders: tuple[str, ...] = ()
    allow_outside: bool = False
    units: str | None = None
    rules: tuple[str, ...] = ()
    between: tuple[tuple[str, str], ...] = ()
    reading: ReadOptions = ReadOptions()
    seconds_per_file: float = DEFAULT_SECONDS_PER_FILE
    megabytes_per_file: int = DEFAULT_MEGABYTES_PER_FILE

    def load(
        self, files: Sequence[str], *, hashed: bool = True, known: KnownMeshes | None = None
    ) -> Scene:
        """hashed, known: as in `load_scene`. Raises what `load_scene` raises."""
        return load_scene(
            files,
            split=self.split,
            packages=self.packages,
            geometry=self.geometry,
            folders=self.folders,
            allow_outside=self.allow_outside,
            units=self.units,
            hashed=hashed,
            known=known,
            rules=self.rules,
            between=self.between,
            reading=self.reading,
            seconds_per_file=self.seconds_per_file,
            megabytes_per_file=self.megabytes_per_file,
        )
