"""Converts bodies of inputs with different units of length to one unit, if their units are known.

GLB and glTF files and robots are in metres. A 3MF or DAE file is in the unit that it names, a scene
in its `units`. OBJ, STL, PLY and OFF files state no unit. Within a scene or a robot they have its
unit. Otherwise their unit is unknown.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, UNITS_UNKNOWN, Body, Unreadable
from satcheck.scene.issue import Issue, issue
from satcheck.scene.units import MICROMETRES, is_unit, ratio, stated_unit, unit_in
from satcheck.scene.words import listed

if TYPE_CHECKING:
    from satcheck.scene.document import Kind


class Input(Struct):
    """One input. kind: "rules": a file of rules, without bodies. declares: its units as it writes
    them. unit: the unit meant by that, or the unit given for inputs that declare none; None:
    unknown."""

    kind: Kind
    name: str
    path: str
    declares: str | None
    unit: str | None
    bodies: list[Body | Unreadable] = []

    @property
    def readable(self) -> list[Body]:
        return [body for body in self.bodies if isinstance(body, Body)]


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
    of_rules = next((each.unit for each in inputs if each.kind == "rules" and each.unit), None)
    for source in inputs:
        if source.kind != "rules" and source.unit is None:
            source.unit = _inferred(source.readable, of_rules)
    unit = _common(inputs) or of_rules
    owned = [
        (source, _converted(body, source.unit, unit))
        for source in inputs
        for body in source.readable
    ]
    bodies = tuple(body for _, body in owned)
    scales = {
        source.path: ratio(source.unit, unit)
        for kind in ("scene", "rules")
        for source in inputs
        if source.kind == kind and source.unit and unit
    }
    declared = [each.declares for each in sorted(inputs, key=lambda each: each.kind == "rules")]
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
            units.setdefault(source.kind, set()).add(source.unit)
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
            path = body.file.path if body.file.units else source.path
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
        (source.path for source in inputs if source.kind == "scene" and source.unit is None), None
    )
    files: dict[str | None, dict[str, None]] = {}
    for source, body in owned:
        path = body.file.path if source.path == unsaid else source.path
        files.setdefault(body.units, {})[path] = None
    unstated = list(files.pop(None, {})) or [unsaid or ""]
    known = " and ".join(f"{listed(list(paths))} in {unit}" for unit, paths in files.items())
    message = (
        f"{listed(unstated)}: no unit of length is stated, unlike {known}: their pairs are not "
        f"decided. State the unit: {'`units` in the scene' if unsaid else '--units'}"
    )
    return [issue(UNITS_UNKNOWN, message, file=unstated[0])]
