"""Inputs in several units of length -> bodies in one, as far as their units are known.

A GLB or glTF file and a robot are in metres, a 3MF or DAE file in the unit that it names, a scene
in its `units`. OBJ, STL, PLY, OFF and XAML files state no unit: within a scene or a robot they are
in its unit; beside other files their unit is unknown.
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


class Input:
    """One input with bodies. declares: its units, in its own words. unit: the one that this means,
    or the one given for inputs that declare none; None: unknown. ids: of its bodies."""

    __slots__ = ("declares", "ids", "kind", "path", "unit")

    def __init__(self, kind: Kind, path: str, declares: str | None, otherwise: str | None) -> None:
        """otherwise: the unit of inputs that declare none."""
        self.kind = kind
        self.path = path
        self.declares = declares
        self.unit = stated_unit(declares) or otherwise
        self.ids: list[str] = []


class InOneUnit(Struct, frozen=True):
    """bodies: in the common unit, those whose unit is known. unit: the common one; None: no input
    states any. label: what the lengths of all bodies are in; None: unknown, or not all in one.
    scales: path of a scene -> how many common units one of its units is. issues: about all this."""

    bodies: tuple[Body, ...]
    unit: str | None
    label: str | None
    scales: Mapping[str, float]
    issues: tuple[Issue, ...]


def in_one_unit(
    bodies: Sequence[Body], inputs: Sequence[Input], rules: Mapping[str, str | None]
) -> InOneUnit:
    """bodies: `units` of each is that of its mesh, or of its input where that states none, None
    where neither does. Their transforms lead into the unit of their input. rules: files of rules,
    and what they declare.

    A scene that states no unit is in that of its meshes, where they all state the same one. Where
    nothing in an input states any, it is in that of the first file of rules that does.
    The common unit is that of robots, or else of scenes, or else of mesh files. Of several it is
    the smallest, because the factors of the others are then usually whole numbers.
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
    """own: the unit of its input; None: its lengths stay as they are."""
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
    """Placed, and then scaled about the origin."""
    if scale == 1.0:
        return transform
    rows = transform or IDENTITY
    return (*(scale * entry for entry in rows[:12]), *rows[12:])


def scaled_mesh(transform: Transform | None, scale: float) -> Transform | None:
    """Scaled about its own origin, and then placed."""
    if scale == 1.0:
        return transform
    rows = transform or IDENTITY
    return tuple(entry * scale if k < 12 and k % 4 < 3 else entry for k, entry in enumerate(rows))


def _label(bodies: Iterable[Body], declared: Iterable[str | None], unit: str | None) -> str | None:
    """In the words of the inputs, where all use the same words."""
    if any(body.units != unit for body in bodies):
        return None
    words = list(dict.fromkeys(text for text in declared if text))
    if unit is None:
        return words[0] if len(words) == 1 else None
    alike = words and all(stated_unit(text) == unit for text in words)
    return words[0] if alike and is_unit(words[0]) else unit


def _conversions(bodies: Iterable[Body], stated_by: Mapping[str, str]) -> list[Issue]:
    """A note for each unit that was converted, with the files that state it. stated_by: of each
    body its input, which states the unit of a mesh file that does not."""
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
    """A warning where the units of two bodies cannot be compared."""
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
        f"{listed(unstated)}: no unit of length is stated, beside {known}: their pairs are not "
        f"decided. State the unit: {'`units` in the scene' if unsaid else '--units'}"
    )
    return [issue(UNITS_UNKNOWN, message, file=unstated[0])]
