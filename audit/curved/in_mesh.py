"""A curved shape and a mesh that is not convex."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.audit.bodies.boxes import holds as box_holds
from satcheck.audit.curved.contact import CLOSE_CONTACT, PROOF, STAGE, TOO_CLOSE
from satcheck.audit.curved.nesting import holds
from satcheck.audit.curved.signed import ORIGIN, Signed
from satcheck.audit.curved.triangles import Nearest, against_triangles
from satcheck.audit.ladder.ladder import Contact
from satcheck.audit.tolerances import rounding_pad
from satcheck.audit.vectors import added, scaled

if TYPE_CHECKING:
    from satcheck import core
    from satcheck.audit.asked.plan import Plan
    from satcheck.audit.bodies.pair import Pair
    from satcheck.audit.bodies.placed_body import PlacedBody
    from satcheck.audit.curved.shape import CurvedShape
    from satcheck.audit.report.report import Relation, Vector

# Points of the unit ball, the middle first: where that lies on the surface another one may not.
_TRIED: tuple[Vector, ...] = (
    (0.0, 0.0, 0.0),
    (0.37, 0.61, 0.53),
    (-0.59, 0.31, -0.47),
    (0.23, -0.71, 0.41),
)


def settle_mesh(pair: Pair, plan: Plan) -> Contact:
    curved, mesh, sign = _sides(pair)
    seen = against_triangles(curved, mesh.mesh, pair.asked_gap)
    if seen.refined:
        detail = f"{seen.refined} triangles that bounds leave open"
        plan.record(PROOF, seen.nearest.outcome if seen.nearest else "undecided", detail)
    crossed = _ends(mesh, seen)
    if crossed:
        return _crossing(pair, plan, len(crossed))
    hole = _hole_in_the_way(curved, mesh, _outcome(seen))
    winding = 0 if hole is not None else _winding_within(curved, mesh)
    if winding:
        return _within(plan, mesh, seen, sign)
    if len(seen.crossed):
        return _crossing(pair, plan, len(seen.crossed))
    if winding is None or seen.undecided or hole is not None:
        reason = hole or _open(seen)
        plan.record(STAGE, "undecided", reason)
        return Contact("indeterminate", False, reason=f"undecided: {reason}")
    return _apart(pair, plan, seen, sign)


def frees_mesh(pair: Pair, move: Vector) -> bool:
    """Whether A, moved, provably has no common interior with B."""
    curved, mesh, sign = _sides(pair)
    moved = (sign * move[0], sign * move[1], sign * move[2])
    seen = against_triangles(curved, mesh.mesh, 0.0, moved)
    apart = seen.nearest is None or seen.nearest.outcome == "separated" or seen.nearest.lower >= 0
    if (
        not apart
        or seen.undecided
        or _hole_in_the_way(curved, mesh, _outcome(seen), moved) is not None
    ):
        return False
    return _winding_within(curved, mesh, moved) == 0


def move_off(pair: Pair, most: float) -> Vector | None:
    """A translation of A, no longer than that, that provably frees it: off the triangle that the
    shape is deepest in. None: no face does, usually because the shape stands in several."""
    curved, mesh, sign = _sides(pair)
    nearest = against_triangles(curved, mesh.mesh, 0.0).nearest
    if nearest is None or nearest.normal is None:
        return None
    for longer in (0.0, rounding_pad(pair.largest_coordinate)):
        length = longer - min(nearest.lower, 0.0)
        move = added(scaled(nearest.normal, -sign * length), ORIGIN)  # which has no negative zero
        if 0 < math.hypot(*move) <= most and frees_mesh(pair, move):
            return move
    return None


def _ends(mesh: PlacedBody, seen: Nearest) -> list[int]:
    """Of the triangles that the inside of the shape meets those on which the body ends; of a body
    with holes all count."""
    crossed: list[int] = seen.crossed.tolist()
    closed, hulls = mesh.surface().closed()
    return crossed if hulls else [k for k in crossed if closed.is_boundary(k)]


def _touched(seen: Nearest) -> tuple[int, ...]:
    """The triangles that the shape provably touches, while it enters none."""
    if seen.undecided or seen.nearest is None or not seen.nearest.exact:
        return ()
    return seen.touched


def _outcome(seen: Nearest) -> str:
    return "separated" if seen.nearest is None else seen.nearest.outcome


def _hole_in_the_way(
    curved: CurvedShape, mesh: PlacedBody, outcome: str, move: Vector = ORIGIN
) -> str | None:
    """The hole of the mesh whose fill may overlap the moved shape, or touch a shape that the mesh
    does not touch; None: there is no such hole. outcome: of the triangles of the mesh."""
    _, hulls = mesh.surface().closed()
    for number, hull in enumerate(hulls):
        seen = against_triangles(curved, hull.mesh, 0.0, move)
        harmless = _outcome(seen) in ("separated", "touching" if outcome == "touching" else "")
        if seen.undecided or not harmless or _is_held(curved, hull, move):
            which = "the hole" if len(hulls) == 1 else f"hole {number + 1} of {len(hulls)}"
            return f"{which} of {mesh.id} meets the curved shape: what fills it decides"
    return None


def _is_held(curved: CurvedShape, hull: core.Surface, move: Vector) -> bool:
    """Whether the middle of the moved shape lies in the hull."""
    return hull.winding_number(added(curved.centre, move)) != 0


def _within(plan: Plan, mesh: PlacedBody, seen: Nearest, sign: float) -> Contact:
    """A point inside the shape is known to lie within the mesh: they overlap."""
    nearest = seen.nearest
    surface = mesh.surface()
    touched = next((k for k in _touched(seen) if surface.is_boundary(k)), None)
    if touched is not None:
        plan.record(STAGE, "penetrating", f"within, and touches triangle {touched}")
        return Contact("penetrating", True)
    if seen.undecided or (nearest is not None and nearest.outcome != "separated"):
        plan.record(STAGE, "penetrating", f"within, and close to triangle {seen.triangle}")
        return Contact("penetrating", False, reason=TOO_CLOSE, overlaps=True)
    relation: Relation = "inside" if sign > 0 else "contains"
    plan.record(STAGE, relation, "no triangle meets the shape, and its middle lies inside")
    return Contact(relation, True)


def _open(seen: Nearest) -> str:
    if seen.undecided:
        return "the bounds of a curved shape and a triangle did not close"
    return "no point of a curved shape could be told to lie within the mesh or not"


def _crossing(pair: Pair, plan: Plan, triangles: int) -> Contact:
    curved, mesh, sign = _sides(pair)
    within = box_holds(curved.bounds(), mesh.bounds) and holds(curved, mesh)
    relation: Relation = "penetrating"
    if within:
        relation = "contains" if sign > 0 else "inside"
    plan.record(STAGE, relation, f"{triangles} triangles meet the inside of the shape")
    reason = TOO_CLOSE if within is None else None
    return Contact(relation, within is not None, reason=reason, overlaps=True)


def _gap_of_holes(pair: Pair) -> float:
    """A lower bound of the distance of the shape from the fills of all holes; inf where no hole is
    within the gap of the question."""
    curved, mesh, _ = _sides(pair)
    _, hulls = mesh.surface().closed()
    seen = [against_triangles(curved, hull.mesh, pair.asked_gap) for hull in hulls]
    if any(one.undecided for one in seen):
        return 0.0
    lower = [one.nearest.lower for one in seen if one.nearest is not None]
    return max(min(lower, default=math.inf), 0.0)


def _apart(pair: Pair, plan: Plan, seen: Nearest, sign: float) -> Contact:
    of_holes = _gap_of_holes(pair)
    if seen.nearest is None:
        plan.record(STAGE, "separated", "no triangle is near the shape")
        beyond = math.nextafter(pair.asked_gap, math.inf)
        return Contact("separated", True, min(beyond, of_holes))
    nearest: Signed = seen.nearest if sign > 0 else seen.nearest.swapped()
    if nearest.outcome == "separated":
        nearest = replace(nearest, lower=min(nearest.lower, of_holes))
    plan.record(STAGE, nearest.outcome, f"nearest is triangle {seen.triangle}")
    relation: Relation = "separated" if nearest.outcome == "separated" else "touching"
    exact = nearest.exact
    if relation == "touching":
        exact = bool(_touched(seen))
    reason = None if exact else CLOSE_CONTACT
    return Contact(relation, exact, max(nearest.lower, 0.0), nearest, reason=reason)


def _sides(pair: Pair) -> tuple[CurvedShape, PlacedBody, float]:
    """The curved one, the other one, and +1 where A is the curved one, -1 where B is."""
    curved = pair.a.curved
    if curved is not None:
        return curved, pair.b, 1.0
    curved = pair.b.curved
    assert curved is not None
    return curved, pair.a, -1.0


def _winding_within(curved: CurvedShape, mesh: PlacedBody, move: Vector = ORIGIN) -> int | None:
    """The winding number of the mesh, closed, about a point inside the shape, moved. None where
    those that were tried lie on its surface."""
    closed, _ = mesh.surface().closed()
    x, y, z = added(curved.centre, move)
    step = 0.5 * curved.inner_radius
    for u, v, w in _TRIED:
        found = closed.winding_number((x + step * u, y + step * v, z + step * w))
        if found is not None:
            return found
    return None
