"""The bodies of a report, read again from their files."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from satcheck.core.shapes import Primitive, image_of, is_curved, primitive_of
from satcheck.scene import Body, MeshFile, MeshFileError, MeshHealth, Scene
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.mesh_units import placing_mesh, shape_of_mesh
from satcheck.scene.planar.laid_flat import laid_flat
from satcheck.scene.shape_file import shape_file
from satcheck.verify.curved import Curved
from satcheck.verify.exact import Floats, Rejected
from satcheck.verify.open_parts import bounds_nothing, with_backs
from satcheck.verify.world import Indices, World, is_balanced, is_convex, placed

# What a report says of a mesh that it could read.
_OF_A_MESH = ("health", "triangles", "resolution", "convex", "parts", "part_error")
SAME = 1e-12  # relative, of a length that was computed twice


@dataclass(frozen=True, slots=True)
class Shape:
    """A mesh file, or a primitive. triangles: of the file, then the reverse of those of the sheets
    of a solid. solid: balanced, and bounds something. convex: exactly, in its own coordinates.
    holed: it has holes. pieces: the sheets of an open mesh, unless it is meant to be open. curved:
    what the mesh is only within."""

    file: MeshFile
    vertices: Floats
    triangles: Indices
    solid: bool
    convex: bool
    holed: bool = False
    pieces: Indices | None = None
    curved: Primitive | None = None


@dataclass(frozen=True, slots=True)
class Missing:
    """A file that is not there, as the report names it."""

    file: str


@dataclass(frozen=True, slots=True)
class Placed:
    """A body of the report, a mesh in the world or a curved shape, or why it cannot be read.

    resolution: world units, recomputed. convex: also of every curved shape. holed: the mesh has
    holes, and nobody knows what fills them. pieces: as of its `Shape`. missing: the file that is
    not there, as the report names it. deviation: in a check in a plane, how far the boundary may be
    off the polygon that stands for it; inscribed: which lies within it.
    """

    id: str
    groups: frozenset[str]
    world: World | None
    convex: bool = False
    holed: bool = False
    pieces: Indices | None = None
    resolution: float = 0.0
    static: bool = False
    reason: str | None = None
    claims: bool = True  # False: the report calls it unreadable
    curved: Curved | None = None
    missing: str | None = None
    deviation: float = 0.0
    inscribed: bool = False

    @property
    def bounds(self) -> tuple[Floats, Floats] | None:
        if self.world is not None:
            return self.world.bounds
        return None if self.curved is None else self.curved.bounds

    def moved(self, offset: list[float]) -> Placed:
        """Each coordinate is rounded once."""
        world = None if self.world is None else self.world.moved(offset)
        return replace(self, world=world, curved=self.curved and self.curved.moved(offset))


class Bodies:
    """Reads each file once. allow_open: open meshes are meant to be open."""

    def __init__(
        self, root: Path, *, allow_open: bool = False, allow_outside: bool = False
    ) -> None:
        self._root, self._allow_open = root, allow_open
        self._files = MeshFiles(allow_outside=allow_outside)
        self._shapes: dict[tuple[str, str | None, str], Shape | str] = {}

    def place_all(self, entries: list[Any], plane: str | None) -> list[Placed]:
        """The report's bodies; in a check in a plane the prisms over their outlines, each as the
        bodies stand together."""
        if plane is None:
            return [self.place(entry) for entry in entries]
        given = [self._find(entry) for entry in entries]
        bodies = [one[0] for one in given if not isinstance(one, Placed)]
        scene = Scene("", None, tuple(bodies))
        flat = laid_flat(scene, cast(Any, plane), allow_open=self._allow_open)
        prisms = {body.id: body.file for body in flat.bodies}
        return [
            one if isinstance(one, Placed) else _outline(one[0], prisms.get(one[0].id), entry)
            for one, entry in zip(given, entries, strict=True)
        ]

    def place(self, entry: Any) -> Placed:
        """entry: one of the report's bodies. A file that is gone or has changed is a reason."""
        found = self._find(entry)
        if isinstance(found, Placed):
            return found
        body, shape = found
        try:
            placed = place_shape(body.id, body.groups, shape, body.transform)
            _check_figures(entry, shape, placed.resolution)
        except Rejected as why:
            return _lost(body, str(why))
        return replace(placed, static=body.static)

    def _find(self, entry: Any) -> tuple[Body, Shape] | Placed:
        """The body as the report places it, or the reason why it cannot be read."""
        if not isinstance(entry, dict) or not isinstance(entry.get("id"), str):
            raise Rejected("a body of the report has no id")
        listed = entry.get("groups")
        if not isinstance(listed, list) or not all(isinstance(group, str) for group in listed):
            raise Rejected("the groups of a body are a list of texts")
        groups, static = frozenset(listed), entry.get("static") is True
        name, file, digest = entry["id"], entry.get("file"), entry.get("sha256")
        if digest is None:
            if any(entry.get(key) is not None for key in _OF_A_MESH):
                raise Rejected(f"{name}: not read, and figures of its mesh")
            reason = "the report could not read it"
            return Placed(name, groups, None, static=static, reason=reason, claims=False)
        if not isinstance(file, str) or not isinstance(digest, str):
            raise Rejected("a body of the report names no file")
        path, values = entry.get("path"), entry.get("shape")
        if path is not None and not isinstance(path, str):
            raise Rejected("the path of a body within its file is a text")
        if values is not None and path is not None:
            raise Rejected("a shape is no node of a file")
        shape = self._read(file, path) if values is None else self._primitive(file, values)
        if isinstance(shape, Missing):
            reason = "its file is not there"
            return Placed(name, groups, None, static=static, reason=reason, missing=shape.file)
        if isinstance(shape, str):
            return Placed(name, groups, None, static=static, reason=shape)
        if shape.file.sha256 != digest:
            reason = f"{file} has changed: its SHA-256 is another"
            return Placed(name, groups, None, static=static, reason=reason)
        try:
            pose = _pose(entry.get("transform"))
        except Rejected as why:
            return Placed(name, groups, None, static=static, reason=str(why))
        primitive = None if values is None else shape_of_mesh(shape.file, primitive_of(values))
        pose = placing_mesh(shape.file, pose)
        found = Body(name, name, shape.file, pose, tuple(listed), static=static, shape=primitive)
        return found, shape

    def _read(self, file: str, path: str | None) -> Shape | Missing | str:
        """The file, or the mesh of its node `path`."""
        location = self._root / file
        if path is None:
            found = self._files.whole(file, location)
        else:
            node = self._files.part(file, location, path)
            found = node if isinstance(node, MeshFileError) else node.file
        if isinstance(found, MeshFileError):
            return Missing(file) if found.code == "file-not-found" else str(found)
        key = (file, found.part, "")
        if key not in self._shapes:
            self._shapes[key] = _checked_shape(found, self._allow_open)
        return self._shapes[key]

    def _primitive(self, file: str, values: Any) -> Shape | str:
        """As the report states it; `file`, the scene that stated it, is not read again."""
        key = (file, None, json.dumps(values))
        if key not in self._shapes:
            try:
                primitive = primitive_of(values)
                made = shape_file(primitive, file)
                primitive = shape_of_mesh(made, primitive) or primitive
                curved = is_curved(primitive)
                self._shapes[key] = (
                    curved_of(made, primitive) if curved else _checked_shape(made, False)
                )
            except (MeshFileError, ValueError) as error:
                self._shapes[key] = f"{file}: not a shape: {error}"
        return self._shapes[key]


