"""The settings of a check: every choice that can change an answer, and a few that cannot."""

from __future__ import annotations

import math
from functools import cache
from typing import Any, Literal, get_args, get_type_hints

from msgspec import Struct, ValidationError, convert

from satcheck.core.conventions import PLANES, Plane, axis_across
from satcheck.core.errors import SatcheckError
from satcheck.report.settings import Accuracy as Accuracy
from satcheck.report.settings import Method as Method
from satcheck.report.settings import StatedSettings

ACCURACIES: tuple[Accuracy, ...] = get_args(Accuracy)
METHODS: tuple[Method, ...] = get_args(Method)

FailOn = Literal["error", "warning", "note"]
FAIL_ON: tuple[FailOn, ...] = ("error", "warning", "note")

# The intervals of the depth of a concave pair, and of a thickness, are narrowed to this width,
# relative to their upper ends.
DEPTH_WIDTH = 0.01
THICKNESS_WIDTH = 0.01
# Seconds, in work units of a slow machine, that narrowing one interval of a pair may take.
DEPTH_BUDGET = 2.0
MOST_BUDGET = 86400.0
# Steps of a search in such a second: what a slow machine of today gets done, so that the budget is
# not exceeded there. A number and not a clock: the same input, the same answer.
WORK_PER_SECOND = 400_000_000
# Of the budget of the depth, what a search of the thickness may spend.
THICKNESS_SHARE = 0.5
# Up to this many pairs a report lists all, those that the broad phase settled too, and a table has
# a row for each.
LISTED_PAIRS = 60
# Points that the contacts of a pair may list: some 5 MB of JSON.
CONTACT_POINTS = 100_000


