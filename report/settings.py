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
    "not computed" unless said otherwise. What is said of a field here is the help of its option.

    depth: How deep and how thick overlaps are, and the shortest way out.
    volume: The volume that solids share.
    contacts: Where surfaces meet: curves, flush patches, points.
    components: The connected parts of each overlap: place, thickness, and whether a body passes
    through the other there.
    parts: The convex parts of close bodies, and which of them overlap. They change no verdict.
    clearance: Pairs with a smaller gap fail; shows the gap.
    tolerance: A gap or a depth up to this counts as touching.
    max_thickness: Overlaps (interferences) no thicker than this pass.
    max_depth: Overlaps no deeper than this pass.
    surface_tolerance: How far surfaces of closed bodies may be off: overlaps that this explains
    count as touching.
    accuracy: The finest test: aabb, obb, hull, parts or exact. Those below exact may report false
    overlaps, called possible.
    method: Compare hulls by the separating axis test (sat), by portals, GJK and EPA (gjk), or by
    the faster one (auto).
    fail_on: Findings of this severity fail: error (without rules overlaps), warning or note
    (touches).
    accept: Issues that may stay: what blocks a pass, by its code and the name of its file or body
    (`*` for any part). Repeatable.
    allow_open: Open meshes are meant to be open: sheets without an inside, not solids with holes.
    cross_check: Compare with python-fcl and manifold3d. A contradiction makes the check incomplete.
    planar: Check outlines in this plane (xy, yz or xz): flat layouts.
    width: Narrow depth and thickness of concave pairs to an interval this wide, as a share.
    budget: Stop narrowing after this much work on a pair. Steps are counted, not time: every
    machine gives the same answer.

    depth, thickness: a report says whether they are computed for every overlap; None: the thickness
    whenever the depth is. volume_*, part_*, *_per_file: limits. contact_points: the most points
    listed for a pair. list_pruned: findings for pairs that the broad phase settled; None: if there
    are few pairs. max_thickness, max_depth: both count, for pairs to which rules give neither a
    limit nor a clearance. method: changes no relation, and of a depth only the last digits.
    budget: of the thickness half of it.
    """

    depth: bool | None = None
    thickness: bool | None = None
    volume: bool = False
    volume_seconds: Size = 60.0
    volume_megabytes: Count = 4096
    contacts: bool = False
    contact_points: Count = 100_000  # about 5 MB of JSON
    components: bool = False
    parts: bool = False
    clearance: Length | None = None
    tolerance: Length | Literal["input-precision"] | None = None
    max_thickness: Length | None = None
    max_depth: Length | None = None
    surface_tolerance: Length | None = None
    accuracy: Accuracy = "exact"
    method: Method = "auto"
    fail_on: FailOn = "error"
    accept: tuple[str, ...] = ()
    allow_open: bool = False
    cross_check: bool = False
    planar: Plane | None = None
    list_pruned: bool | None = None
    width: Width = 0.01
    budget: Budget = 2.0
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
