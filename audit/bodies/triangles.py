"""Single triangles of a body, in the world."""

from __future__ import annotations

from satcheck import core
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.vectors import crossed, unit
from satcheck.core.conventions import Vector

Crossing = tuple[int, int]


def crossing_depth(pair: Pair, crossing: Crossing | None) -> float:
    """A proven lower bound of the depth from one pair of triangles that cross; 0.0 without one."""
    if crossing is None:
        return 0.0
    return core.crossing_depth(pair.a.surface(), pair.b.surface(), *crossing)


def triangle_normal(body: PlacedBody, index: int) -> Vector | None:
    """Unit, outward where the body is solid; None for a triangle without an area."""
    p, q, r = body.mesh.corners(index)
    u = (q[0] - p[0], q[1] - p[1], q[2] - p[2])
    v = (r[0] - p[0], r[1] - p[1], r[2] - p[2])
    normal = crossed(u, v)
    return unit(normal) if any(normal) else None
