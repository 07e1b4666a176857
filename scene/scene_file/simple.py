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

from satcheck.scene.access import ANYWHERE
from satcheck.scene.bodies import Entry
from satcheck.scene.document import Item
from satcheck.scene.issue import Issue, issue
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.scene_file.document import Matrix, affine
from satcheck.scene.scene_file.form import converted
from satcheck.scene.scene_file.joined import SceneFile
from satcheck.scene.scene_file.reading import add_id, mesh_places, scene_file
from satcheck.scene.scene_file.text import SceneText
from satcheck.scene.table import Table, Text, Texts, Wrong
from satcheck.scene.words import meant

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


def read_scene(text: SceneText) -> SceneFile:
    """Raises Refused with all errors of the file."""
    values, known = text.document, frozenset(Scene.__struct_fields__)
    places = mesh_places(text.path, ANYWHERE)
    ids: set[str] = set()
    issues: list[Issue] = []

    def body(table: Any, number: int) -> Item:
        own = converted(table, Body)
        add_id(own.id, ids)
        return Item(
            id=own.id,
            shape=places(own.mesh, None),
            transform=None if own.transform is None else affine(own.transform, "transform"),
            groups=() if own.group is None else (own.group,),
            static=own.static,
            entry=Entry(text.path, number=number, text=text.text),
        )

    def rule(pair: Any, number: int) -> Rule | None:
        explained = isinstance(pair, list) and len(pair) == 3
        kind: Any = tuple[Text, Text, Any] if explained else tuple[Text, Text]
        a, b, *rest = converted(pair, kind)
        if unknown := sorted({a, b} - ids):
            names = " and ".join(map(repr, unknown))
            message = f"unknown id {names} in allowed_pairs: the entry is ignored"
            issues.append(issue("unknown-body", message, file=text.path))
            return None
        return Rule(
            a=Selector.exactly(a),
            b=Selector.exactly(b),
            allowed=True,
            reason=rest[0] if rest and isinstance(rest[0], str) else "",
            where=f"{text.path}: allowed_pairs[{number}]",
            file=text.path,
        )

    if "bodies" not in values:
        hint = meant("bodies", values.keys() - known, " (did you mean it by {}?)")
        text.keep(Wrong(f'"bodies" is missing{hint}'))
    with text.at():
        top = converted({"bodies": [], **values}, Scene)
    bodies, rules = text.each("bodies", body), text.each("allowed_pairs", rule)
    text.raise_any()
    strange = [
        f"unknown key {key!r}{meant(key, known)}: it is ignored"
        for key in values
        if key not in known | _INFORMATION
    ]
    return scene_file(
        text,
        top,
        bodies,
        ignored=frozenset(top.ignore_within_groups),
        check_static=True,
        issues=[*(issue("unknown-key", said, file=text.path) for said in strange), *issues],
        rules=tuple(filter(None, rules)),
    )
