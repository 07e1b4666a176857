"""A scene file as checked data, and the mesh files that it may name. These are not read yet."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from satcheck.scene.document import Document, FilePart, Item
from satcheck.scene.files.readers import mesh_reader, readers
from satcheck.scene.issue import Issue, issue
from satcheck.scene.opening import Permitted, followed, is_file, note
from satcheck.scene.scene_file.form import Wrong, shown
from satcheck.scene.units import is_unit
from satcheck.scene.words import meant

if TYPE_CHECKING:
    from satcheck.scene.motion import Motion
    from satcheck.scene.rules import Rule
    from satcheck.scene.statics import BodyRule, StaticsTerms


class SceneFile(Document, frozen=True, kw_only=True):
    """A document whose items have ids, and name mesh files or state shapes. Rules and motions
    refer to bodies of this file only. reading: the options with which its mesh files are read, by
    their names. accept: issues that may stay."""

    ignore_within_groups: frozenset[str]
    check_static: bool
    rules: tuple[Rule, ...]
    motions: tuple[Motion, ...] = ()
    body_rules: tuple[BodyRule, ...] = ()
    statics: StaticsTerms | None = None
    reading: Mapping[str, Any] = {}
    accept: tuple[str, ...] = ()


class MeshPlaces:
    """Finds the mesh files of one scene file.

    Each is checked once, even if many bodies use it. path: of the scene file, for messages;
    location: on disk. permitted: where meshes may lie beside its folder.
    """

    def __init__(self, path: str, location: Path, permitted: Permitted) -> None:
        self._above = Path(path).parent
        self._folder = location.parent
        self._own = followed(self._folder)
        self._permitted = permitted
        self._known: dict[str, FilePart] = {}

    def find(self, mesh: str, part: str | None = None) -> FilePart:
        """The mesh file that a body names. Raises Wrong if it is missing or may not be opened."""
        if mesh not in self._known:
            self._known[mesh] = self._judged(mesh)
        found = self._known[mesh]
        return found if part is None else replace(found, part=part)

    def _judged(self, mesh: str) -> FilePart:
        if "\0" in mesh:
            raise Wrong(f"mesh path {shown(mesh)} holds a NUL character", "mesh")
        location = self._folder / mesh
        if mesh_reader(location.suffix) is None:
            known = ", ".join(sorted(filter(mesh_reader, readers())))
            message = f"mesh path {shown(mesh)} names no mesh format ({known}): refused"
            raise Wrong(message, "mesh", code="unsupported-format")
        note(location)
        if not self._permitted.has(location, self._own):
            where = self._permitted.beyond("of the scene's folder")
            message = (
                f"mesh file {shown(mesh)} lies {where}: refused (allow it with --allow-outside)"
            )
            raise Wrong(message, "mesh", code="outside-path")
        if not is_file(location):
            raise Wrong(f"mesh file {shown(mesh)} is missing", "mesh", code="missing-resource")
        path = os.path.normpath(self._above / mesh).replace(os.sep, "/")
        return FilePart(path, str(location))


def add_id(id_: str, ids: set[str]) -> None:
    """Raises Wrong if a body before has this id."""
    if id_ in ids:
        raise Wrong(f"a second body {shown(id_)}", "id", code="duplicate-id")
    ids.add(id_)


def unknown_units(units: str | None, path: str) -> list[Issue]:
    """A warning if a scene declares unknown units."""
    if units is None or is_unit(units):
        return []
    message = f"unknown units {units!r}: lengths are plain numbers"
    return [issue("unknown-units", message, file=path)]


def unknown_groups(ignored: frozenset[str], bodies: Iterable[Item], path: str) -> list[Issue]:
    """Warnings about groups in ignore_within_groups without a body."""
    groups = {group for body in bodies for group in body.groups}
    return [
        issue(
            "unknown-group",
            f"no body is in group {group!r} of ignore_within_groups{meant(group, groups)}",
            file=path,
        )
        for group in sorted(ignored - groups)
    ]
