"""A scene file as data, checked, its meshes not yet read."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck.scene.issue import Issue, issue
from satcheck.scene.units import is_unit
from satcheck.scene.words import meant

if TYPE_CHECKING:
    from satcheck.core.shapes import Primitive
    from satcheck.core.transform import Transform
    from satcheck.scene.motion import Motion
    from satcheck.scene.rules import Rule

# What a scene file of each form names as its schema.
SCENE_1 = "satcheck.scene/1"
SIMPLE = "satcheck-scene-1"


class MeshPath(Struct, frozen=True):
    """path: for messages and reports. location: on disk."""

    path: str
    location: Path


NO_MESH = MeshPath("", Path())


class BodyEntry(Struct, frozen=True):
    """One body as the scene file describes it.

    mesh: NO_MESH where there is a shape instead. part: what to take of the mesh file; None: all.
    units: of the mesh, in the place of what its file states. surface_tolerance: in units of the
    scene.
    """

    id: str
    mesh: MeshPath
    part: str | None = None
    shape: Primitive | None = None
    transform: Transform | None = None
    groups: tuple[str, ...] = ()
    static: bool = False
    pinned: bool = False
    units: str | None = None
    surface_tolerance: float | None = None


class SceneFile(Struct, frozen=True):
    """ids are as written; rules and motions speak of the bodies of this file alone."""

    path: str
    name: str
    units: str | None
    bodies: tuple[BodyEntry, ...]
    ignore_within_groups: frozenset[str]
    check_static: bool
    rules: tuple[Rule, ...]
    motions: tuple[Motion, ...]
    issues: tuple[Issue, ...]


def unknown_units(units: str | None, path: str) -> list[Issue]:
    """A warning about units that a scene declares and that are none."""
    if units is None or is_unit(units):
        return []
    message = f"unknown units {units!r}: lengths are plain numbers"
    return [issue("unknown-units", message, file=path)]


def unknown_groups(ignored: frozenset[str], bodies: Iterable[BodyEntry], path: str) -> list[Issue]:
    """Warnings about groups of ignore_within_groups that have no body."""
    groups = {group for body in bodies for group in body.groups}
    return [
        issue(
            "unknown-group",
            f"no body is in group {group!r} of ignore_within_groups{meant(group, groups)}",
            file=path,
        )
        for group in sorted(ignored - groups)
    ]
