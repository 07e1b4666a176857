"""Meshes and other arrays as short text: bytes of one weight stand together, deflated, in base64.

Neighbours in a mesh have similar numbers, so their differences deflate better. The page undoes all
that in `meshes.js`.
"""

from __future__ import annotations

import base64
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np

from satcheck.core import Mesh

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[Any]

STEPS = 65535  # of a coordinate, from one side of the box of its mesh to the other


def packed(values: Array) -> str:
    """Of any shape; little-endian, and row by row."""
    flat = np.ascontiguousarray(values).astype(values.dtype.newbyteorder("<")).reshape(-1)
    planes = flat.view(np.uint8).reshape(-1, flat.itemsize).T
    return base64.b64encode(zlib.compress(planes.tobytes(), 9)).decode()


def packed_text(text: str) -> str:
    return packed(np.frombuffer(text.encode(), np.uint8))


def packed_points(points: Array, box: Array) -> str:
    """(n, 3) points within a box, (2, 3): as uint16, in columns, as differences."""
    low, size = box[0], box[1] - box[0]
    steps = np.rint((points - low) / np.where(size > 0.0, size, 1.0) * STEPS).astype(np.uint16)
    return packed(differences(steps.T.reshape(-1)))


def differences(values: Array) -> Array:
    """Of unsigned integers, each to the one before, modulo their range."""
    return np.diff(values, prepend=values.dtype.type(0))


def packed_mesh(mesh: Mesh) -> dict[str, str]:
    """corners: within the box of the mesh. triangles: uint32, as differences."""
    return {
        "corners": packed_points(np.asarray(mesh.vertices), np.array(mesh.bounds)),
        "triangles": packed(differences(np.asarray(mesh.triangles).reshape(-1))),
    }


def frame_of(mesh: Mesh) -> npt.NDArray[np.float64]:
    """4 x 4: from the box of the mesh, whose sides are 1, into its coordinates."""
    low, high = np.array(mesh.bounds)
    matrix: npt.NDArray[np.float64] = np.diag([*(high - low), 1.0])
    matrix[:3, 3] = low
    return matrix


def simplified(mesh: Mesh, cells: int) -> Mesh:
    """Return a coarser mesh, for a body that only surrounds what collides. cells: along the longest
    side of its box. No vertex moves farther than across a cell. A mesh that would lose all
    triangles stays as it is.

    J. Rossignac and P. Borrel, Multi-resolution 3D approximations for rendering complex scenes,
    1993: the vertices in a cell of a grid become one. Here that is their mean, and the grid is one
    of cubes.
    """
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    cell_of, count = _cells(vertices, cells)
    corners = _without_repeats(cell_of[triangles])
    if count >= mesh.vertex_count or not len(corners):
        return mesh
    totals = np.bincount(cell_of, minlength=count)
    means = [np.bincount(cell_of, vertices[:, k], count) / totals for k in range(3)]
    used, renumbered = np.unique(corners, return_inverse=True)
    points = np.stack(means, axis=1)[used]
    return Mesh(points, renumbered.reshape(-1, 3).astype(np.uint32))


def _cells(vertices: npt.NDArray[np.float64], cells: int) -> tuple[npt.NDArray[np.int64], int]:
    """The cell of each vertex, numbered without gaps, and how many there are."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    places = ((vertices - low) / (high - low).max() * cells).astype(np.int64)
    key = (places[:, 0] * (cells + 1) + places[:, 1]) * (cells + 1) + places[:, 2]
    distinct, number = np.unique(key, return_inverse=True)
    return number.reshape(-1), len(distinct)


def _without_repeats(corners: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Triangles of three different vertices, each once."""
    a, b, c = corners.T
    whole = corners[(a != b) & (b != c) & (c != a)]
    _, first = np.unique(np.sort(whole, axis=1), axis=0, return_index=True)
    kept: npt.NDArray[np.int64] = whole[np.sort(first)]
    return kept
