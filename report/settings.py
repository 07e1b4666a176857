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


# More than 0, less than 1.
Width = Annotated[float, Meta(gt=0, lt=1)]
# Seconds of a slow machine.
MOST_BUDGET = 86400.0
Budget = Annotated[float, Meta(gt=0, le=MOST_BUDGET)]


class StatedSettings(Value, frozen=True, kw_only=True):
    """The settings that can change an answer. Lengths are in the units of the files. None means
    "not computed" unless said otherwise.

    depth: depth and MTV of overlapping pairs; None: for mesh files always, in a scene only if a
    rule requests it. thickness: of overlapping pairs; None: whenever `depth` requests the depth. A
    report says whether they are computed for every overlap.
    volume: the volume that bodies have in common; volume_*: limits for one pair.
    contacts: where surfaces meet; contact_points: the most points listed for a pair.
    components: the connected components of each overlap, with their thickness.
    clearance: the gap that bodies must keep; pairs closer than this are `near`.
    tolerance: half width of the touch band; None: the input precision of each pair.
    surface_tolerance: how far surfaces may be off, for bodies whose scene does not state it; None:
    0, or the chord tolerance of facets that a reader made.
    accuracy: the highest rung of the ladder that is allowed.
    method: for convex hulls, "sat" or "gjk" (portals, GJK and EPA); "auto": the faster one. It
    changes no relation, and of a depth only the last digits.
    fail_on: the least severity that makes a check fail. accept: issues that need not be solved
    before a check passes, each as `CODE` or `CODE:NAME`.
    allow_open: open meshes are intended. An open surface is then a sheet without an inside.
    cross_check: also asks other libraries.
    planar: check the outlines of the bodies in this plane; None: check in space.
    list_pruned: findings for pairs that the broad phase settled; None: if there are few pairs.
    depth_width, thickness_width: a search ends when its interval has this relative width.
    depth_budget: for the interval of one depth, in seconds of a slow machine; one thickness gets
    half of it. It limits the number of steps and not the time, so that the same input gives the
    same answer on every machine.
    part_*: how concave meshes are split into convex parts, and the limits for it.
    """

    depth: bool | None = None
    thickness: bool | None = None
    volume: bool = False
    volume_seconds: Size = 60.0
    volume_megabytes: Count = 4096
    contacts: bool = False
    contact_points: Count = 100_000  # about 5 MB of JSON
    components: bool = False
    clearance: Length | None = None
    tolerance: Length | Literal["input-precision"] | None = None
    surface_tolerance: Length | None = None
    accuracy: Accuracy = "exact"
    method: Method = "auto"
    fail_on: FailOn = "error"
    accept: tuple[str, ...] = ()
    allow_open: bool = False
    cross_check: bool = False
    planar: Plane | None = None
    list_pruned: bool | None = None
    depth_width: Width = 0.01
    depth_budget: Budget = 2.0
    thickness_width: Width = 0.01
    part_threshold: Length = 0.05
    part_seed: int = 0
    part_seconds: Size = 120.0
    part_megabytes: Count = 4096
    seconds_per_file: Size = 60.0
    megabytes_per_file: Count = 2048


class StatedConfig(Value, frozen=True):
    """file: the config file, relative to the folder of the command. options: each that it sets and
    the command line does not, by its name without the dashes, as the file has it."""

    file: str
    options: Annotated[Mapping[str, OptionValue], Meta(min_length=1)]


# The options with which files were read, by name: those that were given, and the defaults of the
# formats of these files. Lengths are in millimetres.
StatedReading = Annotated[Mapping[str, OptionValue], Meta(min_length=1)]
