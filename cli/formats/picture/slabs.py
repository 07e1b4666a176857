"""Half spaces in a picture: each is a slab below its plane, as wide as the scene and a little more.

It reaches as deep as the deepest body, so that the whole overlap of a body with it can be seen.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from satcheck.cli.formats.picture.moments import boxes_of, matrix_of
from satcheck.core import Mesh
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Box
from satcheck.scene.bodies import is_half_space

if TYPE_CHECKING:
    import numpy.typing as npt

    from satcheck.scene import Body, Scene

    Floats = npt.NDArray[np.float64]

# Of the width of the scene: the width of a slab, its least thickness, and how far it reaches beyond
# the deepest body.
_WIDE, _THICK, _BEYOND = 1.25, 0.02, 0.01


def with_slabs(scene: Scene) -> Scene:
    """The scene with a slab instead of each half space."""
    others = [body for body in scene.bodies if not is_half_space(body)]
    if len(others) == len(scene.bodies):
        return scene
    boxes = boxes_of(others)
    bodies = (_slab(body, boxes) if is_half_space(body) else body for body in scene.bodies)
    return replace(scene, bodies=tuple(bodies))


def _slab(floor: Body, boxes: Floats) -> Body:
    """boxes: least and greatest corner of each other body."""
    low, high = _around(floor, boxes)
    size = float((high - low).max()) or 1.0
    middle, half = (low + high) / 2, _WIDE * size / 2
    thick = max(_THICK * size, _BEYOND * size - min(float(low[2]), 0.0))
    cube = mesh_of(Box((2 * half, 2 * half, 2 * thick)))
    corners = np.minimum(np.asarray(cube.vertices), [np.inf, np.inf, 0.0])
    corners[:, :2] += middle[:2]
    return replace(floor, file=replace(floor.file, mesh=Mesh(corners, cube.triangles)))


def _around(floor: Body, boxes: Floats) -> tuple[Floats, Floats]:
    """The box around all other bodies, in the frame of the half space."""
    if not len(boxes):
        return np.full(3, -0.5), np.full(3, 0.5)
    corners = np.array(
        [[box[i, 0], box[j, 1], box[k, 2]] for box in boxes for i, j, k in np.ndindex(2, 2, 2)]
    )
    matrix = matrix_of(floor)
    inner = np.linalg.solve(matrix[:3, :3], (corners - matrix[:3, 3]).T).T
    return inner.min(axis=0), inner.max(axis=0)
