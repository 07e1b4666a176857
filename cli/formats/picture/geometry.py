"""The geometry of a page: meshes, each once, and the bodies that use them.

Geometry is for the eye only: 16 bits for a coordinate within the box of its mesh. Bodies with
findings are whole. The others become coarser until the geometry fits, and boxes at last.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from satcheck.cli.formats.picture.moments import boxes_of, matrix_of
from satcheck.cli.formats.picture.packing import frame_of, packed, packed_mesh, simplified
from satcheck.core import Mesh
from satcheck.core.mesh_arrays import joined
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Box, Cone, Cylinder, Primitive, Sphere

if TYPE_CHECKING:
    import numpy.typing as npt

    from satcheck.core import Polytope
    from satcheck.scene.bodies import Body

    Floats = npt.NDArray[np.float64]

# Convex parts of bodies, in coordinates of their meshes.
Parts = Mapping[str, Sequence["Polytope"]]
GRIDS = (128, 64, 32, 16, 8)  # cells along the longest side of a mesh
AS_BOXES = "boxes"
# What the page draws beside the bodies: balls, rods and arrows, and boxes instead of bodies.
SOLIDS: Mapping[str, Primitive] = {
    "sphere": Sphere(1.0),
    "rod": Cylinder(1.0, 1.0),
    "cone": Cone(1.0, 1.0),
    "cube": Box((1.0, 1.0, 1.0)),
}
SEGMENTS = 24


class Geometry(NamedTuple):
    """values: as the page reads them. middle: of the scene, the origin of the page. simplified:
    what bodies without findings are drawn as; empty: they are whole."""

    values: dict[str, Any]
    middle: Floats
    simplified: str


def geometry(
    bodies: Sequence[Body],
    met: frozenset[str],
    parts: Parts,
    room: int,
    placed: Mapping[str, Floats] = {},
) -> Geometry:
    """met: ids of the bodies with findings. room: characters for all meshes. placed: body -> its
    placement at each moment, of the bodies that move.

    frames: float32, for each body the rows of the 3 x 4 matrix from the box of its mesh, whose
    sides are 1, into the page. boxes: float32, least and greatest corner of each. hulls: body ->
    mesh, with the frame of the body. parts: body -> one mesh of all, and the triangles of each.
    moved: float32, body -> at each moment what `frames` and `boxes` have of it, 18 numbers.
    """
    boxes, middle = boxes_of(bodies), np.zeros(3)
    if len(bodies):
        middle = (boxes[:, 0].min(axis=0) + boxes[:, 1].max(axis=0)) / 2
    meshes = _Meshes()
    drawn = {k: body.file.mesh for k, body in enumerate(bodies) if body.id in met}
    for mesh in drawn.values():  # the others take the room that they leave
        meshes.number(mesh)
    hulls = {
        k: meshes.number(hull)
        for k, mesh in drawn.items()
        if (hull := meshes.hull(mesh)) is not None
    }
    split = {
        k: _parts(meshes, parts[bodies[k].id], mesh)
        for k, mesh in drawn.items()
        if bodies[k].id in parts
    }
    others = {k: body.file.mesh for k, body in enumerate(bodies) if k not in drawn}
    coarser, words = meshes.coarser(others.values(), room)
    drawn |= {k: coarser[mesh] for k, mesh in others.items()}
    frames = [frame_of(drawn[k]) for k in range(len(bodies))]
    placements = map(matrix_of, bodies)
    rows = [_rows(*each, middle) for each in zip(placements, frames, strict=True)]
    values = {
        "bodies": {
            "ids": [body.id for body in bodies],
            "meshes": [meshes.number(drawn[k]) for k in range(len(bodies))],
            "frames": packed(np.array(rows, dtype=np.float32)),
            "boxes": packed((boxes - middle).astype(np.float32)),
        },
        "solids": {name: packed_mesh(mesh_of(own, SEGMENTS)) for name, own in SOLIDS.items()},
        "hulls": hulls,
        "parts": split,
        "moved": {
            k: _moved(frames[k], body.file.mesh, placed[body.id], middle)
            for k, body in enumerate(bodies)
            if body.id in placed
        },
        "meshes": meshes.packed,
    }
    return Geometry(values, middle, words)


def _box(mesh: Mesh) -> Mesh:
    """The box of a mesh, in its coordinates."""
    low, high = np.array(mesh.bounds)
    centred = mesh_of(Box((1.0, 1.0, 1.0)))
    return Mesh(low + (np.asarray(centred.vertices) + 0.5) * (high - low), centred.triangles)


class _Meshes:
    """Packed, each once."""

    def __init__(self) -> None:
        self.packed: list[dict[str, str]] = []
        self._numbers: dict[tuple[str, ...], int] = {}
        self._texts, self.hull = cache(packed_mesh), cache(_hull)

    def number(self, mesh: Mesh) -> int:
        content = self._texts(mesh)
        number = self._numbers.setdefault(tuple(content.values()), len(self.packed))
        self.packed += [content] * (number == len(self.packed))
        return number

    def coarser(self, meshes: Iterable[Mesh], room: int) -> tuple[dict[Mesh, Mesh], str]:
        """Return what is drawn of each mesh so that all fit; and in words what became of them."""
        distinct = list(dict.fromkeys(meshes))
        room -= sum(map(_length, self.packed))
        for grid in (None, *GRIDS):
            fitting = self._fitting(distinct, grid, room)
            if fitting is not None:
                return fitting, "" if grid is None else f"cells of 1/{grid} of their size"
        return {mesh: _box(mesh) for mesh in distinct}, AS_BOXES

    def _fitting(
        self, meshes: Iterable[Mesh], grid: int | None, room: int
    ) -> dict[Mesh, Mesh] | None:
        """None: there is not so much room."""
        drawn = {}
        for mesh in meshes:
            drawn[mesh] = mesh if grid is None else simplified(mesh, grid)
            room -= _length(self._texts(drawn[mesh]))
            if room < 0:
                return None
        return drawn


def _hull(mesh: Mesh) -> Mesh | None:
    """Its box is that of the mesh. None: it has no volume."""
    hull = mesh.convex_hull()
    return hull.to_mesh() if hull.dimension == 3 else None


def _length(content: Mapping[str, str]) -> int:
    return sum(map(len, content.values()))


def _parts(meshes: _Meshes, parts: Sequence[Polytope], mesh: Mesh) -> dict[str, Any]:
    """scale, offset: from the box of the parts into that of the mesh of the body."""
    solids = [part.to_mesh() for part in parts]
    whole = joined(solids)
    frame = frame_of(whole)
    low, high = np.array(mesh.bounds)
    size = np.where(high > low, high - low, 1.0)
    return {
        "mesh": meshes.number(whole),
        "scale": (np.diag(frame)[:3] / size).tolist(),
        "offset": ((frame[:3, 3] - low) / size).tolist(),
        "triangles": [solid.triangle_count for solid in solids],
    }


def _moved(frame: Floats, mesh: Mesh, placed: Floats, middle: Floats) -> str:
    numbers = []
    for matrix in placed:
        world = np.asarray(mesh.vertices) @ matrix[:3, :3].T + (matrix[:3, 3] - middle)
        rows = _rows(matrix, frame, middle)
        numbers.append([*rows, *world.min(axis=0), *world.max(axis=0)])
    return packed(np.array(numbers, dtype=np.float32))


def _rows(placement: Floats, frame: Floats, middle: Floats) -> Floats:
    """12 numbers."""
    matrix = placement @ frame
    matrix[:3, 3] -= middle
    rows: Floats = matrix[:3].reshape(-1)
    return rows
