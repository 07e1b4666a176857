"""The settings of a check. Most can change an answer; a few cannot."""

from __future__ import annotations

import math
from functools import cache
from typing import Any, get_args, get_type_hints

from msgspec import Struct, ValidationError, convert

from satcheck.core.conventions import LARGEST_LENGTH, PLANES, Plane, axis_across
from satcheck.core.errors import SatcheckError
from satcheck.report.settings import Accuracy as Accuracy
from satcheck.report.settings import FailOn as FailOn
from satcheck.report.settings import Method as Method
from satcheck.report.settings import StatedSettings

ACCURACIES: tuple[Accuracy, ...] = get_args(Accuracy)
METHODS: tuple[Method, ...] = get_args(Method)

FAIL_ON: tuple[FailOn, ...] = get_args(FailOn)

# A search narrows the interval of a concave depth, or of a thickness, to this width relative to its
# upper end.
DEPTH_WIDTH = 0.01
THICKNESS_WIDTH = 0.01
# The budget for narrowing one interval of a pair, in seconds of a slow machine.
DEPTH_BUDGET = 2.0
MOST_BUDGET = 86400.0
# Steps of a search in such a second. A slow machine of today reaches this number. Steps are counted
# instead of time, so that the same input gives the same answer.
WORK_PER_SECOND = 400_000_000
# The share of the depth budget that a search of the thickness may use.
THICKNESS_SHARE = 0.5
# Up to this many pairs, a report lists all pairs, including those that the broad phase settled, and
# a table has a row for each.
LISTED_PAIRS = 60
# The most findings about pairs whose bodies cannot be used or compared: a mesh that cannot be read
# may have a thousand bodies, and each of them a pair with every other body of the scene.
LISTED_UNDECIDABLE = 10_000
# Limit on the points in the contacts of a pair: about 5 MB of JSON.
CONTACT_POINTS = 100_000


class Settings(Struct, frozen=True):
    """Lengths are in the units of the files. None means "not computed" unless said otherwise.

    depth: depth and MTV of overlapping pairs; None: for mesh files always, in a scene only if a
    rule requests it.
    thickness: of overlapping pairs; None: whenever `depth` requests the depth.
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
    before a check passes, each as `CODE` or `CODE:NAME` (`audit/acceptance.py`).
    allow_open: open meshes are intended. An open surface is then a sheet without an inside.
    cross_check: also asks other libraries; cross_check_*: limits for one question.
    planar: check the outlines of the bodies in this plane; None: check in space. certificate: every
    proven finding carries evidence that `satcheck verify` checks.
    list_pruned: findings for pairs that the broad phase settled; None: if there are at most
    LISTED_PAIRS pairs. depth_width, thickness_width: a search ends when its interval has this
    relative width.
    depth_budget: for the interval of one depth, in seconds of a slow machine; one thickness gets
    half of it. It limits the number of steps and not the time, so that the same input gives the
    same answer on every machine.
    part_*: how concave meshes are split into convex parts, and the limits for it.
    jobs: threads over pairs, or within the only pair; 0: one for each core. jobs, cache and timings
    change no answer.
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
    accept: tuple[str, ...] = ()
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
                raise _refused(f"{name} needs triangles: not at accuracy {self.accuracy}")
        for name in ("volume", "contacts", "components", "cross_check"):
            if self.planar is not None and getattr(self, name):
                raise _refused(f"{name} needs bodies in space: not with planar")
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
            if value is not None and value > LARGEST_LENGTH:
                message = f"{name} must be at most {LARGEST_LENGTH:g}, not {value!r}"
                raise SatcheckError("out-of-range", message)
        for name in ("part_seconds", "volume_seconds", "seconds_per_file", "cross_check_seconds"):
            if not getattr(self, name) > 0:
                raise _refused(f"{name} must be more than 0, not {getattr(self, name)!r}")
        if self.jobs < 0:
            raise _refused(f"jobs must be 0 (one per core) or more, not {self.jobs!r}")

    @property
    def work(self) -> int:
        """The most steps of one search of a depth."""
        return math.ceil(self.depth_budget * WORK_PER_SECOND)

    @property
    def thickness_work(self) -> int:
        """The most steps of one search of a thickness."""
        return math.ceil(THICKNESS_SHARE * self.work)

    @property
    def across(self) -> int:
        """The axis perpendicular to the plane of the check; -1: the check is in space."""
        return -1 if self.planar is None else axis_across(self.planar)

    def stated(self, *, depth: bool, thickness: bool) -> StatedSettings:
        """The settings that can change an answer. depth, thickness: whether they are computed for
        every overlap."""
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
            accept=self.accept,
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
    """Raises SatcheckError if the value is not a Settings, for example a dict."""
    if not isinstance(value, Settings):
        raise _refused(f"settings should be a satcheck.Settings, not {value!r}")


@cache
def _kinds() -> dict[str, Any]:
    """The type of each setting."""
    return get_type_hints(Settings)


def _require_kind(name: str, value: Any, kind: Any) -> None:
    plain = value.item() if hasattr(value, "item") else value  # a numpy scalar
    try:
        convert(plain, kind)
    except ValidationError as error:
        problem = str(error).removesuffix(".")
        raise _refused(f"{name} has the wrong type: {problem}") from None


def _refused(message: str) -> SatcheckError:
    return SatcheckError("bad-setting", message)
