"""The settings of a check in a report."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Length, Value

Accuracy = Literal["aabb", "obb", "hull", "parts", "exact"]
Method = Literal["auto", "sat", "gjk"]
Plane = Literal["xy", "yz", "xz"]


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
    fail_on: Literal["error", "warning", "note"]
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
