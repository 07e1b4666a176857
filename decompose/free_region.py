"""Finds a large convex region inside a convex part that the mesh's surface does not enter.

Robin Deits, Russ Tedrake, "Computing Large Convex Regions of Obstacle-Free Space Through
Semidefinite Programming" (2015): grow an ellipsoid about a seed until it meets an obstacle. Cut
along the tangent plane there, and continue with the remaining obstacles. Then take an ellipsoid of
the shape of the region and repeat. Where we deviate: the ellipsoid comes from the covariance of the
region's vertices and is not the largest one. A good guess is enough, because the exact mesh
relation proves or rejects the region afterwards.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from satcheck.core import Mesh, Polytope, Surface
from satcheck.decompose.errors import NEVER, Deadline
from satcheck.decompose.half_spaces import (
    NOISE,
    HalfSpaces,
    around,
    points_as_mesh,
    vertices_of,
)
from satcheck.decompose.obstacles import nearest_points, surface_inside

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_SEEDS: Final = 64  # points of the part that are tried as first centre
_PAIRS_AT_ONCE: Final = 1 << 15  # pairs of seed and triangle; limits the memory to about 20 MiB
_ROUNDS: Final = 3
_WORTHWHILE_GAIN: Final = 1.02  # in volume, for one more round
_FLATTEST: Final = 1e-9  # least over largest variance of an ellipsoid


def free_region(part: Polytope, solid: Surface, deadline: Deadline = NEVER) -> Polytope:
    """A convex region in the part, inside the solid mesh up to rounding; if there is none, the
    part.

    Deterministic. Nothing is proven here. Raises DecompositionError at the deadline.
    """
    corners = np.asarray(part.vertices)
    body = around(corners, np.asarray(part.triangles))
    obstacles = surface_inside(_triangles_near(solid.mesh, corners), body, deadline)
    if len(obstacles) == 0:
        return part
    shape = _ellipsoid(corners)
    seed = _deepest_seed(corners, body, obstacles, shape, solid, deadline)
    best, best_volume = part, 0.0
    for _ in range(_ROUNDS):
        deadline.check()
        if seed is None:
            break
        region = _grown(body, obstacles, seed, shape)
        if region is None:
            break
        volume = region.to_mesh().topology().volume
        if volume <= best_volume * _WORTHWHILE_GAIN:
            break
        best, best_volume = region, volume
        vertices = np.asarray(region.vertices)
        seed, shape = vertices.mean(axis=0), _ellipsoid(vertices)
    return best


def _triangles_near(mesh: Mesh, corners: Floats) -> Floats:
    """Triangles (m, 3, 3) of the mesh that meet the bounding box of the corners."""
    triangles = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    near = (triangles.max(axis=1) >= corners.min(axis=0)).all(axis=1)
    near &= (triangles.min(axis=1) <= corners.max(axis=0)).all(axis=1)
    chosen: Floats = triangles[near]
    return chosen


def _ellipsoid(points: Floats) -> Floats:
    """Matrix (3, 3) that maps the covariance of the points to that of a unit ball."""
    variances, axes = np.linalg.eigh(np.cov(points.T))
    scale = 1.0 / np.sqrt(np.maximum(variances, _FLATTEST * variances.max()))
    matrix: Floats = scale[:, None] * axes.T
    return matrix


def _deepest_seed(
    corners: Floats,
    body: HalfSpaces,
    obstacles: Floats,
    shape: Floats,
    solid: Surface,
    deadline: Deadline,
) -> Floats | None:
    """Among the tried points inside the mesh, the one (3,) with the largest free ellipsoid."""
    random = np.random.default_rng(0)
    shares = random.dirichlet(np.full(len(corners), 0.5), _SEEDS)
    seeds = np.concatenate([corners.mean(axis=0)[None], shares @ corners])
    reach = np.linalg.norm(body.normals @ np.linalg.inv(shape), axis=1)
    to_boundary = (body.slack(seeds) / reach).min(axis=1)
    to_surface = _distances(seeds @ shape.T, obstacles @ shape.T, deadline)
    for index in np.argsort(-np.minimum(to_boundary, to_surface), kind="stable"):
        x, y, z = (float(coordinate) for coordinate in seeds[index])
        winding = solid.winding_number((x, y, z))
        if winding is not None and winding > 0:
            seed: Floats = seeds[index]
            return seed
    return None


def _distances(points: Floats, triangles: Floats, deadline: Deadline) -> Floats:
    """The distance from each point (n, 3) to the nearest triangle of (m, 3, 3)."""
    at_once = max(1, _PAIRS_AT_ONCE // len(triangles))
    distances = []
    for first in range(0, len(points), at_once):
        deadline.check()
        chunk = points[first : first + at_once]
        moved = (triangles - chunk[:, None, None]).reshape(-1, 3, 3)
        nearest = np.linalg.norm(nearest_points(moved), axis=1).reshape(len(chunk), -1)
        distances.append(nearest.min(axis=1))
    return np.concatenate(distances)


def _grown(body: HalfSpaces, obstacles: Floats, seed: Floats, shape: Floats) -> Polytope | None:
    """The body, cut by a plane between the seed and each obstacle that remains after earlier
    cuts."""
    local = (obstacles - seed) @ shape.T
    nearest = nearest_points(local)
    distance = np.linalg.norm(nearest, axis=1)
    if distance.min() <= NOISE:
        return None
    left = np.arange(len(local))
    normals, offsets = [], []
    while len(left):
        first = left[np.argmin(distance[left])]
        normal = nearest[first] / distance[first]
        left = left[(local[left] @ normal).min(axis=1) < distance[first] * (1.0 - NOISE)]
        world = shape.T @ normal
        length = np.linalg.norm(world)
        normals.append(world / length)
        offsets.append((distance[first] + world @ seed) / length)
    vertices = vertices_of(body.cut(np.array(normals), np.array(offsets)), seed)
    if len(vertices) < 4:
        return None
    region = points_as_mesh(vertices).convex_hull()
    return region if region.dimension == 3 else None
