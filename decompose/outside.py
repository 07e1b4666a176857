"""How far convex parts stick out of the mesh they came from: a proven upper bound."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from satcheck.core import Polytope, Surface, deviation
from satcheck.decompose.components import diagonal

# Slack of the bound, in diagonals of the mesh's bounding box for a threshold of 1. Parts stick out
# by about 0.3 * threshold, so the first slack keeps the bound meaningful; the second is for parts
# that stick out by next to nothing.
_SLACKS: Final = (0.02, 0.005)
_WIDE: Final = 1.25  # upper over lower bound that is not worth the finer slack


def outside_error(parts: Sequence[Polytope], surface: Surface, threshold: float) -> float:
    """Upper bound of max over points of the parts' surfaces of the distance to the mesh."""
    unit = threshold * diagonal(surface.mesh)
    meshes = [part.to_mesh() for part in parts]
    bounds = [deviation(mesh, surface, _SLACKS[0] * unit) for mesh in meshes]
    for slack in _SLACKS[1:]:
        enough = _WIDE * max(lower for lower, _ in bounds)
        bounds = [
            deviation(mesh, surface, slack * unit) if bound[1] > enough else bound
            for mesh, bound in zip(meshes, bounds, strict=True)
        ]
    return max(upper for _, upper in bounds)
