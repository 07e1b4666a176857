"""The ladder's answer and the figures for pairs of which one body at least is a curved shape."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.bodies.boxes import holds as box_holds
from satcheck.audit.curved.signed import convex_pair
from satcheck.audit.ladder.ladder import Contact
from satcheck.audit.report.report import NOT_AVAILABLE, ON_TRIANGLES

if TYPE_CHECKING:
    from satcheck.audit.asked.plan import Plan
    from satcheck.audit.bodies.pair import Pair
    from satcheck.audit.bodies.placed_body import PlacedBody
    from satcheck.audit.curved.signed import Signed
    from satcheck.audit.report.report import Relation, Vector

STAGE = "curved"
PROOF = "curved-exact"
TOO_CLOSE = "they overlap, and one may lie within the other: too close to its surface to tell"
OPEN_BOUNDS = "the bounds of a curved shape did not close"
CLOSE_CONTACT = "a curved shape in contact as far as its bounds tell"


def settle_curved(pair: Pair, plan: Plan) -> Contact:
    """The relation, once the boxes of the bodies were found too close to settle it."""
    if _is_convex(pair.a) and _is_convex(pair.b):
        return _settle_convex(pair, plan)
    from satcheck.audit.curved.in_mesh import settle_mesh

    return settle_mesh(pair, plan)


def frees(pair: Pair, move: Vector) -> bool:
    """Whether A, moved, provably has no common interior with B."""
    if _is_convex(pair.a) and _is_convex(pair.b):
        found = convex_pair(pair.a, pair.b, move)
        if found is None or found.exact or found.lower >= 0:
            return found is not None and found.lower >= 0
        from satcheck.audit.curved.exact.pair import proven

        return proven(pair.a, pair.b, found, move)[0].lower >= 0
    from satcheck.audit.curved.in_mesh import frees_mesh

    return frees_mesh(pair, move)


def without_meshes(reason: str | None, pair: Pair, plan: Plan) -> str | None:
    """The reason of a finding, which says too that what is found on meshes alone is not known of a
    curved shape."""
    missing = [effect for effect in ON_TRIANGLES if pair.asked.wants(effect)]
    for effect in missing:
        plan.record(effect, NOT_AVAILABLE, "a curved shape has no triangles")
    if missing:
        return reason or f"{' and '.join(missing)}: not available for curved shapes"
    return reason


def _is_convex(body: PlacedBody) -> bool:
    return body.curved is not None or body.convex


def _settle_convex(pair: Pair, plan: Plan) -> Contact:
    found = convex_pair(pair.a, pair.b)
    if found is None:
        plan.record(STAGE, "undecided", OPEN_BOUNDS)
        return Contact("indeterminate", False, reason=f"undecided: {OPEN_BOUNDS}")
    plan.record(STAGE, found.outcome, "convex shapes")
    if not found.exact:
        found = _closed(pair, found, plan)
    if found.outcome != "penetrating":
        reason = None if found.exact else CLOSE_CONTACT
        return Contact(found.outcome, found.exact, max(found.lower, 0.0), found, reason=reason)  # type: ignore[arg-type]
    relation, is_known = _nesting(pair, plan)
    if relation != "penetrating":
        plan.record("containment", relation, "one shape holds the other")
    reason = None if is_known else TOO_CLOSE
    return Contact(relation, is_known, 0.0, found, reason=reason, overlaps=True)


def _closed(pair: Pair, found: Signed, plan: Plan) -> Signed:
    """With what exact arithmetic proves where bounds do not."""
    from satcheck.audit.curved.exact.pair import proven

    closed, detail = proven(pair.a, pair.b, found)
    plan.record(PROOF, closed.outcome if closed.exact else "undecided", detail)
    return closed


def _nesting(pair: Pair, plan: Plan) -> tuple[Relation, bool]:
    """contains, inside or penetrating, and whether that is known."""
    outer, inner = _holds(pair.a, pair.b), _holds(pair.b, pair.a)
    if outer is None or inner is None:
        from satcheck.audit.curved.exact.nesting import nesting

        known = nesting(pair.a, pair.b)
        outer = known[0] if outer is None else outer
        inner = known[1] if inner is None else inner
        plan.record(PROOF, "undecided" if None in (outer, inner) else "known", "which holds which")
    if outer:
        return "contains", True
    if inner:
        return "inside", True
    return "penetrating", outer is False and inner is False


def _holds(outer: PlacedBody, inner: PlacedBody) -> bool | None:
    """Whether one body lies within the other and does not reach its surface; None: unknown."""
    if not box_holds(outer.bounds, inner.mesh.bounds):
        return False
    from satcheck.audit.curved.nesting import holds, is_within_hull

    shape = outer.curved
    if shape is not None:
        return holds(shape, inner)
    curved = inner.curved
    assert curved is not None
    return is_within_hull(curved, outer.hull())
