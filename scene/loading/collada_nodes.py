"""The nodes of a COLLADA scene, as pycollada gives them, with their matrices."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
IDENTITY = np.eye(4)


def walk(roots: Sequence[tuple[Any, Floats]]) -> Iterator[tuple[Any, Floats]]:
    """The roots and all below them, depth first, each with the matrix from its parent to the world.
    The own matrix of a node comes on top, see `world_of`."""
    stack = list(reversed(roots))
    while stack:
        node, matrix = stack.pop()
        yield node, matrix
        children = getattr(node, "children", None)
        if children:
            below = world_of(node, matrix)
            stack.extend((child, below) for child in reversed(children))


def world_of(node: Any, matrix: Floats) -> Floats:
    """From the coordinates of a node to the world. matrix: that of its parent."""
    return matrix @ np.asarray(node.matrix, dtype=np.float64)


def placed(points: Floats, matrix: Floats) -> Floats:
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def mirrors(matrix: Floats) -> bool:
    return bool(np.linalg.det(matrix[:3, :3]) < 0)
