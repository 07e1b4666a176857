"""The ladder: each rung settles what it can prove and leaves the rest to the next.

aabb -> obb -> hull -> triangles, or -> parts where --accuracy stops there. A rung that proves the
bodies apart by more than was asked about ends the climb. The highest allowed rung answers in any
case: what it could not prove is then an estimate, and it can only err towards "penetrating".
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck import core
from satcheck.audit.asked.plan import Plan
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.ladder.climb import climb
from satcheck.audit.report.report import Relation, Vector
from satcheck.core.tolerances import rounding_pad

if TYPE_CHECKING:
    from satcheck.core.curved.signed import Signed

# The words of the core for a relation.
RELATION_NAMED: dict[str, Relation] = {
    "separated": "separated",
    "touching": "touching",
    "penetrating": "penetrating",
    "contains": "contains",
    "inside": "inside",
    "coincident": "coincident",
}


class Contact(Struct, frozen=True):
    """How two bodies relate, without a touch band.

    proven: False where a capped ladder or a degenerate contact left it open. overlaps: although it
    is not, an overlap is; open is whether one body holds the other.
    gap_lower: a proven lower bound of their distance, 0.0 where none is known.
    convex: the signed distance, where both bodies are convex and it therefore says everything.
    crossing: indices of one triangle of each body that meet; point: a common point, rounded.
    reason: why it is not proven, where that is no matter of --accuracy. climb: what the rungs of
    the core found, where it came so far.
    """

    relation: Relation
    proven: bool
    gap_lower: float = 0.0
    convex: core.PairResult | Signed | None = None
    crossing: tuple[int, int] | None = None
    point: Vector | None = None
    reason: str | None = None
    climb: core.Climb | None = None
    overlaps: bool = False


def settle(pair: Pair, plan: Plan, found: core.Climb | None = None) -> Contact:
    """The relation of the pair by the lowest rung that settles the question.

    found: its climb, where it has been made; the rungs are then only put into words.
    """
    contact = _settled(pair, plan, climb(pair) if found is None else found)
    plane = pair.settings.planar
    if plane is None:
        return contact
    from satcheck.audit.ladder.in_plane import refine_nesting

    return refine_nesting(pair, contact, plane, plan)


def _settled(pair: Pair, plan: Plan, found: core.Climb) -> Contact:
    plan.climbed(found)
    contact = _proven(pair, found)
    if contact is not None:
        return contact
    gap = found.box_gap
    if gap > pair.asked_gap or not pair.may("obb"):
        return _apart_or_guess(gap)
    if pair.curved:
        from satcheck.audit.ladder.curved import settle_curved

        return settle_curved(pair, plan) if pair.may("hull") else _apart_or_guess(gap)
    if not pair.may("hull"):
        return _apart_or_guess(gap)
    if pair.outlined and found.hulls is None:
        if _outlines_apart(pair, plan):
            return _apart_beyond(pair)
        return _settled(pair, plan, climb(pair, "hull"))
    if pair.may("parts"):
        from satcheck.audit.ladder.parts_only import settle_by_parts

        return settle_by_parts(pair, plan)
    return Contact("penetrating", False)


def _proven(pair: Pair, found: core.Climb) -> Contact | None:
    """What the rung that the climb ended with says above the world boxes; None: not everything."""
    if found.triangles is not None:
        return _triangles(pair, found, found.triangles)
    if found.boxes == "apart":
        return _apart_beyond(pair)
    if found.hulls is None:
        return None
    return _convex(found, found.hulls) if found.both_convex else _hulls(found, found.hulls)


def _apart_beyond(pair: Pair) -> Contact:
    """By more than was asked about."""
    return Contact("separated", True, math.nextafter(pair.asked_gap, math.inf))


def _apart_or_guess(gap: float) -> Contact:
    return Contact("separated", True, gap) if gap > 0 else Contact("penetrating", False)


def boxes_apart(pair: Pair, plan: Plan) -> float:
    """Rung 0 alone: a lower bound of the gap of the world boxes, 0.0 when they meet."""
    found = climb(pair, last="aabb")
    plan.climbed(found)
    return found.box_gap


def _outlines_apart(pair: Pair, plan: Plan) -> bool:
    """In a check in a plane: whether an edge of two convex outlines settles the question."""
    a, b = pair.a.body.file.outline, pair.b.body.file.outline
    if a is None or b is None:
        return False
    import numpy as np

    found = core.sat_polygons(np.array(a), np.array(b))
    # The widest gap along an edge normal, less what its rounding can make of it.
    gap = -found.penetration - rounding_pad(pair.largest_coordinate)
    plan.record("sat", found.outcome, _edge_of(found))
    return found.outcome == "separated" and gap > pair.asked_gap


def _edge_of(found: core.PolygonResult) -> str:
    body, edge = ("A", found.edge_a) if found.edge_a >= 0 else ("B", found.edge_b)
    return f"outlines, edge {edge} of {body}"


def _convex(found: core.Climb, result: core.PairResult) -> Contact | None:
    """Everything about two convex bodies; None when the solver could not decide."""
    if result.outcome == "undecided":
        return None
    relation = RELATION_NAMED[result.outcome]
    # The surfaces differ from the hulls by the rounding of the pose: a relation without a common
    # interior can then only mean a graze, which the hulls have already settled.
    if found.nesting in ("contains", "inside", "coincident"):
        relation = RELATION_NAMED[found.nesting]
    return Contact(relation, True, max(result.lower or 0.0, 0.0), result, climb=found)


def _hulls(found: core.Climb, result: core.PairResult) -> Contact | None:
    """Apart, if the hulls of the whole meshes are; None otherwise."""
    if result.outcome != "separated":
        return None
    return Contact("separated", True, found.proven_gap, climb=found)


def _triangles(pair: Pair, found: core.Climb, surfaces: core.MeshRelation) -> Contact:
    if surfaces.hole is not None:
        return Contact("indeterminate", False, reason=_open(pair, surfaces.hole), climb=found)
    in_a, in_b = surfaces.triangle_a, surfaces.triangle_b
    return Contact(
        RELATION_NAMED[surfaces.relation],
        surfaces.proven,
        crossing=(in_a, in_b) if in_a >= 0 and in_b >= 0 else None,
        point=surfaces.point,
        climb=found,
    )


def _open(pair: Pair, hole: core.OpenHole) -> str:
    body, other = (pair.a, pair.b) if hole.of_a else (pair.b, pair.a)
    at = ", ".join(f"{c:.4g}" for c in hole.centre)
    which = "the hole" if hole.count == 1 else f"hole {hole.number + 1} of {hole.count}"
    where = f"in a box {hole.diameter:.3g} from corner to corner at ({at})"
    return f"{which} of {body.id}, {where}, meets {other.id}: what fills it decides the relation"
