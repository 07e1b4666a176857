"""The settings of a check. Most can change an answer; a few cannot."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from functools import cache, lru_cache
from typing import Any, get_args, get_type_hints

from msgspec import ValidationError, convert
from msgspec.structs import fields, force_setattr

from satcheck.core.conventions import LARGEST_LENGTH, axis_across
from satcheck.core.errors import SatcheckError
from satcheck.report.settings import MOST_BUDGET as MOST_BUDGET
from satcheck.report.settings import Accuracy as Accuracy
from satcheck.report.settings import FailOn as FailOn
from satcheck.report.settings import Method as Method
from satcheck.report.settings import StatedSettings
from satcheck.report.values import Count, Length, Size
from satcheck.scene import Scene
from satcheck.scene.units import Length as GivenLength
from satcheck.scene.units import unit_of

ACCURACIES: tuple[Accuracy, ...] = get_args(Accuracy)
METHODS: tuple[Method, ...] = get_args(Method)
FAIL_ON: tuple[FailOn, ...] = get_args(FailOn)

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


class Settings(StatedSettings, frozen=True, kw_only=True):
    """What is asked. `satcheck.report.settings.StatedSettings` describes what can change an answer;
    the rest changes none.

    certificate: Add evidence to a JSON report, for satcheck verify.
    distance: Measure the gap of every pair, however large.
    jobs: Threads; 0 is one per core. Changes no answer.

    cross_check_*: limits for one question to another library. jobs: over pairs, or within the only
    pair.
    """

    tolerance: Length | None = None
    cross_check_seconds: Size = 30.0
    cross_check_megabytes: Count = 4096
    certificate: bool = False
    distance: bool = False
    jobs: Count = 0
    cache: bool = True
    cache_directory: str | None = None
    timings: bool = True

    def __post_init__(self) -> None:
        for name, (kind, default) in _kinds().items():
            value = getattr(self, name)
            if value is default:
                continue
            plain = value.item() if hasattr(value, "item") else value  # a numpy scalar
            try:
                converted = convert(plain, kind)
            except ValidationError as error:
                raise _refused(f"{name}: {_reason(error, kind)}, not {value!r}") from None
            if plain is not value or isinstance(converted, tuple):
                force_setattr(self, name, converted)  # settings are the key of what they imply
        for name in ("contacts", "components", "volume", "cross_check", "parts"):
            if not getattr(self, name):
                continue
            if self.accuracy != "exact" and name not in ("cross_check", "parts"):
                raise _refused(f"{name} needs triangles: not at accuracy {self.accuracy}")
            if self.planar is not None:
                raise _refused(f"{name} needs bodies in space: not with planar")
        if self.clearance and (self.max_thickness, self.max_depth) != (None, None):
            raise _refused(
                "clearance contradicts max_thickness and max_depth: bodies that may overlap keep "
                "no gap; give either to some pairs by rules"
            )
        for name in ("clearance", "tolerance", "surface_tolerance", "max_thickness", "max_depth"):
            value = getattr(self, name)
            if value is not None and not math.isfinite(value):
                raise _refused(f"{name} must be a finite length, not {value!r}")
            if value is not None and value > LARGEST_LENGTH:
                message = f"{name} must be at most {LARGEST_LENGTH:g}, not {value!r}"
                raise SatcheckError("out-of-range", message)

    @property
    def work(self) -> int:
        """The most steps of one search of a depth."""
        return math.ceil(self.budget * WORK_PER_SECOND)

    @property
    def across(self) -> int:
        """The axis perpendicular to the plane of the check; -1: the check is in space."""
        return -1 if self.planar is None else axis_across(self.planar)

    def stated(self, *, depth: bool, thickness: bool) -> StatedSettings:
        """Return the settings that can change an answer. depth, thickness: whether they are
        computed for every overlap."""
        values = {name: getattr(self, name) for name in StatedSettings.__struct_fields__}
        if self.tolerance is None:
            values["tolerance"] = "input-precision"
        return StatedSettings(**values | {"depth": depth, "thickness": thickness})


def require_settings(value: object) -> None:
    """Raises SatcheckError if the value is not a Settings, for example a dict."""
    if not isinstance(value, Settings):
        raise _refused(f"settings should be a satcheck.Settings, not {value!r}")


def documentation(name: str) -> str:
    """Return what the documentation of the settings says of a field, as the help of its option."""
    return _documented().get(name, "")


@cache
def _documented() -> dict[str, str]:
    """Return what it says of each field, in a tenth of the time of a search for each."""
    text = f"{Settings.__doc__}\n{StatedSettings.__doc__}"
    found = re.findall(r"^    (\w+): (.*?\.)\n(?=    \w+: |\n)", text, re.MULTILINE | re.DOTALL)
    return {name: " ".join(said.split()) for name, said in found}


@cache
def _kinds() -> dict[str, tuple[Any, Any]]:
    """Return the type of each setting, with its limits, and its default."""
    kinds = get_type_hints(Settings, include_extras=True)
    return {field.name: (kinds[field.name], field.default) for field in fields(Settings)}


def _reason(error: ValidationError, kind: Any) -> str:
    """What a setting of this type should be."""
    choices = [word for inner in (kind, *get_args(kind)) for word in get_args(inner)]
    if str(error).startswith("Invalid enum value"):
        return f"one of {', '.join(filter(lambda word: isinstance(word, str), choices))} expected"
    expected, _, _ = str(error).removeprefix("Expected ").partition(", got ")
    return f"{expected.replace('null', 'None')} expected"


def _refused(message: str) -> SatcheckError:
    return SatcheckError("bad-setting", message)


# The scenes of a batch have the same settings.
_settings = lru_cache(maxsize=8, typed=True)(Settings)


def settings_in_units(
    values: Mapping[str, Any], scene: Scene, named: Callable[[str], str]
) -> Settings:
    """values: of the fields of Settings by name; a Length is converted to the units of the scene.
    A body alone has no pair that a length could be about: its units do not matter. named: returns
    what a message calls a value.

    Raises ValueError if the units of the scene are unknown, and what Settings raises.
    """
    lengths = {name: value for name, value in values.items() if isinstance(value, GivenLength)}
    plain = {name: value for name, value in values.items() if name not in lengths}
    if len(scene.bodies) + len(scene.unreadable) > 1 or unit_of(scene.units):
        for name, value in lengths.items():
            plain[name] = length_in_units(value, scene.units, named(name))
    return _settings(**plain)


def length_in_units(value: GivenLength, declared: str | None, name: str) -> float:
    """The length in the declared units of a scene; ValueError if they are unknown."""
    try:
        return value.in_units_of(declared)
    except ValueError as error:
        raise ValueError(f"{name} {error}, or state the unit with --units") from None
