"""The bodies of a report, read again from their files."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from msgspec import to_builtins

from satcheck.core.shapes import HalfSpace, Primitive, Sphere, image_of, is_curved
from satcheck.report.bodies import BodyReport
from satcheck.report.settings import Plane
from satcheck.scene import Body, MeshFile, MeshHealth, Refused, Scene
from satcheck.scene.access import Permitted
from satcheck.scene.document import FilePart
from satcheck.scene.files.readers import ReadLimits, ReadOptions
from satcheck.scene.half_spaces import holds
from satcheck.scene.inspect import shape_file
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.planar.flat_scene import flat_scene
from satcheck.scene.planar.outline import shape_from
from satcheck.verify.curved import Curved
from satcheck.verify.exact import Floats, NotCertified, Point, Rejected, point, sub
from satcheck.verify.meshes import bounds_nothing, is_balanced, is_convex, with_backs
from satcheck.verify.world import Exact, Indices, World, placed

# What a report states about a readable mesh.
_OF_A_MESH = ("health", "triangles", "resolution", "convex", "parts", "part_error")
SAME = 1e-12  # relative, of a length that was computed twice


@dataclass(frozen=True)
class Shape:
    """A mesh file, or a primitive. triangles: of the file, then the reverse of those of the sheets
    of a solid. solid: balanced, with an inside. holed: it has holes with unknown fills. pieces: the
    sheets of an open mesh, unless it is meant to be open. curved: the shape in which the mesh is
    inscribed."""

    file: MeshFile
    vertices: Floats
    triangles: Indices
    solid: bool
    holed: bool = False
    pieces: Indices | None = None
    curved: Primitive | None = None

    @cached_property
    def convex(self) -> bool:
        """Whether it is, exactly, in its own coordinates."""
        if self.curved is not None:
            return True
        return self.file.health.solid and is_convex(self.vertices, self.triangles)


class Missing(Rejected):
    """A file does not exist: its name, as the report says it."""


class Unread(Rejected):
    """The report states that it could not read a body."""


@dataclass(frozen=True, slots=True)
class Placed:
    """A body of the report, a mesh in the world or a curved shape, or why it is lost.

    resolution: world units, recomputed. surface_tolerance: how far its surface may be off, world
    units, as the report says. endless: it is a half space.
    """

    id: str
    groups: frozenset[str]
    world: World | None
    shape: Shape | None = None
    resolution: float = 0.0
    static: bool = False
    lost: Rejected | None = None
    curved: Curved | None = None
    surface_tolerance: float = 0.0
    endless: bool = False

    @property
    def claims(self) -> bool:
        """False: the report states that it is unreadable."""
        return not isinstance(self.lost, Unread)

    @property
    def convex(self) -> bool:
        return self.shape is not None and self.shape.convex

    @property
    def holed(self) -> bool:
        return self.shape is not None and self.shape.holed

    @property
    def deviation(self) -> float:
        """With --planar, the largest distance of the boundary from its polygon, which lies within
        it."""
        return 0.0 if self.shape is None else self.shape.file.deviation

    @property
    def mesh(self) -> World:
        if self.world is None:
            raise Rejected(f"{self.id} has no mesh in the world")
        return self.world

    @property
    def exact(self) -> Curved | Exact:
        """A mesh on a lattice of its own."""
        return self.curved or Exact(self.mesh, self.mesh.lattice)

    @property
    def bounds(self) -> tuple[Floats, Floats] | None:
        if self.world is not None:
            return self.world.bounds
        return None if self.curved is None else self.curved.bounds

    @property
    def ball(self) -> tuple[tuple[float, float, float], float]:
        """The centre and the radius of a ball. Raises NotCertified for other shapes, and for balls
        that are scaled unevenly."""
        image = None if self.curved is None else self.curved.image
        if image is not None and isinstance(image.primitive, Sphere):
            stretch = [math.hypot(*column) for column in image.columns]
            if max(stretch) - min(stretch) <= SAME * max(stretch):
                return image.origin, image.primitive.radius * stretch[0]
        raise NotCertified(f"{self.id}: the contacts of such a shape are not certified")

    def moved(self, offset: list[float]) -> Placed:
        """Each coordinate is rounded once."""
        world = None if self.world is None else self.world.moved(offset)
        return replace(self, world=world, curved=self.curved and self.curved.moved(offset))


def curve_error(*bodies: Placed) -> Fraction:
    """Return how much closer (or deeper) two bodies may be than their polygons, world units; 0: the
    polygons are exact."""
    return sum((Fraction(body.deviation) for body in bodies), Fraction())


def box_gaps(a: Placed, b: Placed) -> Point:
    """How far the boxes of two bodies are apart along each axis, exactly; below 0 if they overlap
    there. Rejects bodies without boxes."""
    if a.bounds is None or b.bounds is None:
        raise Rejected("a body that cannot be read may hold others")
    (low_a, high_a), (low_b, high_b) = (tuple(map(point, body)) for body in (a.bounds, b.bounds))
    return point(map(max, sub(low_b, high_a), sub(low_a, high_b)))


class Bodies:
    """Reads each file once. allow_open: open meshes are meant to be open. reading: as the report
    states it."""

    def __init__(
        self,
        root: Path,
        *,
        allow_open: bool = False,
        allow_outside: bool = False,
        reading: ReadOptions = {},  # noqa: B006  nobody changes it
    ) -> None:
        self._root, self._allow_open = root, allow_open
        permitted = Permitted(anywhere=allow_outside)
        self._files = MeshFiles(ReadLimits(permitted=permitted, options=reading))
        self._shapes: dict[tuple[str, object, bool], Shape] = {}

    def place_all(self, entries: Sequence[BodyReport], plane: Plane | None) -> list[Placed]:
        """The report's bodies; with --planar, the prisms over their outlines. If a file is missing
        or has changed, the body has a reason instead of a mesh."""
        found: dict[str, tuple[Body, Shape]] = {}
        placed: dict[str, Placed] = {}
        for entry in entries:
            try:
                found[entry.id] = self._find(entry)
            except Rejected as why:
                placed[entry.id] = _lost(entry, why)
        prisms: dict[str, MeshFile] | None = None
        if plane is not None:
            bodies = tuple(body for body, _ in found.values())
            flat = flat_scene(Scene("", None, bodies), plane, allow_open=self._allow_open)
            prisms = {body.id: body.file for body in flat.bodies}

        def place(entry: BodyReport) -> Placed:
            body, shape = found[entry.id]
            if prisms is None:
                return _place(body, shape, body.transform, entry)
            if entry.id not in prisms:
                raise Rejected("it has no outline in the plane")
            return _place(body, shape_of(prisms[entry.id]), None, entry)

        def reaching(entry: BodyReport) -> Placed:
            if isinstance(found[entry.id][0].shape, HalfSpace):
                _require_reach(entry.id, placed, found, in_space=plane is None)
            return placed[entry.id]

        for step in (place, reaching):
            for entry in entries:
                if entry.id in found:
                    try:
                        placed[entry.id] = step(entry)
                    except Rejected as why:
                        placed[entry.id] = _lost(entry, why)
        return [placed[entry.id] for entry in entries]

    def _find(self, entry: BodyReport) -> tuple[Body, Shape]:
        """The body as the report places it."""
        if entry.sha256 is None:
            if any(getattr(entry, key) is not None for key in _OF_A_MESH):
                raise Rejected("not read, and figures of its mesh")
            raise Unread("the report could not read it")
        shape = self._shape(entry)
        if shape.file.sha256 != entry.sha256:
            raise Rejected(f"{entry.file} has changed: its SHA-256 is another")
        body = Body(
            *(entry.id, entry.id, shape.file, entry.transform, entry.groups),
            static=entry.static,
            open=entry.open,
            shape=None if entry.shape is None else shape_from(to_builtins(entry.shape)),
        )
        return body, shape

    def _shape(self, entry: BodyReport) -> Shape:
        """The file or its node, or a primitive as the report states it: the scene file that stated
        it is not read again."""
        if entry.shape is None:
            mesh = self._files.mesh(FilePart(entry.file, str(self._root / entry.file), entry.path))
            if isinstance(mesh, Refused):
                absent = mesh.code == "file-not-found"
                raise Missing(entry.file) if absent else Rejected(str(mesh))
            key: tuple[str, object, bool] = (entry.file, mesh.part, entry.open)
            if key not in self._shapes:
                allow_open = self._allow_open or entry.open
                self._shapes[key] = shape_of(mesh, allow_open=allow_open)
        elif entry.path is not None:
            raise Rejected("a shape is no node of a file")
        else:
            key = entry.file, entry.shape, False
            if key not in self._shapes:
                self._shapes[key] = _primitive(entry.file, to_builtins(entry.shape))
        return self._shapes[key]


def _primitive(file: str, values: Any) -> Shape:
    try:
        shape = shape_from(values)
        made = shape_file(shape, file)
    except (Refused, ValueError) as error:
        raise Rejected(f"{file}: not a shape: {error}") from None
    return curved_of(made, shape) if is_curved(shape) else shape_of(made)


def _require_reach(
    floor: str,
    placed: Mapping[str, Placed],
    found: Mapping[str, tuple[Body, Shape]],
    *,
    in_space: bool,
) -> None:
    """Rejects a half space whose block is too small for another body. in_space: else the bodies of
    `placed` are prisms, which are taller than any body."""
    for other in placed.values():
        bounds = other.bounds
        if not in_space and other.id in found:
            bounds = found[other.id][0].world_mesh().bounds  # type: ignore[assignment]
        if other.id != floor and bounds is not None and not other.endless:
            low, high = (tuple(map(float, corner)) for corner in bounds)
            if not holds(found[floor][0], (low, high)):  # type: ignore[arg-type]
                raise Rejected(f"{other.id} lies beyond the reach of the half space")


def _lost(entry: BodyReport, why: Rejected) -> Placed:
    return Placed(entry.id, frozenset(entry.groups), None, static=entry.static, lost=why)


def _place(body: Body, shape: Shape, pose: tuple[float, ...] | None, entry: BodyReport) -> Placed:
    placed = place_shape(body.id, body.groups, shape, pose)
    _check_figures(entry, shape, placed.resolution)
    return replace(
        placed,
        static=body.static,
        surface_tolerance=entry.surface_tolerance or 0.0,
        endless=isinstance(body.shape, HalfSpace),
    )


def _check_figures(entry: BodyReport, shape: Shape, resolution: float) -> None:
    """Compares what the report states about the mesh with the file."""
    file, health = shape.file, entry.health
    if health is None:
        raise Rejected("the report says nothing of its health")
    for name in MeshHealth.__struct_fields__:
        value, stated = getattr(file.health, name), getattr(health, name)
        if isinstance(value, float) and not math.isfinite(value):
            value = None  # as a report says it
        if stated != value:
            raise Rejected(f"the file says {name}: {value}, the report {stated}")
    if entry.triangles != file.mesh.triangle_count:
        raise Rejected(f"it has {file.mesh.triangle_count} triangles")
    stated = entry.resolution
    if stated is None or not math.isclose(stated, resolution, rel_tol=SAME):
        raise Rejected(f"its resolution is {resolution!r}")
    if entry.convex is not None and entry.convex != shape.convex:
        raise Rejected(f"convex is {shape.convex}")


def shape_of(file: MeshFile, *, allow_open: bool = False) -> Shape:
    """allow_open: open meshes are meant to be open."""
    vertices = np.array(file.mesh.vertices)
    triangles = np.array(file.mesh.triangles, dtype=np.int64)
    if file.health.solid:
        if not is_balanced(vertices, triangles):
            raise Rejected("said to be solid, but its surface is not closed or not evenly wound")
        return Shape(file, vertices, triangles, True)
    is_doubtful = file.health.doubtful
    both = None if is_doubtful else with_backs(vertices, triangles, allow_open=allow_open)
    pieces = None if both is None or allow_open else both[len(triangles) :]
    if both is None or bounds_nothing(vertices, both):
        return Shape(file, vertices, triangles, False, both is None, pieces)
    return Shape(file, vertices, both, True, pieces=pieces)


def curved_of(file: MeshFile, primitive: Primitive) -> Shape:
    """file: of the inscribed mesh, which needs no check."""
    vertices, triangles = np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    return Shape(file, vertices, triangles, True, curved=primitive)


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
    return Placed(name, frozenset(groups), world, shape, resolution, curved=curved)
