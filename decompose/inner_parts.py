"""Finds convex bodies proven to lie inside a solid mesh, one for each of its convex parts.

A convex part may be slightly larger than the mesh. The first candidate is the part itself. The
second is a region of the part that the surface does not enter (up to rounding). A candidate is
scaled about its centre until it is strictly inside. If a factor fits, every smaller factor fits.
The exact mesh relation of the scaled copy with rounded vertices decides.

The region grows in rounds, by `core.inner_region`, each from the middle of the one before and with
its proportions.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from satcheck.core import Mesh, Polytope, Surface, inner_region, mesh_relation
from satcheck.decompose.errors import NEVER, Deadline

Point = tuple[float, float, float]

# Tried in this order. The factors are for contact from inside, rounding far from the origin,
# shallow dents, and deep dents.
_FACTORS: Final = (1.0 - 1e-6, 1.0 - 1e-4, 0.999, 0.99, 0.97, 0.9, 0.8, 0.6, 0.4, 0.2)
_NEGLIGIBLE_VOLUME: Final = 1e-6  # of the largest part; smaller parts do not affect a depth
_SEEDS: Final = 64  # points of the part that are tried as first middle
_ROUNDS: Final = 3
_WORTHWHILE_GAIN: Final = 1.02  # in volume, for one more round


def inner_parts(
    parts: Sequence[Polytope], solid: Surface, deadline: Deadline = NEVER
) -> tuple[Polytope | None, ...]:
    """For each part a shrunken copy strictly inside the solid mesh; None: not found. Raises
    DecompositionError at the deadline."""
    volumes = [part.to_mesh().topology().volume for part in parts]
    negligible = _NEGLIGIBLE_VOLUME * max(volumes)
    return tuple(
        _inner_part(part, solid, deadline) if volume > negligible else None
        for part, volume in zip(parts, volumes, strict=True)
    )


def _inner_part(part: Polytope, solid: Surface, deadline: Deadline) -> Polytope | None:
    """The larger of two candidates: the shrunken part, which is better for many shallow dents, and
    the shrunken free region, which is better for few deep dents."""
    deadline.check()
    bodies = [_largest_inside(part.to_mesh(), solid)]
    region = free_region(part, solid, deadline)
    if region is not None:
        bodies.append(_largest_inside(region.to_mesh(), solid))
    inside = [body for body in bodies if body is not None]
    return max(inside, key=lambda body: body.to_mesh().topology().volume, default=None)


def _largest_inside(region: Mesh, solid: Surface) -> Polytope | None:
    centre = _vertex_mean(region)
    copies = (_scaled(region, centre, factor) for factor in _FACTORS)
    return next((copy for copy in copies if is_inside(copy, solid)), None)


def is_inside(copy: Polytope, solid: Surface) -> bool:
    """Return whether the body is proven to lie strictly inside the solid mesh."""
    if copy.dimension < 3:
        return False
    relation = mesh_relation(solid, Surface(copy.to_mesh(), True))
    return relation.relation == "contains" and relation.proven


def _scaled(region: Mesh, centre: Point, factor: float) -> Polytope:
    """The scaled copy. Its vertices are rounded, so it is rebuilt as their exact hull."""
    x, y, z = ((1.0 - factor) * coordinate for coordinate in centre)
    matrix = (factor, 0.0, 0.0, x, 0.0, factor, 0.0, y, 0.0, 0.0, factor, z, 0.0, 0.0, 0.0, 1.0)
    return region.transformed(matrix).convex_hull()


def _vertex_mean(body: Mesh | Polytope) -> Point:
    x, y, z = np.asarray(body.vertices).mean(axis=0).tolist()
    return x, y, z


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
        seed = _vertex_mean(region)
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
