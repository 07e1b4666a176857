"""Whether two joined walls can meet in a corner only."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from satcheck.plugins.ifc.kernel import Shape

# Of the smaller box: less than what a wall shares with its duplicate.
_MOST_SHARED = 0.5


def meet_in_a_corner(a: Shape, b: Shape) -> bool:
    """Whether the boxes of two bodies, each along the axes of its element, share at most half of
    the smaller box. The bodies lie in their boxes, so they share no more."""
    turn = np.linalg.inv(_matrix(a)) @ _matrix(b)
    one, other = _box(a), _box(b).transform(turn[:3])
    return bool((one ^ other).volume() <= _MOST_SHARED * min(one.volume(), other.volume()))


def _box(shape: Shape) -> Any:
    from manifold3d import Manifold

    points = np.frombuffer(shape.vertices, "<f8").reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    return Manifold.cube(high - low).translate(low)


def _matrix(shape: Shape) -> NDArray[np.float64]:
    return np.eye(4) if shape.matrix is None else np.array(shape.matrix).reshape(4, 4)
