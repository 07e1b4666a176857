"""The bodies of a report, read again from their files."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from satcheck.scene import Body, MeshFile, MeshFileError
from satcheck.scene.loading import load_mesh_file
from satcheck.scene.primitives import primitive_of
from satcheck.scene.shape_file import shape_file
from satcheck.verify.exact import Floats, Rejected
from satcheck.verify.world import Indices, World, is_balanced, is_convex, placed

SECONDS_PER_FILE = 60.0
MEGABYTES_PER_FILE = 2048


@dataclass(frozen=True, slots=True)
class Shape:
    """A mesh file, or a primitive. convex: exactly, in its own coordinates. A solid is balanced."""

    file: MeshFile
    vertices: Floats
    triangles: Indices
    convex: bool


@dataclass(frozen=True, slots=True)
class Placed:
    """A body of the report, or why it cannot be had. resolution: world units, recomputed."""

    id: str
    groups: frozenset[str]
    world: World | None
    convex: bool = False
    resolution: float = 0.0
    reason: str | None = None
    claims: bool = True  # False: the report calls it unreadable


class Bodies:
    """Reads each file once."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._shapes: dict[tuple[str, str], Shape | str] = {}

    def place(self, entry: Any) -> Placed:
        """entry: one of the report's bodies. A file that is gone or has changed is a reason."""
        if not isinstance(entry, dict) or not isinstance(entry.get("id"), str):
            raise Rejected("a body of the report has no id")
        listed = entry.get("groups")
        if not isinstance(listed, list) or not all(isinstance(group, str) for group in listed):
            raise Rejected("the groups of a body are a list of texts")
        groups = frozenset(listed)
        name, file, digest = entry["id"], entry.get("file"), entry.get("sha256")
        if digest is None:
            return Placed(name, groups, None, reason="the report could not read it", claims=False)
        if not isinstance(file, str) or not isinstance(digest, str):
            raise Rejected("a body of the report names no file")
        values = entry.get("shape")
        key = (file, json.dumps(values))
        if key not in self._shapes:
            self._shapes[key] = self._read(file) if values is None else _primitive(file, values)
        shape = self._shapes[key]
        if isinstance(shape, str):
            return Placed(name, groups, None, reason=shape)
        if shape.file.sha256 != digest:
            return Placed(name, groups, None, reason=f"{file} has changed: its SHA-256 is another")
        try:
            return self._placed(name, groups, shape, entry)
        except Rejected as why:
            return Placed(name, groups, None, reason=str(why))

    def _read(self, file: str) -> Shape | str:
        try:
            return shape_of(
                load_mesh_file(
                    file, self._root / file, seconds=SECONDS_PER_FILE, megabytes=MEGABYTES_PER_FILE
                )
            )
        except (MeshFileError, Rejected) as error:
            absent = isinstance(error, MeshFileError) and error.code == "file-not-found"
            return f"{error}, looked for from {self._root.absolute()} on" if absent else str(error)

    def _placed(
        self, name: str, groups: frozenset[str], shape: Shape, entry: dict[str, Any]
    ) -> Placed:
        health = entry.get("health")
        if not isinstance(health, dict) or health.get("solid") is not shape.file.health.solid:
            raise Rejected("said to be solid, or not, and the file says otherwise")
        return place_shape(name, groups, shape, _pose(entry.get("transform")))


def _primitive(file: str, values: Any) -> Shape | str:
    """The shape as the report states it; `file`, the scene that stated it, is not read again."""
    try:
        return shape_of(shape_file(primitive_of(values), file))
    except (MeshFileError, Rejected, ValueError) as error:
        return f"{file}: not a shape: {error}"


def shape_of(file: MeshFile) -> Shape:
    vertices = np.array(file.mesh.vertices)
    triangles = np.array(file.mesh.triangles, dtype=np.int64)
    solid = file.health.solid
    if solid and not is_balanced(vertices, triangles):
        raise Rejected("said to be solid, but its surface is not closed or not evenly wound")
    return Shape(file, vertices, triangles, solid and is_convex(vertices, triangles))


def place_shape(
    name: str, groups: Iterable[str], shape: Shape, pose: tuple[float, ...] | None
) -> Placed:
    world = placed(shape.vertices, shape.triangles, shape.file.health.solid, pose)
    resolution = Body(name, name, shape.file, pose).resolution_world
    if not np.isfinite(resolution):
        raise Rejected("its placement is out of range")
    return Placed(name, frozenset(groups), world, shape.convex, resolution)


def _pose(value: Any) -> tuple[float, ...] | None:
    """Row-major 4 x 4."""
    if value is None:
        return None
    numbers: Sequence[Any] = value if isinstance(value, list) and len(value) == 16 else [None]
    if any(isinstance(n, bool) or not isinstance(n, int | float) for n in numbers):
        raise Rejected("a transform has 16 numbers")
    try:
        pose = tuple(float(n) for n in numbers)
    except OverflowError:
        raise Rejected("a transform has 16 finite numbers") from None
    if not np.isfinite(pose).all():
        raise Rejected("a transform has 16 finite numbers")
    return pose
