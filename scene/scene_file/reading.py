"""Reads and checks any scene file, by the schema that it names.

A scene with errors is refused as a whole, because a part of a scene has no meaning. An unknown key
is an error, because it may be important.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from msgspec import UNSET, UnsetType
from msgspec.structs import replace

from satcheck.core.shapes import HalfSpace
from satcheck.scene.bodies import Entry
from satcheck.scene.document import Item
from satcheck.scene.errors import Refused
from satcheck.scene.motion import Motion
from satcheck.scene.opening import NOTHING_ELSE, Permitted
from satcheck.scene.rules import LENGTHS, Rule
from satcheck.scene.scene_file import document, simple
from satcheck.scene.scene_file.document import RULES_FILE_KEYS, SCENE_1
from satcheck.scene.scene_file.entries import (
    MeshPlaces,
    SceneFile,
    add_id,
    unknown_groups,
    unknown_units,
)
from satcheck.scene.scene_file.form import Problems, Wrong, converted, shown
from satcheck.scene.scene_file.placement import motion_of, placement, selector
from satcheck.scene.scene_file.text import Parsed, is_toml, parse
from satcheck.scene.statics import BodyRule, StaticsTerms
from satcheck.scene.units import MICROMETRES, parse_length, unit_of
from satcheck.scene.words import meant

# The tables, and lists of tables, in a scene.
_INNER = {"bodies": list, "rules": list, "motion": list, "statics": dict, "reading": dict}


def read_scene_file(path: str, location: Path, permitted: Permitted = NOTHING_ELSE) -> SceneFile:
    """Reads and checks a scene file. One with rules and without bodies is a file of rules.

    path: for messages; location: where it lies. permitted: where the meshes of a scene of the form
    satcheck.scene/1 may lie. Raises Refused.
    """
    parsed = parse(path, location)
    schema = _schema_of(parsed)
    if schema in (None, SCENE_1) and _has_only_rules(parsed.document):
        return _read_rules(parsed)
    if schema == SCENE_1:
        return _read(parsed, parsed.document, Problems(parsed), permitted)
    if schema == simple.SIMPLE and not is_toml(location):
        return simple.read_scene(parsed)
    raise _not_a_scene(path, schema)


def read_rules_file(path: str, location: Path) -> SceneFile:
    """Reads and checks a file of rules, which has the keys of satcheck.scene/1 but for those about
    bodies; `schema` may be left out. path, location: as above. Raises Refused."""
    parsed = parse(path, location)
    schema = _schema_of(parsed)
    if not isinstance(parsed.document, dict) or schema not in (None, SCENE_1):
        raise _not_a_scene(path, schema)
    return _read_rules(parsed)


def _schema_of(parsed: Parsed) -> object:
    return parsed.document.get("schema") if isinstance(parsed.document, dict) else None


def _not_a_scene(path: str, schema: object) -> Refused:
    told = "" if schema is None else f", but {shown(schema)}"
    message = f'not a scene file: "schema" is not "{SCENE_1}"{told}'
    return Refused("bad-scene", message, file=path)


def _has_only_rules(values: Any) -> bool:
    """Whether it has rules, and no key that only a scene with bodies has."""
    return isinstance(values, dict) and "rules" in values and values.keys() <= {*RULES_FILE_KEYS}


def _read_rules(parsed: Parsed) -> SceneFile:
    """A file of rules: a scene without bodies, which may leave out `schema` and `bodies`."""
    values, problems = parsed.document, Problems(parsed)
    for key in values.keys() - {*RULES_FILE_KEYS, "bodies"}:
        hint = meant(key, set(RULES_FILE_KEYS) - values.keys())
        problems.add(Wrong(f"unknown key{hint}", key))
    if values.get("bodies"):
        problems.add(Wrong("a file of rules has no bodies", "bodies"))
    if "rules" not in values:
        problems.add(Wrong('"rules" is missing'))
    stated = {key: values[key] for key in ("units", "rules", "statics", "accept") if key in values}
    return _read(parsed, stated | {"schema": SCENE_1, "bodies": []}, problems, NOTHING_ELSE)


def _read(
    parsed: Parsed, values: dict[str, Any], problems: Problems, permitted: Permitted
) -> SceneFile:
    """The inner tables are read one by one, so that an error in one does not hide those of others.

    values: of the document. Raises Refused with all errors.
    """
    path, units = parsed.path, values.get("units")
    units = units if isinstance(units, str) else None
    inner = {key: values[key] for key in _INNER if isinstance(values.get(key), _INNER[key])}
    outer = {key: _INNER[key]() if key in inner else value for key, value in values.items()}
    with problems.at():
        top = converted(outer, document.Scene)

    places = MeshPlaces(path, parsed.location, permitted)
    bodies: list[Item] = []
    ids: set[str] = set()
    for k, table in enumerate(inner.get("bodies", ())):
        with problems.at("bodies", k):
            body = _body(converted(table, document.Body), units, places, ids)
            bodies.append(replace(body, entry=Entry(path, number=k)))
    are_sound = not problems

    rules: list[Rule | BodyRule] = []
    tables = inner.get("rules", ())
    lines = parsed.lines([("rules", k) for k, _ in enumerate(tables)])
    for k, (table, line) in enumerate(zip(tables, lines, strict=True)):
        with problems.at("rules", k):
            of_bodies = isinstance(table, dict) and "bodies" in table
            kind: Any = document.BodyRule if of_bodies else document.Rule
            rules.append(_rule(converted(table, kind), units, path, line))

    motions: list[Motion] = []
    moved: dict[str, int] = {}
    for k, table in enumerate(inner.get("motion", ())):
        with problems.at("motion", k):
            motion = converted(table, document.Motion)
            motions += motion_of(motion, k, bodies if are_sound else None, moved)

    terms = None
    if "statics" in inner:
        with problems.at("statics"):
            terms = _terms(converted(inner["statics"], document.Statics), units)
    with problems.at("reading"):
        stated = inner.get("reading", {})
        reading = converted(stated, document.reading_table_for(stated))
    problems.raise_any()
    ignored = frozenset(top.ignore_within_groups)
    return SceneFile(
        path=path,
        name=top.name or parsed.location.stem,
        kind="scene" if bodies else "rules",
        units=units,
        items=tuple(bodies),
        ignore_within_groups=ignored,
        check_static=top.check_static,
        rules=tuple(rule for rule in rules if isinstance(rule, Rule)),
        body_rules=tuple(rule for rule in rules if isinstance(rule, BodyRule)),
        statics=terms,
        motions=tuple(motions),
        reading=reading.stated(),
        accept=top.accept,
        issues=(*unknown_units(units, path), *unknown_groups(ignored, bodies, path)),
    )


def _body(body: document.Body, units: str | None, places: MeshPlaces, ids: set[str]) -> Item:
    """units: of the scene. ids: of the bodies before; this call adds to them."""
    add_id(body.id, ids)
    own_units = None if body.units is UNSET else unit_of(body.units)
    if own_units is None and body.units is not UNSET:
        raise Wrong(f"one of {', '.join(MICROMETRES)} expected, not {shown(body.units)}", "units")
    shape = HalfSpace() if isinstance(body.shape, document.HalfSpace) else body.shape
    return Item(
        id=body.id,
        shape=shape or places.find(body.mesh or "", body.part or None),
        transform=placement(body),
        groups=body.groups,
        static=body.static,
        pinned=body.pinned,
        units=own_units,
        surface_tolerance=_length(body.surface_tolerance, units, "surface_tolerance"),
    )


def _rule(
    table: document.Rule | document.BodyRule, units: str | None, file: str, line: int
) -> Rule | BodyRule:
    values: dict[str, Any] = table.stated()
    for key in ("a", "b", "bodies"):
        if key in values:
            values[key] = selector(values[key], key)
    place: dict[str, Any] = {"where": f"{file}:{line}", "file": file, "line": line}
    if isinstance(table, document.BodyRule):
        return BodyRule(**values, **place)
    if table.allowed is True and table.reason is UNSET:
        raise Wrong('"reason" is missing: why may these pairs overlap?')
    lengths = {key: _length(values.get(key, UNSET), units, key) for key in LENGTHS}
    return Rule(**values | lengths | place)


def _terms(table: document.Statics, units: str | None) -> StaticsTerms:
    if table.gravity and not any(table.gravity):
        raise Wrong("a direction other than 0 expected", "gravity")
    values = table.stated()
    return StaticsTerms(**values | {"tolerance": _length(table.tolerance, units, "tolerance")})


def _length(value: float | str | UnsetType, units: str | None, key: str) -> float | None:
    """A length such as 0.5; also "2mm" if the scene declares units. Raises Wrong."""
    if value is UNSET:
        return None
    if not isinstance(value, str):
        return value
    try:
        length = parse_length(value)
    except ValueError as error:
        raise Wrong(str(error), key) from None
    try:
        return length.in_units_of(units)
    except ValueError as error:
        raise Wrong(f"{error}, or declare `units` in this file", key) from None
