"""The scene form `satcheck-scene-1`: JSON that places mesh files and says which pairs may touch.

    {"schema": "satcheck-scene-1", "name", "units",
     "bodies": [{"id", "mesh": path, from this file on, "transform": 4x4 rows,
                 "group", "static"}],
     "ignore_within_groups": [group], "allowed_pairs": [[id, id, reason]]}

A scene file that is wrong is refused as a whole: half a scene has no meaning. A misspelt key of a
body would move it or put it into no group, so it is wrong too; at the top a scene may carry more
than is read here, and an unknown key there is a warning. What a mesh path names is opened only when
its suffix is that of a mesh format, and content is never echoed.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from satcheck.core.errors import SatcheckError
from satcheck.scene.errors import SceneFileError
from satcheck.scene.issue import Issue, issue
from satcheck.scene.loading.regular_file import size_of
from satcheck.scene.loading.source import FORMATS
from satcheck.scene.units import is_unit

SCHEMA = "satcheck-scene-1"

_BODY_KEYS = frozenset(("id", "mesh", "transform", "group", "static"))
_SCENE_KEYS = frozenset(
    ("schema", "name", "units", "bodies", "ignore_within_groups", "allowed_pairs")
)
# What says where a scene comes from, and changes nothing.
_INFORMATION = frozenset(
    ("$schema", "author", "comment", "description", "licence", "license", "original", "source")
)

_MAX_BYTES = 256 << 20  # a million bodies
# A matrix whose determinant is this small against the product of its row lengths is singular up
# to the rounding of its own entries.
_SINGULAR = 2.0**-40


@dataclass(frozen=True, slots=True)
class BodyEntry:
    """One body as the scene file describes it. mesh: path for messages; location: on disk."""

    id: str
    mesh: str
    location: Path
    transform: tuple[float, ...] | None
    groups: tuple[str, ...]
    static: bool


@dataclass(frozen=True, slots=True)
class AllowedPair:
    """Two ids of the scene file, why they may overlap, and where that is written."""

    a: str
    b: str
    reason: str
    where: str


@dataclass(frozen=True, slots=True)
class SceneFile:
    """A scene file, checked, its meshes not yet read."""

    name: str
    units: str | None
    bodies: tuple[BodyEntry, ...]
    ignore_within_groups: frozenset[str]
    allowed_pairs: tuple[AllowedPair, ...]
    issues: tuple[Issue, ...]


def read_scene_file(path: str, location: Path) -> SceneFile:
    """Reads and checks a scene file; raises SceneFileError naming the body at fault."""
    return _Reader(path, location).read()


class _Reader:
    def __init__(self, path: str, location: Path) -> None:
        self._path = path
        self._location = location

    def read(self) -> SceneFile:
        document = self._parse()
        if not isinstance(document, dict) or document.get("schema") != SCHEMA:
            raise self._error("bad-scene", f'not a scene file: "schema" is not "{SCHEMA}"')
        if "bodies" not in document:
            hint = _meant("bodies", document.keys() - _SCENE_KEYS, " (did you mean it by {}?)")
            raise self._error("bad-scene", f'"bodies" is missing{hint}')
        entries = self._list(document, "bodies")
        bodies = tuple(self._body(entry, number) for number, entry in enumerate(entries))
        ids: set[str] = set()
        for body in bodies:
            if body.id in ids:
                raise self._error("duplicate-id", f"duplicate id {body.id!r}", body=body.id)
            ids.add(body.id)
        allowed, unknown_bodies = self._allowed_pairs(document, frozenset(ids))
        ignored = frozenset(
            self._string(group, "a group of ignore_within_groups")
            for group in self._list(document, "ignore_within_groups")
        )
        units = self._text(document, "units", None)
        return SceneFile(
            name=self._text(document, "name", self._location.stem),
            units=units,
            bodies=bodies,
            ignore_within_groups=ignored,
            allowed_pairs=allowed,
            issues=(
                *self._unknown_keys(document),
                *self._unknown_units(units),
                *self._unknown_groups(ignored, {group for body in bodies for group in body.groups}),
                *unknown_bodies,
            ),
        )

    def _unknown_keys(self, document: dict[str, Any]) -> list[Issue]:
        return [
            issue(
                "unknown-key",
                f"unknown key {key!r}{_meant(key, _SCENE_KEYS)}: it is ignored",
                file=self._path,
            )
            for key in document
            if key not in _SCENE_KEYS and key not in _INFORMATION
        ]

    def _unknown_units(self, units: str | None) -> list[Issue]:
        if units is None or is_unit(units):
            return []
        message = f"unknown units {units!r}: lengths are plain numbers"
        return [issue("unknown-units", message, file=self._path)]

    def _unknown_groups(self, ignored: frozenset[str], groups: set[str]) -> list[Issue]:
        return [
            issue(
                "unknown-group",
                f"no body is in group {group!r} of ignore_within_groups{_meant(group, groups)}",
                file=self._path,
            )
            for group in sorted(ignored - groups)
        ]

    def _error(self, code: str, message: str, body: str | None = None) -> SceneFileError:
        return SceneFileError(code, message, file=self._path, body=body)

    def _parse(self) -> Any:
        def refuse(_: str) -> float:
            return math.nan  # found again, with the body's name, where a number is expected

        try:
            if size_of(self._location) > _MAX_BYTES:
                raise self._error("too-large", f"larger than {_MAX_BYTES} bytes")
            text = self._location.read_text("utf-8-sig")
        except SceneFileError:
            raise
        except SatcheckError as error:
            raise self._error(error.code, error.message) from None
        except UnicodeDecodeError:
            raise self._error("bad-encoding", "the scene file is not UTF-8") from None
        except OSError as error:
            raise self._error("unreadable-file", f"cannot be read: {error.strerror}") from None
        try:
            return json.loads(text, parse_constant=refuse)
        except json.JSONDecodeError as error:
            raise self._error(
                "bad-scene", f"line {error.lineno}: not well-formed JSON: {error.msg}"
            ) from None
        except (RecursionError, ValueError) as error:  # too deep, or an integer of 10^5 digits
            raise self._error("bad-scene", f"not readable JSON: {error}") from None

    def _list(self, owner: dict[str, Any], key: str) -> list[Any]:
        value = owner.get(key, [])
        if not isinstance(value, list):
            raise self._error("bad-scene", f'"{key}" should be a list')
        return value

    def _text(self, owner: dict[str, Any], key: str, default: str | None) -> Any:
        value = owner.get(key)
        return default if value is None else self._string(value, f'"{key}"')

    def _string(self, value: Any, what: str, body: str | None = None) -> str:
        if not isinstance(value, str) or not value:
            raise self._error("bad-scene", f"{what} should be a non-empty text", body)
        return value

    def _body(self, entry: Any, number: int) -> BodyEntry:
        if not isinstance(entry, dict):
            raise self._error("bad-scene", f"body number {number + 1} is not an object")
        unknown = next((key for key in entry if key not in _BODY_KEYS), None)
        if unknown is not None:
            named = entry.get("id")
            known = isinstance(named, str) and named
            where = "" if known else f" of body number {number + 1}"
            hint = _meant(unknown, _BODY_KEYS - entry.keys())
            message = f"unknown key {unknown!r}{where}{hint}"
            raise self._error("bad-scene", message, named if known else None)
        id_ = self._string(entry.get("id"), f'"id" of body number {number + 1}')
        mesh = self._string(entry.get("mesh"), '"mesh"', id_)
        static = entry.get("static", False)
        if not isinstance(static, bool):
            raise self._error("bad-scene", '"static" should be true or false', id_)
        group = entry.get("group")
        return BodyEntry(
            id=id_,
            mesh=os.path.normpath(Path(self._path).parent / mesh).replace(os.sep, "/"),
            location=self._mesh_location(mesh, id_),
            transform=self._transform(entry.get("transform"), id_),
            groups=() if group is None else (self._string(group, '"group"', id_),),
            static=static,
        )

    def _mesh_location(self, mesh: str, body: str) -> Path:
        """Scenes share meshes across folders: not the place is judged, but what is there."""
        if "\0" in mesh:
            raise self._error("bad-scene", f"mesh path {mesh!r} holds a NUL character", body)
        location = self._location.parent / mesh
        if location.suffix.lower() not in FORMATS:
            raise self._error(
                "unsupported-format",
                f"mesh path {mesh!r} names no mesh format ({', '.join(sorted(FORMATS))}): refused",
                body,
            )
        if not location.is_file():
            raise self._error("missing-resource", f"mesh file {mesh!r} is missing", body)
        return location

    def _transform(self, rows: Any, body: str) -> tuple[float, ...] | None:
        if rows is None:
            return None
        is_4x4 = (
            isinstance(rows, list)
            and len(rows) == 4
            and all(isinstance(row, list) and len(row) == 4 for row in rows)
        )
        if not is_4x4:
            raise self._error("bad-scene", '"transform" should be 4 rows of 4 numbers', body)
        values = tuple(self._number(value, body) for row in rows for value in row)
        if values[12:] != (0.0, 0.0, 0.0, 1.0):
            raise self._error("singular-transform", "the last row should be 0 0 0 1", body)
        self._refuse_singular(values, body)
        return values

    def _number(self, value: Any, body: str) -> float:
        if type(value) not in (int, float):
            raise self._error("bad-scene", "the transform holds something else than numbers", body)
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise self._error("non-finite", "the transform holds a non-finite number", body)
        return number

    def _refuse_singular(self, values: tuple[float, ...], body: str) -> None:
        rows = [values[0:3], values[4:7], values[8:11]]
        lengths = [math.hypot(*row) for row in rows]
        if 0.0 in lengths:
            raise self._error("singular-transform", "singular transform: it scales by 0", body)
        a, b, c = (
            tuple(value / length for value in row)
            for row, length in zip(rows, lengths, strict=True)
        )
        determinant = (
            a[0] * (b[1] * c[2] - b[2] * c[1])
            - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
        )
        if abs(determinant) < _SINGULAR:
            raise self._error("singular-transform", "singular transform: it flattens space", body)

    def _allowed_pairs(
        self, document: dict[str, Any], ids: frozenset[str]
    ) -> tuple[tuple[AllowedPair, ...], tuple[Issue, ...]]:
        allowed, issues = [], []
        for number, entry in enumerate(self._list(document, "allowed_pairs")):
            if not isinstance(entry, list) or len(entry) not in (2, 3):
                raise self._error("bad-scene", "an allowed pair should be [id, id, reason]")
            a, b = (self._string(id_, "an id of allowed_pairs") for id_ in entry[:2])
            unknown = sorted({a, b} - ids)
            if unknown:
                names = " and ".join(map(repr, unknown))
                message = f"unknown id {names} in allowed_pairs: the entry is ignored"
                issues.append(issue("unknown-body", message, file=self._path))
            else:
                reason = entry[2] if len(entry) == 3 else ""
                reason = reason if isinstance(reason, str) else ""
                where = f"{self._path}: allowed_pairs[{number}]"
                allowed.append(AllowedPair(a, b, reason, where))
        return tuple(allowed), tuple(issues)


def _meant(word: str, known: Iterable[str], form: str = " (did you mean {}?)") -> str:
    """A question for the known word that `word` resembles most, empty when it resembles none."""
    from difflib import get_close_matches

    close = get_close_matches(word, sorted(known), n=1)
    return form.format(repr(close[0])) if close else ""
