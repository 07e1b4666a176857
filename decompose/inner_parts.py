"""Convex bodies that are proven to lie inside a solid mesh, one for each of its convex parts.

A part sticks out of the mesh a little. Scaled about a point inside both, it fits at some factor,
and then at every smaller one, so bisection finds the largest. Only the exact mesh relation of the
scaled copy, vertices rounded, decides: a copy is kept when it is strictly contained.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Final

from satcheck.core import Mesh, Polytope, Surface, mesh_relation

_FIRST_SHRINK: Final = 1e-6  # a part that touches the mesh from inside fits after this
_SMALLEST_FACTOR: Final = 1.0 / 16.0  # below it an inner part says next to nothing
_BISECTIONS: Final = 6  # the factor is then within 1/64 of the largest one
_NEGLIGIBLE_VOLUME: Final = 1e-6  # of the largest part: too small to matter for any depth


def inner_parts(parts: Sequence[Polytope], solid: Surface) -> tuple[Polytope | None, ...]:
    """For each part a shrunken copy strictly inside the solid mesh, None where none was found."""
    meshes = [part.to_mesh() for part in parts]
    volumes = [mesh.topology().volume for mesh in meshes]
    negligible = _NEGLIGIBLE_VOLUME * max(volumes)
    return tuple(
        _largest_inside(mesh, solid) if volume > negligible else None
        for mesh, volume in zip(meshes, volumes, strict=True)
    )


def _largest_inside(part: Mesh, solid: Surface) -> Polytope | None:
    centre = _vertex_mean(part)
    best = None
    too_large, fits = 1.0, 0.0
    factor = 1.0 - _FIRST_SHRINK
    for _ in range(_BISECTIONS + 1):
        copy = _scaled(part, centre, factor)
        if _is_inside(copy, solid):
            best, fits = copy, factor
            if factor == 1.0 - _FIRST_SHRINK:
                break
        else:
            too_large = factor
        factor = (too_large + fits) / 2.0
        if factor < _SMALLEST_FACTOR:
            break
    return best


def _is_inside(copy: Polytope, solid: Surface) -> bool:
    if copy.dimension < 3:
        return False
    relation = mesh_relation(solid, Surface(copy.to_mesh(), True))
    return relation.relation == "contains" and relation.proven


def _scaled(part: Mesh, centre: tuple[float, float, float], factor: float) -> Polytope:
    """Vertices rounded, hence rebuilt as the exact hull of the rounded ones."""
    x, y, z = ((1.0 - factor) * coordinate for coordinate in centre)
    matrix = (factor, 0.0, 0.0, x, 0.0, factor, 0.0, y, 0.0, 0.0, factor, z, 0.0, 0.0, 0.0, 1.0)
    return part.transformed(matrix).convex_hull()


def _vertex_mean(part: Mesh) -> tuple[float, float, float]:
    points = list(struct.iter_unpack("<ddd", part.to_bytes()[0]))
    x, y, z = (sum(coordinate) / len(points) for coordinate in zip(*points, strict=True))
    return x, y, z
