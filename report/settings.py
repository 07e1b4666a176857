"""Settings that can change an answer, as a report states them: the settings of a check, the options
of a config file, and how files were read where their format leaves a choice."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from msgspec import Meta

from satcheck.report.values import Count, Length, Size, Value

Accuracy = Literal["aabb", "obb", "hull", "parts", "exact"]
FailOn = Literal["error", "warning", "note"]
Method = Literal["auto", "sat", "gjk"]
Plane = Literal["xy", "yz", "xz"]
OptionValue = bool | int | float | str | tuple[str, ...]


class StatedSettings(Value, frozen=True, kw_only=True):
    """The settings that can change an answer."""

    depth: bool
    thickness: bool
    volume: bool
    volume_seconds: Length
    volume_megabytes: Count
    contacts: bool
    contact_points: Count
    components: bool
    clearance: Length | None
    tolerance: Length | Literal["input-precision"]
    surface_tolerance: Length | None
    accuracy: Accuracy
    method: Method
    fail_on: FailOn
    accept: tuple[str, ...]
    allow_open: bool
    cross_check: bool
    planar: Plane | None
    list_pruned: bool | None
    depth_width: Length
    depth_budget: Length
    thickness_width: Length
    part_threshold: Length
    part_seed: int
    part_seconds: Length
    part_megabytes: Count
    seconds_per_file: Length
    megabytes_per_file: Count


class StatedConfig(Value, frozen=True):
    """file: the config file, relative to the folder of the command. options: each that it sets and
    the command line does not, by its name without the dashes, as the file has it."""

    file: str
    options: Annotated[Mapping[str, OptionValue], Meta(min_length=1)]


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
