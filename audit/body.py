"""A body in the world, its box, and the data derived from it, each made once and on demand."""

from __future__ import annotations

import math
from _thread import RLock, allocate_lock  # threading takes longer to import
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar

from satcheck import core
from satcheck.audit.settings import Settings
from satcheck.core.conventions import Vector
from satcheck.core.curved.placed import CurvedShape, curved_shape
from satcheck.core.rounding import CHAIN_ROUNDOFFS, UNIT_ROUNDOFF
from satcheck.core.shapes import is_curved
from satcheck.core.steps import step
from satcheck.scene.bodies import is_half_space, resolution_in_world
from satcheck.scene.files.readers import is_complete
from satcheck.scene.inspect import CRACK_WIDTH

if TYPE_CHECKING:
    from satcheck.decompose import Decomposition, DecompositionError
    from satcheck.scene import Body, MeshFile
    from satcheck.scene.planar.outline import Shape as StatedShape
    from satcheck.verify.bodies import Placed, Shape


Box = tuple[Vector, Vector]


def largest_coordinate(*boxes: Box) -> float:
    """The largest |coordinate|."""
    return max([max(-x, -y, -z, u, v, w) for (x, y, z), (u, v, w) in boxes])


def corners(box: Box) -> list[Vector]:
    (x, y, z), (u, v, w) = box
    return [(i, j, k) for i in (x, u) for j in (y, v) for k in (z, w)]


def around_both(a: Box, b: Box) -> Box:
    (x, y, z), (u, v, w) = a
    (p, q, r), (f, g, h) = b
    return (min(x, p), min(y, q), min(z, r)), (max(u, f), max(v, g), max(w, h))


def diagonal(box: Box, axes: tuple[int, ...] | None = None) -> float:
    low, high = box
    return math.dist(low, high) if axes is None else math.hypot(*(high[k] - low[k] for k in axes))


def box_escape(a: Box, b: Box) -> tuple[float, Vector]:
    """The shortest translation of A after which the boxes have no common interior.

    Returns its length and the unit normal from A to B; the translation is -length * normal. The
    length is rounded outward, and 0.0 if the boxes do not overlap. Ties go to the first axis,
    negative side first.
    """
    best, normal = math.inf, (1.0, 0.0, 0.0)
    for axis in range(3):
        for sign, reach in (
            (1.0, a[1][axis] - b[0][axis]),
            (-1.0, b[1][axis] - a[0][axis]),
        ):
            if reach < best:
                best = reach
                normal = tuple(sign if k == axis else 0.0 for k in range(3))  # type: ignore[assignment]
    return max(best, 0.0) * (1 + 2 * UNIT_ROUNDOFF), normal


T = TypeVar("T")
MeshKey = tuple[str, str | int, str | None, bool]

# Of the meshes around and within a curved body in many poses.
_SEGMENTS = 16
# Held while a body gets its (still empty) geometry.
_MAKING = allocate_lock()


class Once(Generic[T]):
    """A value made by the first thread that needs it; `known` is None until then."""

    __slots__ = ("_lock", "_make", "known")

    def __init__(self, make: Callable[[], T]) -> None:
        self._make = make
        self._lock = RLock()
        self.known: T | None = None

    def __call__(self) -> T:
        with self._lock:
            if self.known is None:
                self.known = self._make()
            return self.known


def mesh_key(file: MeshFile, *, is_open: bool) -> MeshKey:
    """The same key for the same mesh, while the mesh exists. The SHA-256 is not enough, because
    equal files may refer to different neighbour files."""
    return file.path, file.sha256 or id(file.mesh), file.part, is_open


