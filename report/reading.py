"""How the files of a report were read, where their format leaves a choice."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Size, Value


class StatedReading(Value, frozen=True, kw_only=True):
    """The options that count for the formats of these files; None: no such file, or the default.

    time: the time code of USD; None: the first samples. geometry: of USD, "collision" or "visual".
    purpose: of the prims of USD that are drawn, beside those without a purpose. chord_tolerance: of
    the facets of curved faces in STEP and IFC files, in millimetres; None beside such files: that
    of each format. angular_tolerance: of the same, in radians.
    """

    time: float | None = None
    geometry: Literal["collision", "visual"] | None = None
    purpose: tuple[Literal["render", "proxy", "guide"], ...] | None = None
    chord_tolerance: Size | None = None
    angular_tolerance: Size | None = None
