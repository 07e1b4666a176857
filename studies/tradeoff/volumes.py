"""Volumes of bodies in the world, and of the shapes that a rung puts in their place.

None: there is no such volume, or it is unknown.
"""

from __future__ import annotations

import math

from satcheck.audit.bodies.boxes import Box
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.core.errors import SatcheckError


def body_volume(body: PlacedBody) -> float | None:
    """Of solids that cover no point twice."""
    if body.curved is not None or not body.solid or not body.shared.covers_once():
        return None
    file = body.body.file
    return abs(file.health.volume) * _growth(body)


def stand_in_volume(rung: str, body: PlacedBody) -> float | None:
    """rung: by its name. Of convex parts, which have been made, the sum: what two of them share
    counts twice."""
    if body.curved is not None:
        return None
    if rung == "aabb":
        return _box(body.bounds)
    if rung == "obb":
        return _box(body.body.file.mesh.bounds) * _growth(body)
    if rung == "hull" or (rung == "parts" and body.convex):
        return body.shared.geometry.hull().to_mesh().topology().volume * _growth(body)
    if rung == "parts":
        known = body.shared.decomposition.known
        if known is None or isinstance(known, SatcheckError):
            return None
        volumes = [part.to_mesh().topology().volume for part in known.parts]
        return math.fsum(volumes) * _growth(body)
    return None


def _box(bounds: Box) -> float:
    return math.prod(high - low for low, high in zip(*bounds, strict=True))


def _growth(body: PlacedBody) -> float:
    """By what factor the transform makes a volume larger."""
    matrix = body.body.transform
    if matrix is None:
        return 1.0
    (a, b, c), (d, e, f), (g, h, i) = (matrix[4 * row : 4 * row + 3] for row in range(3))
    return abs(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g))
