"""A body in the world, with everything that can be derived from it built once, when asked for."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING, Generic, TypeVar

from satcheck import core
from satcheck.audit.boxes import Box
from satcheck.audit.settings import Settings
from satcheck.audit.tolerances import CHAIN_ROUNDOFFS, UNIT_ROUNDOFF

if TYPE_CHECKING:
    from satcheck.audit.curved.shape import CurvedShape
    from satcheck.decompose import Decomposition, DecompositionError
    from satcheck.scene import Body, MeshFile
    from satcheck.verify.bodies import Placed, Shape

T = TypeVar("T")
MeshKey = tuple[str, str, str | None]


class Once(Generic[T]):
    """A value made by the first thread that asks; `known` is None until then."""

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


def mesh_key(file: MeshFile) -> MeshKey:
    """The same for the same mesh. Not the sha256 alone: files of the same bytes can refer to
    neighbours that differ."""
    return file.path, file.sha256, file.part


class SharedMesh:
    """What all bodies made of one mesh share, in file coordinates.

    convex(): closed, consistently outward, and exactly convex. An affine map keeps that, up to the
    one rounding of each world coordinate: the body is then taken as the hull of its world vertices.
    covers_once(): a solid that covers no point twice, so that its volume is that of its mesh.
    """

    __slots__ = ("convex", "covers_once", "decomposition", "file", "shape")

    def __init__(self, file: MeshFile, settings: Settings) -> None:
        self.file = file
        self.convex = Once(self._convex)
        self.covers_once = Once(lambda: core.covers_once(core.Surface(file.mesh, True)))
        self.decomposition = Once(lambda: self._decomposition(settings))
        self.shape = Once(self._shape)

    def _convex(self) -> bool:
        return self.file.health.solid and self.file.mesh.convexity_defect(0.0) == 0.0

    def _shape(self) -> Shape:
        """As the checker of certificates sees it."""
        from satcheck.verify.bodies import shape_of

        return shape_of(self.file)

    def _decomposition(self, settings: Settings) -> Decomposition | DecompositionError:
        """A failure is an answer too: it is not tried again for the next pair."""
        from satcheck.decompose import Cache, DecompositionError, decompose

        directory = settings.cache_directory
        cache = Cache(None if directory is None else Path(directory)) if settings.cache else None
        try:
            return decompose(
                self.file.mesh,
                threshold=settings.part_threshold,
                seed=settings.part_seed,
                seconds=settings.part_seconds,
                megabytes=settings.part_megabytes,
                cache=cache,
            )
        except DecompositionError as error:
            return error


def _curved(body: Body) -> CurvedShape | None:
    """ValueError when the transform makes no such shape of it."""
    if body.shape is None:
        return None
    from satcheck.scene.primitives import is_curved

    if not is_curved(body.shape):
        return None
    from satcheck.audit.curved.shape import curved_shape

    return curved_shape(body.shape, body.transform)


class PlacedBody:
    """World frame. bounds: ((x, y, z), (x, y, z)); resolution: the input precision, world units.

    curved: the shape, where the body is one; its mesh is then only within it, its bounds around it.
    """

    __slots__ = (
        "body",
        "bounds",
        "checked",
        "curved",
        "hull",
        "hull_shape",
        "id",
        "mesh",
        "resolution",
        "shared",
        "solid",
        "surface",
    )

    def __init__(self, body: Body, shared: SharedMesh) -> None:
        self.body = body
        self.shared = shared
        self.id = body.id
        self.mesh: core.Mesh = body.world_mesh()
        self.bounds: Box = self.mesh.bounds
        self.curved = _curved(body)
        if self.curved is not None:
            self.bounds = self.curved.bounds()
        self.resolution = body.resolution_world
        self.solid = body.file.health.solid
        self.surface = Once(lambda: core.Surface(self.mesh, self.solid))
        self.hull = Once(lambda: self.mesh.convex_hull())
        self.hull_shape = Once(lambda: core.Hull(self.hull()))
        self.checked = Once(self._checked)

    def _checked(self) -> Placed:
        from satcheck.verify.bodies import place_shape

        return place_shape(self.id, self.body.groups, self.shared.shape(), self.body.transform)

    @property
    def convex(self) -> bool:
        return self.shared.convex()

    @property
    def largest_stretch(self) -> float:
        """An upper bound of how much longer the transform makes a length, tight for rigid ones:
        the largest singular value of M squared is at most the largest row sum of |M^T M|."""
        transform = self.body.transform
        if transform is None:
            return 1.0
        columns = [[transform[4 * row + axis] for row in range(3)] for axis in range(3)]
        rows = [
            math.fsum(
                abs(math.fsum(p * q for p, q in zip(one, other, strict=True))) for other in columns
            )
            for one in columns
        ]
        return math.sqrt(max(rows)) * (1 + CHAIN_ROUNDOFFS * UNIT_ROUNDOFF)
