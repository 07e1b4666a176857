"""Choices of the user where the format of a file leaves a choice of geometry."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Literal

from msgspec import Struct, convert
from msgspec.structs import replace

GeometryKind = Literal["collision", "visual"]
Purpose = Literal["render", "proxy", "guide"]

ANGULAR_TOLERANCE = 0.5  # radians


class ReadOptions(Struct, frozen=True):
    """Options for reading files. They decide the geometry of a check, so a report states them, and
    whoever reads the same files again needs the same options.

    time: the time code of USD files; None: their first samples. geometry: collision: the colliders
    of a simulation are bodies; visual or None: what is drawn. purpose: of the prims that are drawn,
    beside those without a purpose; None: render. mesh_hulls: the collision meshes of MJCF files are
    convex hulls; the parts that bodies name say so. chord_tolerance: how far facets may be off a
    curved face for which a reader makes them, in millimetres; None: as the format has it.
    angular_tolerance: the largest angle between neighbouring facets of such a face, in radians.
    """

    time: float | None = None
    geometry: GeometryKind | None = None
    purpose: tuple[Purpose, ...] | None = None
    mesh_hulls: bool | None = None
    chord_tolerance: float | None = None
    angular_tolerance: float = ANGULAR_TOLERANCE

    def beside(self, stated: Mapping[str, Any]) -> ReadOptions:
        """These options, those that have their default as stated."""
        free = {name for name in stated if getattr(self, name) == getattr(_DEFAULTS, name)}
        return replace(self, **{name: stated[name] for name in free})

    def chord(self, default: float) -> float:
        """Return the chord tolerance. default: of the format. Both in millimetres."""
        return default if self.chord_tolerance is None else self.chord_tolerance

    def named(self, names: Iterable[str]) -> dict[str, Any]:
        """Return the options of these names."""
        return {name: getattr(self, name) for name in names}

    def changed(self, names: Iterable[str]) -> dict[str, Any]:
        """Return those of these names that differ from their defaults."""
        values = self.named(names)
        return {k: value for k, value in values.items() if value != getattr(_DEFAULTS, k)}


_DEFAULTS = ReadOptions()


def as_stated(stated: Mapping[str, Any] | None) -> ReadOptions:
    """The options as a report states them."""
    return convert({k: v for k, v in (stated or {}).items() if v is not None}, ReadOptions)