class Settings(Struct, frozen=True):
    """Lengths are in the units of the files. None means "not computed" unless said otherwise.

    depth: depth and MTV of overlapping pairs; None: of mesh files, and in a scene that places its
    bodies only where a rule asks.
    thickness: of overlapping pairs; None: wherever the depth is no matter of a rule.
    volume: the volume that bodies have in common; volume_*: what a pair may cost.
    contacts: where surfaces meet; contact_points: how many points a pair may list.
    components: the connected components of each overlap, with their thickness.
    clearance: the gap that bodies must keep; pairs closer than this are `near`.
    tolerance: half width of the touch band; None: the input precision of each pair.
    surface_tolerance: how far the surfaces of bodies may be off where their scene does not say;
    None: 0.
    accuracy: the highest rung of the ladder that may be climbed.
    method: of the convex hulls, "sat" or "gjk" (portals, GJK and EPA); "auto": the faster of them.
    Changes no relation, and no depth beyond its last digits.
    fail_on: the least severity that makes a check fail.
    allow_open: open meshes are meant to be open. What has a rim is a sheet, and has no inside.
    cross_check: other libraries are asked too; cross_check_*: what one question may cost.
    planar: bodies are their outlines in this plane, and answers lie in it; None: as they are.
    certificate: every proven finding carries evidence that `satcheck verify` checks.
    list_pruned: findings for pairs that the broad phase settled; None: up to LISTED_PAIRS pairs.
    depth_width, thickness_width: relative width of an interval that is narrow enough.
    depth_budget: what may be spent on one interval of a depth, in seconds of a slow machine, and
    half of it on one of a thickness: it buys a number of steps, not a time, so that the same
    input gives the same answer everywhere.
    part_*: how concave meshes are split into convex parts, and what that may cost.
    jobs: threads over pairs, 0 for one per core. Changes no answer, nor does cache or timings.
    """

    depth: bool | None = None
    thickness: bool | None = None
    volume: bool = False
    volume_seconds: float = 60.0
    volume_megabytes: int = 4096
    contacts: bool = False
    contact_points: int = CONTACT_POINTS
    components: bool = False
    clearance: float | None = None
    tolerance: float | None = None
    surface_tolerance: float | None = None
    accuracy: Accuracy = "exact"
    method: Method = "auto"
    fail_on: FailOn = "error"
    allow_open: bool = False
    cross_check: bool = False
    cross_check_seconds: float = 30.0
    cross_check_megabytes: int = 4096
    planar: Plane | None = None
    certificate: bool = False
    list_pruned: bool | None = None
    depth_width: float = DEPTH_WIDTH
    depth_budget: float = DEPTH_BUDGET
    thickness_width: float = THICKNESS_WIDTH
    part_threshold: float = 0.05
    part_seed: int = 0
    part_seconds: float = 120.0
    part_megabytes: int = 4096
    seconds_per_file: float = 60.0
    megabytes_per_file: int = 2048
    jobs: int = 0
    cache: bool = True
    cache_directory: str | None = None
    timings: bool = True

    def __post_init__(self) -> None:
        if self.accuracy not in ACCURACIES:
            raise _refused(f"accuracy must be one of {', '.join(ACCURACIES)}")
        if self.method not in METHODS:
            raise _refused(f"method must be one of {', '.join(METHODS)}")
        if self.fail_on not in FAIL_ON:
            raise _refused(f"fail_on must be one of {', '.join(FAIL_ON)}")
        if self.planar not in (None, *PLANES):
            raise _refused(f"planar must be one of {', '.join(PLANES)}")
        for name, kind in _kinds().items():
            _require_kind(name, getattr(self, name), kind)
        for name in ("contacts", "components", "volume"):
            if getattr(self, name) and self.accuracy != "exact":
                raise _refused(f"{name} is found on triangles: not at accuracy {self.accuracy}")
        for name in ("volume", "contacts", "components", "cross_check"):
            if self.planar is not None and getattr(self, name):
                raise _refused(f"{name} is about bodies in space: not with planar")
        if self.contact_points < 0:
            raise _refused(f"contact_points must be 0 or more, not {self.contact_points!r}")
        for name in ("depth_width", "thickness_width"):
            if not 0 < getattr(self, name) < 1:
                raise _refused(f"{name} must lie between 0 and 1, not {getattr(self, name)!r}")
        if not 0 < self.depth_budget <= MOST_BUDGET:
            raise _refused(
                f"depth_budget must lie between 0 and {MOST_BUDGET:g} s, not {self.depth_budget!r}"
            )
        for name in ("clearance", "tolerance", "surface_tolerance"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value >= 0):
                raise _refused(f"{name} must be a finite length >= 0, not {value!r}")
        for name in ("part_seconds", "volume_seconds", "seconds_per_file", "cross_check_seconds"):
            if not getattr(self, name) > 0:
                raise _refused(f"{name} must be more than 0, not {getattr(self, name)!r}")
        if self.jobs < 0:
            raise _refused(f"jobs must be 0 (one per core) or more, not {self.jobs!r}")

    @property
    def work(self) -> int:
        """The steps of one search of a depth."""
        return math.ceil(self.depth_budget * WORK_PER_SECOND)

    @property
    def thickness_work(self) -> int:
        """Those of one search of a thickness."""
        return math.ceil(THICKNESS_SHARE * self.work)

    @property
    def across(self) -> int:
        """The axis across the plane of the check; -1: it is in space."""
        return -1 if self.planar is None else axis_across(self.planar)

    def stated(self, *, depth: bool, thickness: bool) -> StatedSettings:
        """Everything that can change an answer, and nothing that cannot. depth, thickness: whether
        those of every overlap are computed."""
        return StatedSettings(
            depth=depth,
            thickness=thickness,
            volume=self.volume,
            volume_seconds=self.volume_seconds,
            volume_megabytes=self.volume_megabytes,
            contacts=self.contacts,
            contact_points=self.contact_points,
            components=self.components,
            clearance=self.clearance,
            tolerance="input-precision" if self.tolerance is None else self.tolerance,
            surface_tolerance=self.surface_tolerance,
            accuracy=self.accuracy,
            method=self.method,
            fail_on=self.fail_on,
            allow_open=self.allow_open,
            cross_check=self.cross_check,
            planar=self.planar,
            list_pruned=self.list_pruned,
            depth_width=self.depth_width,
            depth_budget=self.depth_budget,
            thickness_width=self.thickness_width,
            part_threshold=self.part_threshold,
            part_seed=self.part_seed,
            part_seconds=self.part_seconds,
            part_megabytes=self.part_megabytes,
            seconds_per_file=self.seconds_per_file,
            megabytes_per_file=self.megabytes_per_file,
        )


def require_settings(value: object) -> None:
    """Raises SatcheckError for what is no Settings, such as a dict of them."""
    if not isinstance(value, Settings):
        raise _refused(f"settings should be a satcheck.Settings, not {value!r}")


@cache
def _kinds() -> dict[str, Any]:
    """The type of each setting."""
    return get_type_hints(Settings)


def _require_kind(name: str, value: Any, kind: Any) -> None:
    plain = value.item() if hasattr(value, "item") else value  # a number of numpy
    try:
        convert(plain, kind)
    except ValidationError as error:
        problem = str(error).removesuffix(".")
        raise _refused(f"{name} has the wrong type: {problem}") from None


def _refused(message: str) -> SatcheckError:
    return SatcheckError("bad-setting", message)