class SharedMesh:
    """The data that all bodies with one mesh share, in file coordinates.

    geometry: tree, hull and convexity. posed: of bodies with this mesh and a shape. largest: the
    largest absolute coordinate. is_complete: its reader leaves nothing out without a word.
    covers_once(): the solid covers no point twice, so its volume is that of its mesh. has_sheets():
    parts of the surface of the solid have no inside on either side.
    """

    __slots__ = (
        "covers_once",
        "decomposition",
        "file",
        "geometry",
        "has_sheets",
        "is_complete",
        "largest",
        "posed",
        "shape",
        "surface_tolerance",
        "triangles",
    )

    def __init__(
        self,
        file: MeshFile,
        settings: Settings,
        *,
        is_open: bool = False,
    ) -> None:
        """is_open: it is meant to be open."""
        self.file = file
        is_open = is_open or settings.allow_open
        self.triangles = file.mesh.triangle_count
        self.surface_tolerance = settings.surface_tolerance
        self.largest = file.mesh.largest_coordinate
        self.is_complete = is_complete(file.format)
        health = file.health
        self.geometry = geometry = core.Geometry(
            file.mesh, health.solid, health.plain_solid, is_open
        )
        self.posed: dict[StatedShape | None, core.PosedBody] = {}
        # None of these holds this object, so that it goes with its last body, not with a later
        # search for cycles.
        self.covers_once = Once(lambda: core.covers_once(geometry.surface()))
        crack = CRACK_WIDTH * file.resolution if health.cracks else 0.0
        self.has_sheets = Once(lambda: core.has_sheets(geometry.surface(), crack))
        self.decomposition = Once(partial(_decomposition, file, settings))
        self.shape = Once(partial(_shape, file, is_open))

    @staticmethod
    def terms(settings: Settings) -> tuple[object, ...]:
        """Return the settings that these data depend on."""
        asked = settings
        return (
            *(asked.allow_open, asked.surface_tolerance, asked.part_threshold, asked.part_seed),
            *(asked.part_seconds, asked.part_megabytes, asked.cache, asked.cache_directory),
        )


def _shape(file: MeshFile, allow_open: bool) -> Shape:
    """As the checker of certificates sees it."""
    from satcheck.verify.bodies import shape_of

    return shape_of(file, allow_open=allow_open)


def _decomposition(file: MeshFile, settings: Settings) -> Decomposition | DecompositionError:
    """A failure is kept, too, and not tried again for the next pair."""
    from satcheck.decompose import Cache, DecompositionError, decompose, user_cache

    directory = settings.cache_directory
    cache = user_cache() if directory is None else Cache(Path(directory))
    try:
        with step(f"splitting {file.path}", settings.part_seconds):
            return decompose(
                file.mesh,
                threshold=settings.part_threshold,
                seed=settings.part_seed,
                seconds=settings.part_seconds,
                megabytes=settings.part_megabytes,
                cache=cache if settings.cache else None,
            )
    except DecompositionError as error:
        return error


def _surface_tolerance(body: Body, setting: float | None) -> float:
    """Return the surface tolerance of the scene, or else of the check, or else of the facets that a
    reader made."""
    if body.surface_tolerance is not None:
        return body.surface_tolerance
    return body.facet_tolerance if setting is None else setting


def _curved(body: Body) -> CurvedShape | None:
    """ValueError if the transform does not give a shape of this kind."""
    if not is_curved(body.shape):
        return None
    return curved_shape(body.shape, body.transform)


def _posed(body: Body, geometry: core.Geometry) -> core.PosedBody:
    shape = body.shape
    if not is_curved(shape):
        return core.PosedBody(geometry)
    from satcheck.core.shape_mesh import meshes_beside, shape_bounds

    around, within = (core.Geometry(mesh, True) for mesh in meshes_beside(shape, _SEGMENTS))
    return core.PosedBody(*shape_bounds(shape), around, within)


def _checked(body: Body, shared: SharedMesh, surface_tolerance: float) -> Placed:
    from dataclasses import replace

    from satcheck.verify.bodies import curved_of, place_shape

    shape = curved_of(body.file, body.shape) if is_curved(body.shape) else shared.shape()
    placed = place_shape(body.id, body.groups, shape, body.transform)
    return replace(placed, surface_tolerance=surface_tolerance)


