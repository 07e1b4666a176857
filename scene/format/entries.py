"""A scene file as data, checked, its meshes not yet read."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct

if TYPE_CHECKING:
    from satcheck.core.shapes import Primitive
    from satcheck.scene.bodies import Transform
    from satcheck.scene.issue import Issue
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
    units: of the mesh, in the place of what its file states.
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
