"""Coarser meshes, for bodies that only surround what collides.

J. Rossignac and P. Borrel, Multi-resolution 3D approximations for rendering complex scenes, 1993:
the vertices in a cell of a grid become one. Here that is their mean, and the grid is one of cubes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from satcheck.core import Mesh

if TYPE_CHECKING:
    import numpy.typing as npt


def simplified(mesh: Mesh, cells: int) -> Mesh:
    """cells: along the longest side of its box. No vertex moves farther than across a cell. A mesh
    that would lose all triangles stays as it is."""
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
