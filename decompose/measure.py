"""How far convex parts and the mesh they came from differ, as proven upper bounds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from satcheck.core import Mesh, Polytope, Surface, deviation
from satcheck.decompose.components import diagonal, merged

# Slack of the two bounds, in diagonals of the mesh's bounding box. Parts stick out by about
# 0.3 * threshold, so a slack that is a small share of the threshold keeps the bound meaningful;
# they miss some 1e-4, whatever the threshold.
_OUTSIDE_SLACK_PER_THRESHOLD: Final = 0.02
_MISSING_SLACK: Final = 1e-3


def outside_error(parts: Sequence[Polytope], surface: Surface, threshold: float) -> float:
    """Upper bound of max over points of the parts' surfaces of the distance to the mesh."""
    slack = _OUTSIDE_SLACK_PER_THRESHOLD * threshold * diagonal(surface.mesh)
    return max(deviation(part.to_mesh(), surface, slack)[1] for part in parts)


def missing_error(mesh: Mesh, parts: Sequence[Polytope]) -> float:
    """Upper bound of max over points of the mesh's surface of the distance to the parts' union."""
    union = Surface(merged([part.to_mesh() for part in parts]), True)
    return deviation(mesh, union, _MISSING_SLACK * diagonal(mesh))[1]
