"""What the user chooses where the format of a file leaves a choice of geometry."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Literal

from msgspec import Struct, convert
from msgspec.structs import replace

GeometryKind = Literal["collision", "visual"]
Purpose = Literal["render", "proxy", "guide"]

# The options that count for files of a format.
OPTIONS_OF: dict[str, tuple[str, ...]] = {
    "glb": ("time",),
    "gltf": ("time",),
    "usd": ("time", "geometry", "purpose"),
    "step": ("chord_tolerance", "angular_tolerance"),
}
# Press fits of 0.02 mm are common. Facets hide overlaps up to twice their tolerance.
CHORD_TOLERANCE = 0.005  # mm
ANGULAR_TOLERANCE = 0.5  # radians


class ReadOptions(Struct, frozen=True):
    """Options for reading files. They decide the geometry of a check, so a report states them, and
    whoever reads the same files again needs the same options.

    time: of animations, in seconds, in USD a time code; None: the pose that the file stores, in USD
    the first samples. geometry: collision: the colliders of a simulation are bodies; visual or
    None: what is drawn. purpose: of the prims that are drawn, beside those without a purpose; None:
    render. mesh_hulls: the collision meshes of MJCF files are convex hulls; the parts that bodies
    name say so. chord_tolerance: how far facets may be off a curved face for which a reader makes
    them, in millimetres. angular_tolerance: the largest angle between neighbouring facets of such a
    face, in radians.
    """

    time: float | None = None
    geometry: GeometryKind | None = None
    purpose: tuple[Purpose, ...] | None = None
    mesh_hulls: bool | None = None
    chord_tolerance: float = CHORD_TOLERANCE
    angular_tolerance: float = ANGULAR_TOLERANCE

    def beside(self, stated: Mapping[str, Any]) -> ReadOptions:
        """These options, those that have their default as stated."""
        free = {name for name in stated if getattr(self, name) == getattr(_DEFAULTS, name)}
        return replace(self, **{name: stated[name] for name in free})

    def changed(self, formats: Iterable[str]) -> dict[str, Any]:
        """The options that count for files of these formats and differ from their defaults."""
        return {
            name: value
            for name, value in (self.stated(formats) or {}).items()
            if value != getattr(_DEFAULTS, name)
        }

    def stated(self, formats: Iterable[str]) -> dict[str, Any] | None:
        """The options that count for files of these formats, by name; None: no option counts."""
        names = {name for each in formats for name in OPTIONS_OF.get(each, ())}
        values = {name: getattr(self, name) for name in names}
        return values if any(value is not None for value in values.values()) else None


_DEFAULTS = ReadOptions()


def as_stated(stated: Mapping[str, Any] | None) -> ReadOptions:
    """The options as a report states them."""
    return convert({k: v for k, v in (stated or {}).items() if v is not None}, ReadOptions)
