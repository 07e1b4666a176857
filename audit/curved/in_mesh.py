"""A curved shape and a mesh that is not convex."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from satcheck.audit.boxes import holds as box_holds
from satcheck.audit.curved.contact import CLOSE_CONTACT, STAGE, TOO_CLOSE
from satcheck.audit.curved.nesting import holds
from satcheck.audit.curved.signed import Signed
from satcheck.audit.curved.triangles import Nearest, against_triangles
from satcheck.audit.ladder import Contact

if TYPE_CHECKING:
    from satcheck.audit.curved.shape import CurvedShape
    from satcheck.audit.pair import Pair
    from satcheck.audit.placed_body import PlacedBody
    from satcheck.audit.plan import Plan
    from satcheck.audit.report import Relation, Vector


def settle_mesh(pair: Pair, plan: Plan) -> Contact:
    curved, mesh, sign = _sides(pair)
    seen = against_triangles(curved, mesh.mesh, pair.asked_gap)
    if seen.undecided:
        plan.record(STAGE, "undecided", "the bounds of a triangle and the shape did not close")
        reason = "the bounds of a curved shape and a triangle did not close"
        return Contact("penetrating", False, reason=reason)
    crossed = [int(k) for k in seen.crossed if not mesh.solid or mesh.surface().is_boundary(int(k))]
    if crossed:
        return _crossing(pair, plan, len(crossed))
    if len(seen.crossed):
        plan.record(STAGE, "undecided", "only faces that bound no material meet the shape")
        reason = "a curved shape meets only faces that bound no material"
        return Contact("penetrating", False, reason=reason)
    if not _is_outside(mesh, curved.centre):
        if seen.nearest is not None and seen.nearest.outcome != "separated":
            plan.record(STAGE, "penetrating", f"within, and close to triangle {seen.triangle}")
            return Contact("penetrating", False, reason=TOO_CLOSE)
        relation: Relation = "inside" if sign > 0 else "contains"
        plan.record(STAGE, relation, "no triangle meets the shape, and its middle lies inside")
        return Contact(relation, True)
    return _apart(pair, plan, seen, sign)


def frees_mesh(pair: Pair, move: Vector) -> bool:
    """Whether A, moved, provably has no common interior with B."""
    curved, mesh, sign = _sides(pair)
    moved = (sign * move[0], sign * move[1], sign * move[2])
    seen = against_triangles(curved, mesh.mesh, 0.0, moved)
    apart = seen.nearest is None or (seen.nearest.lower >= 0 and not seen.undecided)
    x, y, z = curved.centre
    centre = (x + moved[0], y + moved[1], z + moved[2])
    return apart and not seen.undecided and _is_outside(mesh, centre)


def _crossing(pair: Pair, plan: Plan, triangles: int) -> Contact:
    curved, mesh, sign = _sides(pair)
    within = box_holds(curved.bounds(), mesh.bounds) and holds(curved, mesh)
    relation: Relation = "penetrating"
    if within:
        relation = "contains" if sign > 0 else "inside"
    plan.record(STAGE, relation, f"{triangles} triangles meet the inside of the shape")
    reason = TOO_CLOSE if within is None else None
    return Contact(relation, within is not None, reason=reason)


def _apart(pair: Pair, plan: Plan, seen: Nearest, sign: float) -> Contact:
    solid = _sides(pair)[1].solid  # the gap to a surface alone rules no containment out
    if seen.nearest is None:
        plan.record(STAGE, "separated", "no triangle is near the shape")
        gap = math.nextafter(pair.asked_gap, math.inf) if solid else 0.0
        return Contact("separated", True, gap)
    nearest: Signed = seen.nearest if sign > 0 else seen.nearest.swapped()
    plan.record(STAGE, nearest.outcome, f"nearest is triangle {seen.triangle}")
    reason = None if nearest.exact else CLOSE_CONTACT
    relation: Relation = "separated" if nearest.outcome == "separated" else "touching"
    gap = max(nearest.lower, 0.0) if solid else 0.0
    return Contact(relation, nearest.exact, gap, nearest, reason=reason)


def _sides(pair: Pair) -> tuple[CurvedShape, PlacedBody, float]:
    """The curved one, the other one, and +1 where A is the curved one, -1 where B is."""
    curved = pair.a.curved
    if curved is not None:
        return curved, pair.b, 1.0
    curved = pair.b.curved
    assert curved is not None
    return curved, pair.a, -1.0


def _is_outside(mesh: PlacedBody, point: Vector) -> bool:
    """A body without an inside has nothing within it."""
    return not mesh.solid or mesh.surface().winding_number(point) == 0
