"""Single triangles of a body, in the world."""

from __future__ import annotations

from satcheck import core
from satcheck.audit.pair import Pair
from satcheck.audit.placed_body import PlacedBody
from satcheck.audit.report import Vector
from satcheck.audit.tolerances import UNIT_ROUNDOFF
from satcheck.audit.vectors import crossed, unit

Crossing = tuple[int, int]


def crossing_depth(pair: Pair, crossing: Crossing | None) -> float:
    """A proven lower bound of the depth from one pair of triangles that cross; 0.0 without one.

    A translation that frees A leaves no two triangles crossing on which the bodies end: beside
    such a crossing both have material. That holds wherever along them they cross only if the bodies
    end on all of both triangles.
    """
    if crossing is None or not _both_end(pair, crossing):
        return 0.0
    triangle_a, triangle_b = crossing_hulls(pair, crossing)
    result = core.check_pair(triangle_a, triangle_b, query="depth")
    if result.outcome != "penetrating" or result.upper is None:
        return 0.0
    return max(-result.upper * (1 - 2 * UNIT_ROUNDOFF), 0.0)


def _both_end(pair: Pair, crossing: Crossing) -> bool:
    return pair.a.surface().is_boundary(crossing[0]) and pair.b.surface().is_boundary(crossing[1])


def crossing_hulls(pair: Pair, crossing: Crossing) -> tuple[core.Hull, core.Hull]:
    """The two triangles as convex shapes, where the bodies are now."""
    a, b = (
        core.Hull(body.mesh.corners(index))
        for body, index in zip((pair.a, pair.b), crossing, strict=True)
    )
    return a, b


def triangle_normal(body: PlacedBody, index: int) -> Vector | None:
    """Unit, outward where the body is solid; None for a triangle without an area."""
    p, q, r = body.mesh.corners(index)
    u = (q[0] - p[0], q[1] - p[1], q[2] - p[2])
    v = (r[0] - p[0], r[1] - p[1], r[2] - p[2])
    normal = crossed(u, v)
    return unit(normal) if any(normal) else None
