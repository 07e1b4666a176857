"""Units of length: names and conversion factors, and how bodies of inputs with different units are
converted to one unit, if their units are known.

GLB and glTF files and robots are in metres. A 3MF or DAE file is in the unit that it names, a scene
in its `units`. OBJ, STL, PLY and OFF files state no unit. Within a scene or a robot they have its
unit. Otherwise their unit is unknown.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, UNITS_UNKNOWN, Body
from satcheck.scene.issue import Issue, issue
from satcheck.scene.words import listed

if TYPE_CHECKING:
    from satcheck.scene.building import Input
    from satcheck.scene.document import Kind

# Micrometres in one unit. They are whole numbers, so that a conversion rounds once.
MICROMETRES = {"um": 1, "mm": 1_000, "cm": 10_000, "m": 1_000_000, "in": 25_400, "ft": 304_800}
RESCALED = "meters (rescaled)"  # its reader has turned a unit without a name into metres
_SYNONYMS = {
    RESCALED: "m",
    "micrometre": "um",
    "micrometer": "um",
    "micron": "um",
    "millimetre": "mm",
    "millimeter": "mm",
    "centimetre": "cm",
    "centimeter": "cm",
    "metre": "m",
    "meter": "m",
    "inch": "in",
    "foot": "ft",
    "feet": "ft",
    "inches": "in",
}
# The COLLADA reader states the unit of a file as "0.0254 * meters".
_OF_METRES = " * meters"
_SAME = 1e-9  # relative: a factor written with few digits still means the unit
# Few calls need it: compiled at its first use. Also for JSON Schema, so without flags.
_BLANK = r"[ \t\n\r\f\v]*"
_UNIT = "|".join("".join(f"[{c}{c.upper()}]" for c in unit) for unit in MICROMETRES)
_NUMBER = r"[+]?(?:[0-9]+[.]?[0-9]*|[.][0-9]+)(?:[eE][+-]?[0-9]+)?"
LENGTH_PATTERN = f"^{_BLANK}({_NUMBER}){_BLANK}({_UNIT})?{_BLANK}$"


class Length(Struct, frozen=True):
    """A length >= 0 as written. unit: None: the unit of the files."""

    value: float
    unit: str | None

    def __str__(self) -> str:
        return f"{self.value:g}{self.unit or ''}"

    def in_units_of(self, declared: str | None) -> float:
        """This length in the declared units of a scene. Raises ValueError if they are unknown."""
        if self.unit is None:
            return self.value
        known = unit_of(declared)
        if known is None:
            why = f"{declared!r} is not a known unit" if declared else "no units are declared"
            raise ValueError(f"{self}: {why}, so give a plain number")
        return self.value * MICROMETRES[self.unit] / MICROMETRES[known]


def parse_length(text: str) -> Length:
    """Parses `0.5` or `2mm`. Raises ValueError if the text is not a length."""
    match = re.fullmatch(LENGTH_PATTERN, text)
    number = float(match[1]) if match else math.nan
    if match is None or not math.isfinite(number):
        units = "/".join(MICROMETRES)
        raise ValueError(f"{text!r} is not a length: a number >= 0, or one with {units}")
    return Length(number, match[2].lower() if match[2] else None)


@lru_cache(maxsize=64)
def unit_of(declared: str | None) -> str | None:
    """The unit that a scene declares, as a key of MICROMETRES; None if unknown or not declared."""
    name = (declared or "").strip().lower()
    if name.endswith(_OF_METRES):
        return _of_metres(name.removesuffix(_OF_METRES))
    name = _SYNONYMS.get(name, _SYNONYMS.get(name.removesuffix("s"), name))
    return name if name in MICROMETRES else None


def _of_metres(text: str) -> str | None:
    try:
        micrometres = float(text) * MICROMETRES["m"]
    except ValueError:
        return None
    known = (name for name, size in MICROMETRES.items() if abs(micrometres - size) <= _SAME * size)
    return next(known, None)


def ratio(unit: str, other: str) -> float:
    """The number of `other` units in one `unit`: exact, or rounded once."""
    return MICROMETRES[unit] / MICROMETRES[other]


def unit_in(unit: str, scale: float) -> str:
    """The unit X for which `ratio(X, unit)` is `scale`."""
    return next(name for name in MICROMETRES if ratio(name, unit) == scale)


@lru_cache(maxsize=64)  # many bodies share few declarations
def stated_unit(declared: str | None) -> str | None:
    """The unit at the start of a declaration such as "mm", "Metres", "mm (assumed)"."""
    first = (declared or "").partition("(")[0].split()[:1]
    return unit_of(declared) or unit_of(first[0] if first else None)


def is_unit(declared: str) -> bool:
    """Whether a declaration begins with a unit."""
    first = declared.partition("(")[0].split()[:1]
    return bool(first) and unit_of(first[0]) is not None


class InOneUnit(Struct, frozen=True):
    """bodies: in the common unit if their unit is known, else unchanged. unit: the common one;
    None: no input states a unit. label: the unit of the lengths of all bodies; None: unknown, or
    different units. scales: path of a scene -> length of its unit in common units. issues: about
    units."""

    bodies: tuple[Body, ...]
    unit: str | None
    label: str | None
    scales: Mapping[str, float]
    issues: tuple[Issue, ...]


def in_one_unit(inputs: Sequence[Input]) -> InOneUnit:
    """inputs: the `units` of their bodies are those of the mesh, else those of the input, else
    None. Their transforms lead into the unit of the input.

    A scene without a unit has the unit of its meshes if they all state the same one. An input
    without any stated unit has the unit of the first file of rules that states one.
    The common unit is that of the robots, else that of the scenes, else that of the mesh files. If
    there are several, the smallest is taken, because the factors of the others are then usually
    whole numbers.
    """
    of_rules = next(
        (each.unit for each in inputs if each.document.kind == "rules" and each.unit), None
    )
    for source in inputs:
        if source.document.kind != "rules" and source.unit is None:
            source.unit = _inferred(source.readable, of_rules)
    unit = _common(inputs) or of_rules
    owned = [
        (source, _converted(body, source.unit, unit))
        for source in inputs
        for body in source.readable
    ]
    bodies = tuple(body for _, body in owned)
    scales = {
        source.document.path: ratio(source.unit, unit)
        for kind in ("scene", "rules")
        for source in inputs
        if source.document.kind == kind and source.unit and unit
    }
    in_turn = sorted(inputs, key=lambda each: each.document.kind == "rules")
    declared = [each.document.units for each in in_turn]
    issues = (*_conversions(owned), *_unknown(owned, inputs))
    return InOneUnit(bodies, unit, _label(bodies, declared, unit), scales, issues)


def _inferred(bodies: Sequence[Body], of_rules: str | None) -> str | None:
    stated = {body.units for body in bodies if body.shape is None}
    if not stated - {None}:
        return of_rules
    return next(iter(stated)) if len(stated) == 1 else None


def _common(inputs: Iterable[Input]) -> str | None:
    units: dict[Kind, set[str]] = {}
    for source in inputs:
        if source.unit is not None:
            units.setdefault(source.document.kind, set()).add(source.unit)
    kind = next((kind for kind in ("robot", "scene", "mesh") if kind in units), None)
    return min(units[kind], key=MICROMETRES.__getitem__) if kind else None


def _converted(body: Body, own: str | None, common: str | None) -> Body:
    """own: the unit of its input; None: its lengths are not converted."""
    if own is None or common is None or body.units == own == common:
        return body
    scale = ratio(body.units or own, common)
    return replace(
        body,
        transform=scaled_world(body.transform, ratio(own, common)),
        units=common,
        unit_scale=None if scale == 1.0 else scale,
        surface_tolerance=None
        if body.surface_tolerance is None
        else body.surface_tolerance * ratio(own, common),
    )


def scaled_world(transform: Transform | None, scale: float) -> Transform | None:
    """The transform, followed by a scaling about the world origin."""
    if scale == 1.0:
        return transform
    rows = transform or IDENTITY
    return (*(scale * entry for entry in rows[:12]), *rows[12:])


def scaled_mesh(transform: Transform | None, scale: float) -> Transform | None:
    """A scaling about the origin of the mesh, followed by the transform."""
    if scale == 1.0:
        return transform
    rows = transform or IDENTITY
    return tuple(entry * scale if k < 12 and k % 4 < 3 else entry for k, entry in enumerate(rows))


def _label(bodies: Iterable[Body], declared: Iterable[str | None], unit: str | None) -> str | None:
    """The unit as the inputs write it, if all write it the same way."""
    if any(body.units != unit for body in bodies):
        return None
    words = list(dict.fromkeys(text for text in declared if text))
    if unit is None:
        return words[0] if len(words) == 1 else None
    alike = words and all(stated_unit(text) == unit for text in words)
    return words[0] if alike and is_unit(words[0]) else unit


def _conversions(owned: Iterable[tuple[Input, Body]]) -> list[Issue]:
    """A note for each unit that was converted, with the files that state it."""
    files: dict[tuple[float, str], dict[str, None]] = {}
    for source, body in owned:
        if body.unit_scale is not None and body.units is not None:
            path = body.file.path if body.file.units else source.document.path
            files.setdefault((body.unit_scale, body.units), {})[path] = None
    notes = []
    for (scale, unit), paths in files.items():
        own = unit_in(unit, scale)
        times = repr(scale).removesuffix(".0")
        message = f"{listed(list(paths))}: converted from {own} to {unit}, times {times}"
        notes.append(issue("units-converted", message, file=next(iter(paths))))
    return notes


def _unknown(owned: Sequence[tuple[Input, Body]], inputs: Sequence[Input]) -> list[Issue]:
    """A warning if the units of two bodies cannot be compared."""
    if len({body.units for _, body in owned}) < 2:
        return []
    unsaid = next(
        (
            source.document.path
            for source in inputs
            if source.document.kind == "scene" and source.unit is None
        ),
        None,
    )
    files: dict[str | None, dict[str, None]] = {}
    for source, body in owned:
        path = body.file.path if source.document.path == unsaid else source.document.path
        files.setdefault(body.units, {})[path] = None
    unstated = list(files.pop(None, {})) or [unsaid or ""]
    known = " and ".join(f"{listed(list(paths))} in {unit}" for unit, paths in files.items())
    message = (
        f"{listed(unstated)}: no unit of length is stated, unlike {known}: their pairs are not "
        f"decided. State the unit: {'`units` in the scene' if unsaid else '--units'}"
    )
    return [issue(UNITS_UNKNOWN, message, file=unstated[0])]
