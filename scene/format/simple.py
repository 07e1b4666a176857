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

from typing import Any

from satcheck.core.transform import Transform
from satcheck.scene.format.entries import (
    NO_MESH,
    BodyEntry,
    SceneFile,
    unknown_groups,
    unknown_units,
)
from satcheck.scene.format.mesh_places import MeshPlaces
from satcheck.scene.format.placement import matrix
from satcheck.scene.format.problems import Wrong
from satcheck.scene.format.table import Table, read_bodies
from satcheck.scene.format.text import Parsed
from satcheck.scene.format.values import boolean, list_of, shown, text
from satcheck.scene.issue import Issue, issue
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.words import meant

_BODY_KEYS = frozenset(("id", "mesh", "transform", "group", "static"))
_SCENE_KEYS = frozenset(
    ("schema", "name", "units", "bodies", "ignore_within_groups", "allowed_pairs")
)
# Keys that say where a scene comes from. They change no answer.
_INFORMATION = frozenset(
    ("$schema", "author", "comment", "description", "licence", "license", "original", "source")
)


def read_scene(parsed: Parsed) -> SceneFile:
    """Raises SceneFileError with all errors of the file."""
    path, problems = parsed.path, parsed.problems()
    top = Table(parsed.document, (), problems)
    places = MeshPlaces(path, parsed.location, anywhere=True)
    if "bodies" not in top:
        strangers = top.values.keys() - _SCENE_KEYS
        hint = meant("bodies", strangers, " (did you mean it by {}?)")
        top.wrong(f'"bodies" is missing{hint}')
    bodies = read_bodies(top, lambda table: _body(table, places))
    ignored = frozenset(top.read("ignore_within_groups", list_of("texts", text), []))
    units = top.read("units", _text_or_null, None)
    pairs = top.read("allowed_pairs", list_of("pairs", _pair), [])
    name = top.read("name", _text_or_null, None) or parsed.location.stem
    problems.raise_any(path, parsed.lines)
    rules, unknown_bodies = _rules(pairs, {body.id for body in bodies}, path)
    return SceneFile(
        path=path,
        name=name,
        units=units,
        bodies=bodies,
        ignore_within_groups=ignored,
        check_static=True,
        rules=rules,
        motions=(),
        issues=(
            *_unknown_keys(top, path),
            *unknown_units(units, path),
            *unknown_groups(ignored, bodies, path),
            *unknown_bodies,
        ),
    )


def _body(table: Table, places: MeshPlaces) -> BodyEntry:
    table.only(_BODY_KEYS)
    group = table.read("group", _text_or_null, None)
    return BodyEntry(
        id=table.required("id", text, ""),
        mesh=table.required("mesh", places.find, NO_MESH),
        transform=table.read("transform", _matrix_or_null, None),
        groups=() if group is None else (group,),
        static=table.read("static", boolean, False),
    )


def _text_or_null(value: Any) -> str | None:
    return None if value is None else text(value)


def _matrix_or_null(value: Any) -> Transform | None:
    return None if value is None else matrix(value)


def _pair(value: Any) -> tuple[str, str, str]:
    """(id, id, reason)"""
    if not isinstance(value, list) or len(value) not in (2, 3):
        raise Wrong(f"[id, id, reason] expected, not {shown(value)}")
    reason = value[2] if len(value) == 3 and isinstance(value[2], str) else ""
    return text(value[0]), text(value[1]), reason


def _rules(
    pairs: list[tuple[str, str, str]], ids: set[str], path: str
) -> tuple[tuple[Rule, ...], list[Issue]]:
    rules, issues = [], []
    for index, (a, b, reason) in enumerate(pairs):
        if unknown := sorted({a, b} - ids):
            names = " and ".join(map(repr, unknown))
            message = f"unknown id {names} in allowed_pairs: the entry is ignored"
            issues.append(issue("unknown-body", message, file=path))
            continue
        first, second = Selector.exactly(a), Selector.exactly(b)
        where = f"{path}: allowed_pairs[{index}]"
        rules.append(Rule(a=first, b=second, allowed=True, reason=reason, where=where, file=path))
    return tuple(rules), issues


def _unknown_keys(top: Table, path: str) -> list[Issue]:
    return [
        issue(
            "unknown-key",
            f"unknown key {key!r}{meant(key, _SCENE_KEYS)}: it is ignored",
            file=path,
        )
        for key in top.values
        if key not in _SCENE_KEYS and key not in _INFORMATION
    ]
