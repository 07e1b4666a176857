"""Choices of the user where the format of a file leaves a choice of geometry."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Literal

from msgspec import Struct, convert
from msgspec.structs import replace

GeometryKind = Literal["collision", "visual"]
Purpose = Literal["render", "proxy", "guide"]

# The options that count for files of a format.
OPTIONS_OF: dict[str, tuple[str, ...]] = {
    "usd": ("time", "geometry", "purpose"),
    "glb": ("geometry",),
    "gltf": ("geometry",),
    "step": ("chord_tolerance", "angular_tolerance"),
    "ifc": ("chord_tolerance", "angular_tolerance"),
}
# Of each format, in mm. In machines press fits of 0.02 mm are common, and facets hide overlaps up
# to twice their tolerance. Buildings are drawn to about 1 mm.
CHORD_TOLERANCES = {"step": 0.005, "ifc": 1.0}
ANGULAR_TOLERANCE = 0.5  # radians


class ReadOptions(Struct, frozen=True):
    """Options for reading files. They decide the geometry of a check, so a report states them, and
    whoever reads the same files again needs the same options.

    time: the time code of USD files; None: their first samples. geometry: collision: the colliders
    of a simulation are bodies; visual or None: what is drawn. purpose: of the prims that are drawn,
    beside those without a purpose; None: render. mesh_hulls: the collision meshes of MJCF files are
    convex hulls; the parts that bodies name say so. chord_tolerance: how far facets may be off a
    curved face for which a reader makes them, in millimetres; None: as in `CHORD_TOLERANCES`.
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

    def changed(self, formats: Iterable[str]) -> dict[str, Any]:
        """The options that count for files of these formats and differ from their defaults."""
        values = {name: getattr(self, name) for name in _names(formats)}
        return {k: value for k, value in values.items() if value != getattr(_DEFAULTS, k)}

    def chord_of(self, file_format: str) -> float:
        """The chord tolerance of a format, in millimetres."""
        own = self.chord_tolerance
        return CHORD_TOLERANCES[file_format] if own is None else own

    def stated(self, formats: Iterable[str]) -> dict[str, Any] | None:
        """The options that count for files of these formats, by name; None: no option counts. The
        chord tolerance is None if these formats have different ones."""
        formats = set(formats)
        values = {name: getattr(self, name) for name in _names(formats)}
        chords = {self.chord_of(each) for each in formats & CHORD_TOLERANCES.keys()}
        if len(chords) == 1:
            values["chord_tolerance"] = chords.pop()
        return values if any(value is not None for value in values.values()) else None


_DEFAULTS = ReadOptions()


def _names(formats: Iterable[str]) -> set[str]:
    return {name for each in formats for name in OPTIONS_OF.get(each, ())}


def as_stated(stated: Mapping[str, Any] | None) -> ReadOptions:
    """The options as a report states them."""
    return convert({k: v for k, v in (stated or {}).items() if v is not None}, ReadOptions)