class PlacedBody:
    """World frame. bounds: ((x, y, z), (x, y, z)), and their diagonal; resolution: the input
    precision, world units; surface_tolerance: how far its surface may be off; endless: it is a
    half space; stretch: how much the transform stretches lengths at most, to rounding.

    curved: the shape of a curved body; its mesh is then only inscribed, and its bounds enclose the
    shape. Most bodies of a large scene are far from all others, so all other data are made on
    demand and can be released.
    """

    __slots__ = (
        "_checked",
        "_geometry",
        "body",
        "bounds",
        "curved",
        "diagonal",
        "endless",
        "id",
        "resolution",
        "shared",
        "solid",
        "stretch",
        "surface_tolerance",
    )

    def __init__(self, body: Body, shared: SharedMesh, bounds: Box | None = None) -> None:
        """bounds: of the mesh, where known. ValueError, OverflowError when it cannot be placed."""
        self.body = body
        self.shared = shared
        self.id = body.id
        self.bounds: Box = body.world_mesh().bounds if bounds is None else bounds
        self.curved = None if body.shape is None else _curved(body)
        if self.curved is not None:
            self.bounds = self.curved.bounds()
        self.diagonal = diagonal(self.bounds)
        transform = body.transform
        self.stretch = 1.0 if transform is None else core.largest_stretch(transform)
        self.resolution = resolution_in_world(body.file, transform, shared.largest, self.stretch)
        self.solid = body.file.health.solid
        self.endless = body.shape is not None and is_half_space(body)
        self.surface_tolerance = _surface_tolerance(body, shared.surface_tolerance)
        self._geometry: core.PlacedGeometry | None = None
        self._checked: Placed | None = None

    @property
    def geometry(self) -> core.PlacedGeometry:
        """The geometry of the body in the world, made on demand."""
        geometry = self._geometry
        if geometry is None:
            around = None if self.curved is None else self.bounds
            with _MAKING:
                geometry = self._geometry = self._geometry or core.PlacedGeometry(
                    self.shared.geometry, self.body.transform, around, self.resolution
                )
        return geometry

    @property
    def posed(self) -> core.PosedBody:
        """The body as the core sorts it in many poses, made on demand."""
        posed, shape = self.shared.posed, self.body.shape
        if shape not in posed:
            posed[shape] = _posed(self.body, self.shared.geometry)
        return posed[shape]

    def release(self) -> None:
        """Releases the data in the world; they are made again on demand."""
        self._geometry = self._checked = None

    @property
    def mesh(self) -> core.Mesh:
        return self.geometry.mesh

    def surface(self) -> core.Surface:
        return self.geometry.surface()

    def hull(self) -> core.Polytope:
        return self.geometry.hull()

    def hull_shape(self) -> core.Shape:
        return self.geometry.hull_shape()

    def checked(self) -> Placed:
        """The body as the checker of certificates sees it."""
        checked = self._checked
        if checked is None:
            checked = self._checked = _checked(self.body, self.shared, self.surface_tolerance)
        return checked

    @property
    def convex(self) -> bool:
        return self.shared.geometry.convex

    @property
    def largest_stretch(self) -> float:
        """An upper bound of how much the transform stretches a length, tight for rigid transforms:
        the square of the largest singular value of M is at most the largest row sum of |M^T M|."""
        transform = self.body.transform
        if transform is None:
            return 1.0
        columns = [[transform[4 * row + axis] for row in range(3)] for axis in range(3)]
        rows = [
            math.fsum(abs(math.fsum(p * q for p, q in zip(u, v, strict=True))) for v in columns)
            for u in columns
        ]
        return math.sqrt(max(rows)) * (1 + CHAIN_ROUNDOFFS * UNIT_ROUNDOFF)


def world_bounds(bodies: Sequence[Body], threads: int) -> list[Box | None]:
    """The bounds of all bodies at once, without placing a mesh; None: the body cannot be placed."""
    moved = [(body.file.mesh, body.transform) for body in bodies if body.transform is not None]
    meshes, matrices = [mesh for mesh, _ in moved], [matrix for _, matrix in moved]
    placed = iter(core.placed_bounds(meshes, matrices, threads))
    return [body.file.mesh.bounds if body.transform is None else next(placed) for body in bodies]
