"""The scene form `satcheck-scene-1`: JSON that places mesh files and says which pairs may touch.

    {"schema": "satcheck-scene-1", "name", "units",
     "bodies": [{"id", "mesh": path, from this file on, "transform": 4x4 rows,
                 "group", "static"}],
     "ignore_within_groups": [group], "allowed_pairs": [[id, id, reason]]}

A misspelt key of a body would misplace it or leave it without a group, so an unknown key there is
an error. At the top level a scene may carry other data, so an unknown key there is only a warning.
Scenes of this form share meshes across folders: the suffix of a mesh is checked, its folder is not.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from msgspec.structs import replace

from satcheck.scene.bodies import Entry
from satcheck.scene.document import Item
from satcheck.scene.issue import Issue, issue
from satcheck.scene.opening import ANYWHERE
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.scene_file.document import Matrix, Text, Texts
from satcheck.scene.scene_file.entries import (
    MeshPlaces,
    SceneFile,
    add_id,
    unknown_groups,
    unknown_units,
)
from satcheck.scene.scene_file.form import Problems, Table, Wrong, converted
from satcheck.scene.scene_file.placement import matrix
from satcheck.scene.scene_file.text import Parsed
from satcheck.scene.words import meant

SIMPLE = "satcheck-scene-1"
# Keys that say where a scene comes from. They change no answer.
_INFORMATION = frozenset(
    ("$schema", "author", "comment", "description", "licence", "license", "original", "source")
)


class Body(Table, frozen=True):
    id: Text
    mesh: Text
    transform: Matrix | None = None
    group: Text | None = None
    static: bool = False


class Scene(Table, frozen=True, forbid_unknown_fields=False):
    bodies: tuple[Any, ...]
    schema: str
    name: Text | None = None
    units: Text | None = None
    ignore_within_groups: Texts = ()
    allowed_pairs: tuple[Any, ...] = ()


def read_scene(parsed: Parsed) -> SceneFile:
    """Raises Refused with all errors of the file."""
    path, values, problems = parsed.path, parsed.document, Problems(parsed)
    inner = {k: v for k in ("bodies", "allowed_pairs") if isinstance(v := values.get(k), list)}
    if "bodies" not in values:
        hint = meant(
            "bodies", values.keys() - set(Scene.__struct_fields__), " (did you mean it by {}?)"
        )
        problems.add(Wrong(f'"bodies" is missing{hint}'))
    outer = {"bodies": [], **values, **{key: [] for key in inner}}
    with problems.at():
        top = converted(outer, Scene)
    places = MeshPlaces(path, parsed.location, ANYWHERE)
    bodies: list[Item] = []
    ids: set[str] = set()
    for k, table in enumerate(inner.get("bodies", ())):
        with problems.at("bodies", k):
            body = _entry(converted(table, Body), places, ids)
            bodies.append(replace(body, entry=Entry(path, number=k)))
    pairs: list[tuple[Any, ...]] = []
    for k, pair in enumerate(inner.get("allowed_pairs", ())):
        with problems.at("allowed_pairs", k):
            explained = isinstance(pair, list) and len(pair) == 3
            kind: Any = tuple[Text, Text, Any] if explained else tuple[Text, Text]
            pairs.append(converted(pair, kind))
    problems.raise_any()
    rules, unknown_bodies = _rules(pairs, ids, path)
    ignored = frozenset(top.ignore_within_groups)
    return SceneFile(
        path=path,
        name=top.name or parsed.location.stem,
        kind="scene" if bodies else "rules",
        units=top.units,
        items=tuple(bodies),
        ignore_within_groups=ignored,
        check_static=True,
        rules=rules,
        issues=(
            *_unknown_keys(values, path),
            *unknown_units(top.units, path),
            *unknown_groups(ignored, bodies, path),
            *unknown_bodies,
        ),
    )


def _entry(body: Body, places: MeshPlaces, ids: set[str]) -> Item:
    """ids: of the bodies before; this call adds to them."""
    add_id(body.id, ids)
    return Item(
        id=body.id,
        shape=places.find(body.mesh),
        transform=None if body.transform is None else matrix(body.transform, "transform"),
        groups=() if body.group is None else (body.group,),
        static=body.static,
    )


def _rules(
    pairs: Iterable[tuple[Any, ...]], ids: set[str], path: str
) -> tuple[tuple[Rule, ...], list[Issue]]:
    rules, issues = [], []
    for index, (a, b, *rest) in enumerate(pairs):
        if unknown := sorted({a, b} - ids):
            names = " and ".join(map(repr, unknown))
            message = f"unknown id {names} in allowed_pairs: the entry is ignored"
            issues.append(issue("unknown-body", message, file=path))
            continue
        first, second = Selector.exactly(a), Selector.exactly(b)
        reason = rest[0] if rest and isinstance(rest[0], str) else ""
        where = f"{path}: allowed_pairs[{index}]"
        rules.append(Rule(a=first, b=second, allowed=True, reason=reason, where=where, file=path))
    return tuple(rules), issues


def _unknown_keys(values: Mapping[str, Any], path: str) -> list[Issue]:
    keys = frozenset(Scene.__struct_fields__)
    return [
        issue("unknown-key", f"unknown key {key!r}{meant(key, keys)}: it is ignored", file=path)
        for key in values
        if key not in keys and key not in _INFORMATION
    ]
