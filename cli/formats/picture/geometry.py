"""The geometry of a page: meshes, each once, and the bodies that use them.

Geometry is for the eye only: 16 bits for a coordinate within the box of its mesh. Bodies with
findings are whole. The others become coarser until the geometry fits, and boxes at last.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from satcheck.cli.formats.picture.packing import frame_of, packed, packed_mesh, simplified
from satcheck.core import Mesh
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Box
from satcheck.scene.bodies import IDENTITY

if TYPE_CHECKING:
    import numpy.typing as npt

    from satcheck.core import Polytope
    from satcheck.scene.bodies import Body

    Floats = npt.NDArray[np.float64]

# Convex parts of bodies, in coordinates of their meshes.
Parts = Mapping[str, Sequence["Polytope"]]
GRIDS = (128, 64, 32, 16, 8)  # cells along the longest side of a mesh
AS_BOXES = "boxes"


class Drawn(NamedTuple):
    """The number of a packed mesh, and its frame: 4 x 4, from the box of the mesh, whose sides are
    1, into coordinates of the file."""

    mesh: int
    frame: Floats


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
    boxes = np.array([body.world_mesh().bounds for body in bodies]).reshape(-1, 2, 3)
    middle: Floats = np.zeros(3)
    if len(bodies):
        middle = (boxes[:, 0].min(axis=0) + boxes[:, 1].max(axis=0)) / 2
    meshes = _Meshes()
    whole = {k: meshes.add(b.file.mesh) for k, b in enumerate(bodies) if b.id in met}
    hulls = {k: hull for k in whole if (hull := meshes.hull(bodies[k].file.mesh)) is not None}
    split = {
        k: _parts(meshes, parts[bodies[k].id], bodies[k].file.mesh)
        for k in whole
        if bodies[k].id in parts
    }
    others = {k: body.file.mesh for k, body in enumerate(bodies) if k not in whole}
    coarser, words = meshes.add_coarser(others, room)
    drawn = whole | coarser
    frames = [
        _rows(drawn[k].frame, body.transform, middle) if k in drawn else _box_rows(boxes[k], middle)
        for k, body in enumerate(bodies)
    ]
    values = {
        "bodies": {
            "ids": [body.id for body in bodies],
            "meshes": [drawn[k].mesh if k in drawn else meshes.box() for k in range(len(bodies))],
            "frames": packed(np.array(frames, dtype=np.float32)),
            "boxes": packed((boxes - middle).astype(np.float32)),
        },
        "hulls": {k: hull.mesh for k, hull in hulls.items()},
        "parts": split,
        "moved": {
            k: _moved(drawn[k].frame if k in drawn else None, body, placed[body.id], middle)
            for k, body in enumerate(bodies)
            if body.id in placed
        },
        "meshes": meshes.packed,
    }
    return Geometry(values, middle, words)


def cube() -> Mesh:
    """From 0 to 1."""
    centred = mesh_of(Box((1.0, 1.0, 1.0)))
    return Mesh(np.asarray(centred.vertices) + 0.5, centred.triangles)


def joined(meshes: Iterable[Mesh]) -> Mesh:
    """All as one."""
    listed = list(meshes)
    firsts = np.cumsum([0, *(mesh.vertex_count for mesh in listed)])
    corners = [np.asarray(m.triangles) + first for m, first in zip(listed, firsts, strict=False)]
    points = [np.asarray(mesh.vertices) for mesh in listed]
    return Mesh(np.concatenate(points), np.concatenate(corners).astype(np.uint32))


class _Meshes:
    """Packed, each once. add: returns the number and the frame of a mesh. hull: the same of its
    hull, whose box is that of the mesh; None where it has no volume."""

    def __init__(self) -> None:
        self.packed: list[dict[str, str]] = []
        self._by_text: dict[tuple[str, ...], int] = {}
        self.add, self.hull = cache(self._add), cache(self._hull)

    def _add(self, mesh: Mesh) -> Drawn:
        return Drawn(self._number(packed_mesh(mesh)), frame_of(mesh))

    def _hull(self, mesh: Mesh) -> Drawn | None:
        hull = mesh.convex_hull()
        return self._add(hull.to_mesh()) if hull.dimension == 3 else None

    def box(self) -> int:
        return self._number(packed_mesh(cube()))

    def add_coarser(self, meshes: Mapping[int, Mesh], room: int) -> tuple[dict[int, Drawn], str]:
        """Nothing for what becomes a box; and in words what became of all."""
        distinct = {id(mesh): mesh for mesh in meshes.values()}
        room -= sum(len(text) for texts in self._by_text for text in texts)
        for grid in (None, *GRIDS):
            fitting = _fitting(distinct, grid, room)
            if fitting is not None:
                added = {key: Drawn(self._number(m), frame) for key, (m, frame) in fitting.items()}
                words = "" if grid is None else f"cells of 1/{grid} of their size"
                return {k: added[id(mesh)] for k, mesh in meshes.items()}, words
        return {}, AS_BOXES

    def _number(self, content: dict[str, str]) -> int:
        number = self._by_text.setdefault(tuple(content.values()), len(self.packed))
        self.packed += [content] * (number == len(self.packed))
        return number


def _fitting(
    meshes: Mapping[int, Mesh], grid: int | None, room: int
) -> dict[int, tuple[dict[str, str], Floats]] | None:
    """None: there is not so much room."""
    result = {}
    for key, mesh in meshes.items():
        drawn = mesh if grid is None else simplified(mesh, grid)
        content = packed_mesh(drawn)
        room -= sum(map(len, content.values()))
        if room < 0:
            return None
        result[key] = content, frame_of(drawn)
    return result


def _parts(meshes: _Meshes, parts: Sequence[Polytope], mesh: Mesh) -> dict[str, Any]:
    """scale, offset: from the box of the parts into that of the mesh of the body."""
    solids = [part.to_mesh() for part in parts]
    drawn = meshes.add(joined(solids))
    low, high = np.array(mesh.bounds)
    size = np.where(high > low, high - low, 1.0)
    return {
        "mesh": drawn.mesh,
        "scale": (np.diag(drawn.frame)[:3] / size).tolist(),
        "offset": ((drawn.frame[:3, 3] - low) / size).tolist(),
        "triangles": [solid.triangle_count for solid in solids],
    }


def _moved(frame: Floats | None, body: Body, placed: Floats, middle: Floats) -> str:
    mesh = body.file.mesh
    frame = frame_of(mesh) if frame is None else frame
    numbers = []
    for matrix in placed:
        world = np.asarray(mesh.vertices) @ matrix[:3, :3].T + (matrix[:3, 3] - middle)
        rows = _rows(frame, tuple(matrix.reshape(-1).tolist()), middle)
        numbers.append([*rows, *world.min(axis=0), *world.max(axis=0)])
    return packed(np.array(numbers, dtype=np.float32))


def _rows(frame: Floats, transform: Sequence[float] | None, middle: Floats) -> Floats:
    """12 numbers."""
    matrix = np.array(transform or IDENTITY).reshape(4, 4) @ frame
    matrix[:3, 3] -= middle
    rows: Floats = matrix[:3].reshape(-1)
    return rows


def _box_rows(corners: Floats, middle: Floats) -> Floats:
    frame: Floats = np.diag([*(corners[1] - corners[0]), 1.0])
    frame[:3, 3] = corners[0]
    return _rows(frame, None, middle)
