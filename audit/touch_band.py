"""Whether a pair of concave meshes that cross is only flush: free after a move within the band.

A part that was set flush into another crosses it by the rounding of its file, however deep it sits
in the hull of the other. One crossing pair of triangles that is deeper than the band proves the
contrary at once. Otherwise A is nudged off the triangles it crosses, a third of the band at a time,
so that a part in a corner can leave three walls; a nudge that frees it is an upper bound of its
depth that lies within the band.
"""

from __future__ import annotations

import math

from satcheck import core
from satcheck.audit.ladder import Contact
from satcheck.audit.pair import Pair
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector
from satcheck.audit.triangles import Crossing, crossing_depth, triangle_normal
from satcheck.audit.vectors import added, scaled
from satcheck.audit.verify import FREE

WALLS = 3
ORIGIN: Vector = (0.0, 0.0, 0.0)


def flush_nudge(pair: Pair, contact: Contact, plan: Plan) -> Vector | None:
    """A translation of A, at most the tolerance long, after which it is free; None: none found."""
    if pair.tolerance == 0 or contact.crossing is None:
        return None
    if crossing_depth(pair, contact.crossing) > pair.tolerance:
        plan.record("touch-band", "deeper", "two triangles cross by more than the tolerance")
        return None
    nudge = _search(pair, contact.crossing, ORIGIN, WALLS)
    plan.record(
        "touch-band",
        "deeper" if nudge is None else "flush",
        f"no nudge of {pair.tolerance:.3g} was found that frees A"
        if nudge is None
        else f"a nudge of {math.hypot(*nudge):.3g} frees A",
    )
    return nudge


def _search(pair: Pair, crossing: Crossing, at: Vector, walls: int) -> Vector | None:
    """Depth first: step off the crossing triangles, then off those that are then crossed."""
    step = pair.tolerance / WALLS
    for away in _ways_off(pair, crossing):
        there = added(at, scaled(away, step))
        moved = core.Surface(pair.a.mesh.translated(there), pair.a.solid)
        found = core.mesh_relation(moved, pair.b.surface())
        if found.proven and found.relation in FREE:
            return there
        if walls > 1 and found.triangle_a >= 0 and found.triangle_b >= 0:
            further = _search(pair, (found.triangle_a, found.triangle_b), there, walls - 1)
            if further is not None:
                return further
    return None


def _ways_off(pair: Pair, crossing: Crossing) -> list[Vector]:
    """Unit directions for A: along B's outward normal, against its own; both ways if not solid."""
    ways = []
    for body, index, sign in ((pair.b, crossing[1], 1.0), (pair.a, crossing[0], -1.0)):
        normal = triangle_normal(body, index)
        if normal is None:
            continue
        for side in (sign,) if body.solid else (sign, -sign):
            ways.append(scaled(normal, side))
    return ways
