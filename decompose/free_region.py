"""Finds a large convex region inside a convex part that the mesh's surface does not enter.

Each round grows the region of `core.inner_region` from the middle of the one before, and with its
proportions. A good guess is enough, because the exact mesh relation proves or rejects the region
afterwards.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from satcheck.core import Polytope, Surface, inner_region
from satcheck.decompose.errors import NEVER, Deadline

if TYPE_CHECKING:
    Point = tuple[float, float, float]

_SEEDS: Final = 64  # points of the part that are tried as first middle
_ROUNDS: Final = 3
_WORTHWHILE_GAIN: Final = 1.02  # in volume, for one more round


def free_region(part: Polytope, solid: Surface, deadline: Deadline = NEVER) -> Polytope | None:
    """Return a convex region in the part, inside the solid mesh up to rounding; None: none is
    found.

    Deterministic. Nothing is proven here. Raises DecompositionError at the deadline.
    """
    best, best_volume = None, 0.0
    like, seed = part, _deepest_seed(part, solid)
    for _ in range(_ROUNDS):
        deadline.check()
        region = None if seed is None else inner_region(solid, seed, part, like)
        volume = 0.0 if region is None else region.to_mesh().topology().volume
        if region is None or volume <= best_volume * _WORTHWHILE_GAIN:
            break
        best, best_volume, like = region, volume, region
        seed = tuple(np.asarray(region.vertices).mean(axis=0).tolist())
    return best


def _deepest_seed(part: Polytope, solid: Surface) -> Point | None:
    """Return the one of the tried points that is inside both, the farthest from their surfaces."""
    corners = np.asarray(part.vertices)
    shares = np.random.default_rng(0).dirichlet(np.full(len(corners), 0.5), _SEEDS)
    tried = np.concatenate([corners.mean(axis=0)[None], shares @ corners]).tolist()
    around = Surface(part.to_mesh(), True)
    depths = {}
    for x, y, z in tried:
        point = x, y, z
        if (solid.winding_number(point) or 0) > 0:
            depths[point] = min(each.nearest(point)[0] for each in (solid, around))
    return max(depths, key=depths.__getitem__, default=None)
