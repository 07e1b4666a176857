"""What the user chooses where the format of a file leaves a choice of geometry."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from msgspec import Struct

# The options that count for files of a format.
OPTIONS_OF: dict[str, tuple[str, ...]] = {
    "glb": ("time",),
    "gltf": ("time",),
}


class ReadOptions(Struct, frozen=True):
    """Options for reading files. They decide the geometry of a check, so a report states them, and
    whoever reads the same files again needs the same options.

    time: of animations, in seconds; None: the pose that the file stores.
    """

    time: float | None = None

    def stated(self, formats: Iterable[str]) -> dict[str, Any] | None:
        """The options that count for files of these formats, by name; None: no option counts."""
        names = {name for each in formats for name in OPTIONS_OF.get(each, ())}
        values = {name: getattr(self, name) for name in names}
        return values if any(value is not None for value in values.values()) else None


def as_stated(stated: Mapping[str, Any] | None) -> ReadOptions:
    """The options as a report states them."""
    return ReadOptions(**{k: v for k, v in (stated or {}).items() if v is not None})
