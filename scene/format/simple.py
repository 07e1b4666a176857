"""The scene form `satcheck-scene-1`: JSON that places mesh files and says which pairs may touch.

    {"schema": "satcheck-scene-1", "name", "units",
     "bodies": [{"id", "mesh": path, from this file on, "transform": 4x4 rows,
                 "group", "static"}],
     "ignore_within_groups": [group], "allowed_pairs": [[id, id, reason]]}

A misspelt key of a body would move it or put it into no group, so it is wrong; at the top a scene
may carry more than is read here, and an unknown key there is a warning. Scenes of this form share
meshes across folders: not the place of a mesh is judged, but its suffix.
"""

from __future__ import annotations

from typing import Any

from satcheck.scene.errors import SceneFileError
from satcheck.scene.format.entries import BodyEntry, SceneFile, unknown_groups, unknown_units
from satcheck.scene.format.mesh_places import MeshPlaces
from satcheck.scene.format.placement import is_4x4, singular, sixteen
from satcheck.scene.format.problems import Wrong
from satcheck.scene.format.text import Parsed
from satcheck.scene.issue import Issue, issue
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.words import meant

_BODY_KEYS = frozenset(("id", "mesh", "transform", "group", "static"))
_SCENE_KEYS = frozenset(
    ("schema", "name", "units", "bodies", "ignore_within_groups", "allowed_pairs")
)
# What says where a scene comes from, and changes nothing.
_INFORMATION = frozenset(
    ("$schema", "author", "comment", "description", "licence", "license", "original", "source")
)
_NO_TEXT = "should be a non-empty text"


def read_scene(parsed: Parsed) -> SceneFile:
    """Raises SceneFileError naming the body at fault."""
    return _Reader(parsed).read()


class _Reader:
    def __init__(self, parsed: Parsed) -> None:
        self._path = parsed.path
        self._document: dict[str, Any] = parsed.document
        self._default_name = parsed.location.stem
        self._places = MeshPlaces(parsed.path, parsed.location, anywhere=True)

    def read(self) -> SceneFile:
        if "bodies" not in self._document:
            strangers = self._document.keys() - _SCENE_KEYS
            hint = meant("bodies", strangers, " (did you mean it by {}?)")
            raise self._error("bad-scene", f'"bodies" is missing{hint}')
        bodies = tuple(self._body(entry, index) for index, entry in enumerate(self._list("bodies")))
        ids: set[str] = set()
        for body in bodies:
            if body.id in ids:
                raise self._error("duplicate-id", f"duplicate id {body.id!r}", body=body.id)
            ids.add(body.id)
        allowed, unknown_bodies = self._allowed_pairs(frozenset(ids))
        ignored = frozenset(
            self._string(group, "a group of ignore_within_groups")
            for group in self._list("ignore_within_groups")
        )
        units = self._text("units")
        return SceneFile(
            path=self._path,
            name=self._text("name") or self._default_name,
            units=units,
            bodies=bodies,
            ignore_within_groups=ignored,
            check_static=True,
            rules=allowed,
            motions=(),
            issues=(
                *self._unknown_keys(),
                *unknown_units(units, self._path),
                *unknown_groups(ignored, bodies, self._path),
                *unknown_bodies,
            ),
        )

    def _unknown_keys(self) -> list[Issue]:
        return [
            issue(
                "unknown-key",
                f"unknown key {key!r}{meant(key, _SCENE_KEYS)}: it is ignored",
                file=self._path,
            )
            for key in self._document
            if key not in _SCENE_KEYS and key not in _INFORMATION
        ]

    def _error(self, code: str, message: str, body: str | None = None) -> SceneFileError:
        return SceneFileError(code, message, file=self._path, body=body)

    def _list(self, key: str) -> list[Any]:
        value = self._document.get(key, [])
        if not isinstance(value, list):
            raise self._error("bad-scene", f'"{key}" should be a list')
        return value

    def _text(self, key: str) -> str | None:
        value = self._document.get(key)
        return None if value is None else self._string(value, f'"{key}"')

    def _string(self, value: Any, what: str, body: str | None = None) -> str:
        if not isinstance(value, str) or not value:
            raise self._error("bad-scene", f"{what} {_NO_TEXT}", body)
        return value

    def _body(self, entry: Any, index: int) -> BodyEntry:
        if not isinstance(entry, dict):
            raise self._error("bad-scene", f"body number {index + 1} is not an object")
        if not _BODY_KEYS.issuperset(entry):
            raise self._unknown_key(entry, index)
        id_ = entry.get("id")
        if not isinstance(id_, str) or not id_:
            raise self._error("bad-scene", f'"id" of body number {index + 1} {_NO_TEXT}')
        mesh = self._string(entry.get("mesh"), '"mesh"', id_)
        static = entry.get("static", False)
        if not isinstance(static, bool):
            raise self._error("bad-scene", '"static" should be true or false', id_)
        group = entry.get("group")
        try:
            found = self._places.find(mesh)
        except Wrong as wrong:
            raise self._error(wrong.code, wrong.message, id_) from None
        return BodyEntry(
            id=id_,
            mesh=found,
            transform=self._transform(entry.get("transform"), id_),
            groups=() if group is None else (self._string(group, '"group"', id_),),
            static=static,
        )

    def _unknown_key(self, entry: dict[str, Any], index: int) -> SceneFileError:
        unknown = next(key for key in entry if key not in _BODY_KEYS)
        named = entry.get("id")
        known = isinstance(named, str) and named
        where = "" if known else f" of body number {index + 1}"
        hint = meant(unknown, _BODY_KEYS - entry.keys())
        message = f"unknown key {unknown!r}{where}{hint}"
        return self._error("bad-scene", message, named if known else None)

    def _transform(self, rows: Any, body: str) -> tuple[float, ...] | None:
        if rows is None:
            return None
        if not is_4x4(rows):
            raise self._error("bad-scene", '"transform" should be 4 rows of 4 numbers', body)
        try:
            values = sixteen(rows)
        except Wrong as wrong:
            what = "a non-finite number" if wrong.code == "non-finite" else "something else"
            message = f"the transform holds {what}, where numbers are expected"
            raise self._error(wrong.code, message, body) from None
        if (fault := singular(values)) is not None:
            raise self._error("singular-transform", fault, body)
        return values

    def _allowed_pairs(self, ids: frozenset[str]) -> tuple[tuple[Rule, ...], list[Issue]]:
        allowed, issues = [], []
        for index, entry in enumerate(self._list("allowed_pairs")):
            if not isinstance(entry, list) or len(entry) not in (2, 3):
                raise self._error("bad-scene", "an allowed pair should be [id, id, reason]")
            a, b = (self._string(id_, "an id of allowed_pairs") for id_ in entry[:2])
            unknown = sorted({a, b} - ids)
            if unknown:
                names = " and ".join(map(repr, unknown))
                message = f"unknown id {names} in allowed_pairs: the entry is ignored"
                issues.append(issue("unknown-body", message, file=self._path))
                continue
            reason = entry[2] if len(entry) == 3 and isinstance(entry[2], str) else ""
            where = f"{self._path}: allowed_pairs[{index}]"
            one, other = Selector.exactly(a), Selector.exactly(b)
            allowed.append(Rule(a=one, b=other, allowed=True, reason=reason, where=where))
        return tuple(allowed), issues