def _lost(body: Body, reason: str) -> Placed:
    return Placed(body.id, frozenset(body.groups), None, static=body.static, reason=reason)


def _outline(body: Body, prism: MeshFile | None, entry: dict[str, Any]) -> Placed:
    if prism is None:
        return _lost(body, "it has no outline in the plane")
    shape = _checked_shape(prism, False)
    if isinstance(shape, str):
        return _lost(body, shape)
    try:
        placed = place_shape(body.id, body.groups, shape, None)
        _check_figures(entry, shape, placed.resolution)
    except Rejected as why:
        return _lost(body, str(why))
    return replace(placed, static=body.static)


def _check_figures(entry: dict[str, Any], shape: Shape, resolution: float) -> None:
    """What the report says of the mesh, against the file."""
    file = shape.file
    health = entry.get("health") or {}
    for name in MeshHealth.__struct_fields__:
        value = getattr(file.health, name)
        if isinstance(value, float) and not math.isfinite(value):
            value = None  # as a report says it
        if name not in health or health[name] != value:
            raise Rejected(f"the file says {name}: {value}, the report {health.get(name)}")
    if entry.get("triangles") != file.mesh.triangle_count:
        raise Rejected(f"it has {file.mesh.triangle_count} triangles")
    said = entry.get("resolution")
    if said is None or not math.isclose(said, resolution, rel_tol=SAME):
        raise Rejected(f"its resolution is {resolution!r}")
    if entry.get("convex") not in (None, shape.convex):
        raise Rejected(f"convex is {shape.convex}")


def _checked_shape(file: MeshFile, allow_open: bool) -> Shape | str:
    try:
        return shape_of(file, allow_open=allow_open)
    except Rejected as why:
        return str(why)


def shape_of(file: MeshFile, *, allow_open: bool = False) -> Shape:
    """allow_open: open meshes are meant to be open."""
    vertices = np.array(file.mesh.vertices)
    triangles = np.array(file.mesh.triangles, dtype=np.int64)
    if file.health.solid:
        if not is_balanced(vertices, triangles):
            raise Rejected("said to be solid, but its surface is not closed or not evenly wound")
        return Shape(file, vertices, triangles, True, is_convex(vertices, triangles))
    both = with_backs(vertices, triangles, allow_open=allow_open)
    pieces = None if both is None or allow_open else both[len(triangles) :]
    if both is None or bounds_nothing(vertices, both):
        return Shape(file, vertices, triangles, False, False, both is None, pieces)
    return Shape(file, vertices, both, True, False, pieces=pieces)


def curved_of(file: MeshFile, primitive: Primitive) -> Shape:
    """file: of the mesh within the shape, of which nothing is asked."""
    vertices, triangles = np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    return Shape(file, vertices, triangles, True, True, curved=primitive)


def place_shape(
    name: str, groups: Iterable[str], shape: Shape, pose: tuple[float, ...] | None
) -> Placed:
    world = curved = None
    if shape.curved is None:
        world = placed(shape.vertices, shape.triangles, shape.solid, pose)
    else:
        if pose is not None and tuple(pose[12:]) != (0.0, 0.0, 0.0, 1.0):
            raise Rejected("the pose is not affine")
        curved = Curved(image_of(shape.curved, pose))
    try:
        resolution = Body(name, name, shape.file, pose).resolution_world
    except OverflowError:
        resolution = np.inf
    if not np.isfinite(resolution):
        raise Rejected("its placement is out of range")
    return Placed(
        name,
        frozenset(groups),
        world,
        shape.convex,
        shape.holed,
        shape.pieces,
        resolution,
        curved=curved,
        deviation=shape.file.deviation,
        inscribed=shape.file.inscribed,
    )


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
