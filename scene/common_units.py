"""Converts bodies of inputs with different units of length to one unit, if their units are known.

GLB and glTF files and robots are in metres. A 3MF or DAE file is in the unit that it names, a scene
in its `units`. OBJ, STL, PLY and OFF files state no unit. Within a scene or a robot they have its
unit. Otherwise their unit is unknown.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Literal

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, UNITS_UNKNOWN, Body
from satcheck.scene.issue import Issue, issue
from satcheck.scene.units import MICROMETRES, is_unit, ratio, stated_unit, unit_in
from satcheck.scene.words import listed

Kind = Literal["mesh", "scene", "robot"]


class Input(Struct):
    """One input with bodies. declares: its units as it writes them. unit: the unit meant by that,
    or the unit given for inputs that declare none; None: unknown. ids: of its bodies."""

    kind: Kind
    name: str
    path: str
    declares: str | None
    unit: str | None
    ids: list[str] = []


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


def in_one_unit(
    bodies: Sequence[Body], inputs: Sequence[Input], rules: Mapping[str, str | None]
) -> InOneUnit:
    """bodies: the `units` of each are those of its mesh, else those of its input, else None. Their
    transforms lead into the unit of their input. rules: path of a file of rules -> the units that
    it declares.

    A scene without a unit has the unit of its meshes if they all state the same one. An input
    without any stated unit has the unit of the first file of rules that states one.
    The common unit is that of the robots, else that of the scenes, else that of the mesh files. If
    there are several, the smallest is taken, because the factors of the others are then usually
    whole numbers.
    """
    by_id = {body.id: body for body in bodies}
    known_rules = {path: unit for path, text in rules.items() if (unit := stated_unit(text))}
    for source in inputs:
        _infer(source, [by_id[id_] for id_ in source.ids if id_ in by_id], known_rules)
    unit = _common(inputs) or next(iter(known_rules.values()), None)
    converted = {
        id_: _converted(by_id[id_], source.unit, unit)
        for source in inputs
        for id_ in source.ids
        if id_ in by_id
    }
    scaled = [converted.get(body.id, body) for body in bodies]
    units = {source.path: source.unit for source in inputs if source.kind == "scene"} | known_rules
    scales = {path: ratio(own, unit) for path, own in units.items() if own and unit}
    declared = [*(source.declares for source in inputs), *rules.values()]
    stated_by = {id_: source.path for source in inputs for id_ in source.ids}
    issues = (*_conversions(scaled, stated_by), *_unknown(scaled, inputs))
    return InOneUnit(tuple(scaled), unit, _label(scaled, declared, unit), scales, issues)


def _infer(source: Input, bodies: Sequence[Body], rules: Mapping[str, str]) -> None:
    if source.unit is not None:
        return
    stated = {body.units for body in bodies if body.shape is None}
    if len(stated - {None}) == 0:
        source.unit = next(iter(rules.values()), None)
    elif len(stated) == 1:
        (source.unit,) = stated


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


def _conversions(bodies: Iterable[Body], stated_by: Mapping[str, str]) -> list[Issue]:
    """A note for each unit that was converted, with the files that state it. stated_by: id of a
    body -> the input that states the unit if the mesh file does not."""
    files: dict[tuple[float, str], dict[str, None]] = {}
    for body in bodies:
        if body.unit_scale is not None and body.units is not None:
            path = body.file.path if body.file.units else stated_by[body.id]
            files.setdefault((body.unit_scale, body.units), {})[path] = None
    notes = []
    for (scale, unit), paths in files.items():
        own = unit_in(unit, scale)
        times = repr(scale).removesuffix(".0")
        message = f"{listed(list(paths))}: converted from {own} to {unit}, times {times}"
        notes.append(issue("units-converted", message, file=next(iter(paths))))
    return notes


def _unknown(bodies: Sequence[Body], inputs: Sequence[Input]) -> list[Issue]:
    """A warning if the units of two bodies cannot be compared."""
    if len({body.units for body in bodies}) < 2:
        return []
    owners = {id_: source for source in inputs for id_ in source.ids}
    unsaid = next(
        (source.path for source in inputs if source.kind == "scene" and source.unit is None), None
    )
    files: dict[str | None, dict[str, None]] = {}
    for body in bodies:
        owner = owners[body.id]
        path = body.file.path if owner.path == unsaid else owner.path
        files.setdefault(body.units, {})[path] = None
    unstated = list(files.pop(None, {})) or [unsaid or ""]
    known = " and ".join(f"{listed(list(paths))} in {unit}" for unit, paths in files.items())
    message = (
        f"{listed(unstated)}: no unit of length is stated, unlike {known}: their pairs are not "
        f"decided. State the unit: {'`units` in the scene' if unsaid else '--units'}"
    )
    return [issue(UNITS_UNKNOWN, message, file=unstated[0])]
