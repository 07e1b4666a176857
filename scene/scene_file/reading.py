"""Reads and checks any scene file, by the schema that it names. The mesh files that it names are
not read yet.

A scene with errors is refused as a whole, because a part of a scene has no meaning. An unknown key
is an error, because it may be important.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Any

from msgspec.structs import replace

from satcheck.core.shapes import HalfSpace
from satcheck.scene.access import NOTHING_ELSE, Context, Permitted
from satcheck.scene.bodies import Entry
from satcheck.scene.document import FilePart, Item
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import mesh_endings, mesh_reader
from satcheck.scene.issue import Issue, issue
from satcheck.scene.motion import Motion
from satcheck.scene.opening import name_of, suffix_of
from satcheck.scene.rules import Rule, RuleKeys
from satcheck.scene.scene_file import document
from satcheck.scene.scene_file.document import SCENE_1
from satcheck.scene.scene_file.form import converted, shown
from satcheck.scene.scene_file.joined import SceneFile
from satcheck.scene.scene_file.text import SceneText
from satcheck.scene.statics import BodyRule, BodyRuleKeys, StaticsTerms
from satcheck.scene.table import Wrong
from satcheck.scene.units import MICROMETRES, is_unit, unit_of
from satcheck.scene.words import meant

Places = Callable[[str, str | None], FilePart]  # of the keys `mesh` and `part` of a body

SIMPLE = "satcheck-scene-1"
_OF_RULES = {*document.RulesFile.__struct_encode_fields__}
_OF_SCENE = {*document.Scene.__struct_encode_fields__}
# The tables, and lists of tables, in a scene.
_INNER = {"bodies": list, "rules": list, "motion": list, "statics": dict, "reading": dict}


def read_scene_file(path: str, permitted: Permitted = NOTHING_ELSE) -> SceneFile:
    """Reads and checks a scene file. One with rules and without bodies is a file of rules.

    permitted: where the meshes of a scene of the form satcheck.scene/1 may lie. Raises Refused.
    """
    text = SceneText(path, permitted.most)
    values, schema = text.document, _schema_of(text)
    if schema == SIMPLE and not text.is_toml:
        from satcheck.scene.scene_file.simple import read_scene

        return read_scene(text)
    is_ours = isinstance(values, dict) and schema in (None, SCENE_1)
    if is_ours and "rules" in values and values.keys() <= _OF_RULES:
        return _read(text, permitted, document.RulesFile)
    if schema != SCENE_1:
        keys = values.keys() - _OF_SCENE if schema is None and isinstance(values, dict) else ()
        raise _not_a_scene(text, schema, sorted(keys))
    return _read(text, permitted, document.Scene)


def read_rules_file(path: str, permitted: Permitted = NOTHING_ELSE) -> SceneFile:
    """Reads and checks a file of rules, which has the keys of satcheck.scene/1 but for those about
    bodies; `schema` may be left out. permitted: how large it may be. Raises Refused."""
    text = SceneText(path, permitted.most)
    schema = _schema_of(text)
    if not isinstance(text.document, dict) or schema not in (None, SCENE_1):
        raise _not_a_scene(text, schema)
    if text.document.pop("bodies", None):
        text.keep(Wrong("a file of rules has no bodies", "bodies"))
    return _read(text, NOTHING_ELSE, document.RulesFile)


def _schema_of(text: SceneText) -> object:
    return text.document.get("schema") if isinstance(text.document, dict) else None


def _not_a_scene(text: SceneText, schema: object, unknown: Sequence[str] = ()) -> Refused:
    """Return the error, at the line of the schema if it is stated. unknown: keys that no scene
    has."""
    told = "" if schema is None else f", but {shown(schema)}"
    message = f'not a scene file: "schema" is not "{SCENE_1}"{told}'
    if isinstance(schema, str) and re.match(r"satcheck\.(?!scene)", schema):
        message += ": it is a result of satcheck, so give the files that it is about"
    hints = ((key, meant(key, _OF_SCENE)) for key in unknown)
    message += "".join(f"; {key} is unknown{hint}" for key, hint in hints if hint)
    line = None if schema is None else text.lines([("schema",)])[0]
    return Refused("bad-scene", message, file=text.path, line=line)


def _read(text: SceneText, permitted: Permitted, kind: type[document.RulesFile]) -> SceneFile:
    """The inner tables are read one by one, so that an error in one does not hide those of others.
    Raises Refused with all errors."""
    if nulls := list(text.nulls()):
        for keys in nulls:
            text.keep(Wrong("null is no value: leave it out", *keys))
        text.raise_any()
    values, path = text.document, text.path
    units = values.get("units") if isinstance(values.get("units"), str) else None
    inner = {key for key, form in _INNER.items() if isinstance(values.get(key), form)}
    outer = {key: _INNER[key]() if key in inner else value for key, value in values.items()}
    with text.at():
        top = converted(outer, kind)
    places = mesh_places(path, permitted)
    ids: set[str] = set()
    moved: dict[str, int] = {}
    count = len(values["rules"]) if "rules" in inner else 0
    lines = text.lines([("rules", k) for k in range(count)])

    def body(table: Any, number: int) -> Item:
        entry = Entry(path, number=number, text=text.text)
        return _body(converted(table, document.Body, units), entry, places, ids)

    def rule(table: Any, number: int) -> Rule | BodyRule:
        return _rule(table, units, path, lines[number])

    def motion(table: Any, number: int) -> Motion | None:
        return _motion(converted(table, document.Motion), number, known, moved)

    bodies = text.each("bodies", body)
    known = bodies if text.is_right else None
    rules = text.each("rules", rule)
    motions = text.each("motion", motion)
    terms, reading = None, None
    with text.at("statics"):
        if "statics" in inner:
            terms = converted(values["statics"], StaticsTerms, units)
    with text.at("reading"):
        if "reading" in inner:
            stated = values["reading"]
            reading = converted(stated, document.reading_table(stated))
    text.raise_any()
    scene = top if isinstance(top, document.Scene) else None
    return scene_file(
        text,
        top,
        bodies,
        ignored=frozenset(scene.ignore_within_groups if scene else ()),
        check_static=scene is not None and scene.check_static,
        rules=tuple(rule for rule in rules if isinstance(rule, Rule)),
        body_rules=tuple(rule for rule in rules if isinstance(rule, BodyRule)),
        statics=terms,
        motions=tuple(filter(None, motions)),
        reading={} if reading is None else reading.stated(),
        accept=top.accept,
    )


def scene_file(
    text: SceneText,
    top: Any,
    bodies: Sequence[Item],
    ignored: frozenset[str],
    issues: Sequence[Issue] = (),
    **more: Any,
) -> SceneFile:
    """Return what a file of either form states. top: its table, with the keys that both forms have.
    issues, more: of its form."""
    return SceneFile(
        path=text.path,
        name=top.name or name_of(text.path)[0],
        kind="scene" if bodies else "rules",
        units=top.units,
        items=tuple(bodies),
        ignore_within_groups=ignored,
        issues=(*issues, *_useless(top.units, ignored, bodies, text.path)),
        **more,
    )


def _useless(
    units: str | None, ignored: frozenset[str], bodies: Sequence[Item], path: str
) -> Iterator[Issue]:
    """Warnings about unknown units, and about groups in ignore_within_groups without a body."""
    if units is not None and not is_unit(units):
        message = f"unknown units {units!r}: lengths are plain numbers"
        yield issue("unknown-units", message, file=path)
    groups = {group for body in bodies for group in body.groups}
    for group in sorted(ignored - groups):
        message = f"no body is in group {group!r} of ignore_within_groups{meant(group, groups)}"
        yield issue("unknown-group", message, file=path)


def _body(body: document.Body, entry: Entry, places: Places, ids: set[str]) -> Item:
    """ids: of the bodies before; this call adds to them."""
    add_id(body.id, ids)
    units = None if body.units is None else unit_of(body.units)
    if units is None and body.units is not None:
        raise Wrong(f"one of {', '.join(MICROMETRES)} expected, not {shown(body.units)}", "units")
    shape = HalfSpace() if isinstance(body.shape, document.HalfSpace) else body.shape
    return Item(
        id=body.id,
        shape=shape or places(body.mesh or "", body.part),
        transform=body.placement(),
        groups=body.groups,
        static=body.static,
        pinned=body.pinned,
        units=units,
        surface_tolerance=body.surface_tolerance,
        entry=entry,
    )


def add_id(id_: str, ids: set[str]) -> None:
    """Raises Wrong if a body before has this id."""
    if id_ in ids:
        raise Wrong(f"a second body {shown(id_)}", "id", code="duplicate-id")
    ids.add(id_)


def mesh_places(path: str, permitted: Permitted) -> Places:
    """Return what finds the mesh files of one scene file, and raises Wrong for one that is missing
    or may not be opened. Each is checked once, even if many bodies use it.

    path: of the scene file. permitted: where meshes may lie beside its folder.
    """
    context = Context(os.path.dirname(path) or os.curdir, permitted)  # noqa: PTH120

    @cache
    def found(mesh: str, part: str | None) -> FilePart:
        if part is not None:
            return replace(found(mesh, None), part=part)
        if mesh_reader(suffix_of(mesh)) is None:
            message = f"mesh path {shown(mesh)} names no mesh format ({mesh_endings()}): refused"
            raise Wrong(message, "mesh", code="unsupported-format")
        try:
            place = context.find("mesh file", mesh)
        except Refused as error:
            raise Wrong(error.message, "mesh", code=error.code) from None
        return FilePart(os.path.normpath(place).replace(os.sep, "/"), place)

    return found


def _rule(table: Any, units: str | None, file: str, line: int) -> Rule | BodyRule:
    place: dict[str, Any] = {"where": f"{file}:{line}", "file": file, "line": line}
    if isinstance(table, dict) and "bodies" in table:
        return BodyRule(**converted(table, BodyRuleKeys).stated(), **place)
    keys = converted(table, RuleKeys, units)
    if keys.allowed and not keys.reason:
        raise Wrong('"reason" is missing: why may these pairs overlap?')
    return Rule(**keys.stated(), **place)


def _motion(
    table: document.Motion, number: int, bodies: Sequence[Item] | None, moved: dict[str, int]
) -> Motion | None:
    """The motion, if the bodies of the scene are known. Raises Wrong and SatcheckError.

    moved: id of each moving body -> number of its motion; this call adds to it.
    """
    way = table.way()
    if bodies is None:
        return None
    ids: dict[str, None] = {}
    for choice in table.bodies:
        chosen = choice.select(bodies)
        if not chosen:
            raise _immovable(f"no body matches {shown(choice.text)}")
        for body in chosen:
            if body.static:
                raise _immovable(f"body {shown(body.id)} is static")
            ids[body.id] = None
    for id_ in ids:
        if (other := moved.setdefault(id_, number)) != number:
            raise _immovable(f"body {shown(id_)} is moved by motion[{other}] already")
    return Motion(tuple(ids), way, table.clear)


def _immovable(message: str) -> Wrong:
    return Wrong(message, "bodies", code="bad-motion")
