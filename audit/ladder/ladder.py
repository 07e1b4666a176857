"""The ladder: each rung settles the pairs that it can decide and leaves the others to the next
rung.

aabb -> obb -> hull -> triangles, or hull -> parts at --accuracy parts. The climb ends at a rung
that proves a gap beyond `gap_limit`. The highest allowed rung always answers. An answer that it
cannot prove is an estimate, and can only err towards "penetrating".

The core climbs and derives the verdict (`core/native/ladder/verdict.hpp`). This module adds the
rungs that the core does not have: curved shapes and convex parts.
"""

from __future__ import annotations

from satcheck import core
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.verdict import Verdict
from satcheck.audit.ladder.core_climb import climb_pair
from satcheck.audit.request.trace import Trace


def settle(pair: Pair, trace: Trace, climb: core.Climb | None = None) -> Verdict:
    """The verdict on the pair by the lowest rung that settles it.

    climb: of the pair, if the core has made it already.
    """
    climb = climb_pair(pair) if climb is None else climb
    plane = pair.settings.planar
    if pair.on_half_space and pair.may("hull"):
        return _over_half_space(pair, trace, climb)
    verdict = _settled(pair, trace, climb)
    if plane is None:
        return verdict
    from satcheck.audit.ladder.in_plane import refine_nesting

    return refine_nesting(pair, verdict, plane, trace)


def _settled(pair: Pair, trace: Trace, climb: core.Climb) -> Verdict:
    trace.climbed(climb)
    if climb.settled or not pair.may("hull"):
        return _verdict_of(pair, climb)
    if pair.curved:
        from satcheck.audit.ladder.curved import settle_curved

        return settle_curved(pair, trace)
    if pair.may("parts"):
        from satcheck.audit.ladder.parts_only import settle_by_parts

        return settle_by_parts(pair, trace)
    return _verdict_of(pair, climb)


def _over_half_space(pair: Pair, trace: Trace, climb: core.Climb) -> Verdict:
    if climb.settled and climb.relation == "separated" and climb.gap_lower > pair.gap_limit:
        return _settled(pair, trace, climb)
    from satcheck.audit.ladder.half_space import settle_half_space

    if pair.curved:
        return settle_half_space(pair, trace, lambda: _settled(pair, trace, climb))
    return settle_half_space(pair, trace, None, _settled(pair, trace, climb))


def _verdict_of(pair: Pair, climb: core.Climb) -> Verdict:
    return Verdict(
        climb.relation,
        climb.proven,
        climb.gap_lower,
        climb.signed_distance,
        climb.crossing,
        climb.point,
        why_open(pair, climb.hole) if climb.hole is not None else None,
        climb,
    )


def boxes_verdict(pair: Pair, trace: Trace) -> Verdict | None:
    """The verdict by the world boxes alone; None: their gap does not exceed `gap_limit`."""
    climb = climb_pair(pair, last="aabb")
    trace.climbed(climb)
    return _verdict_of(pair, climb) if climb.settled else None


def why_open(pair: Pair, hole: core.OpenHole) -> str:
    """Return why the hole leaves the relation open."""
    body, other = (pair.a, pair.b) if hole.of_a else (pair.b, pair.a)
    at = ", ".join(f"{c:.4g}" for c in hole.centre)
    which = "the hole" if hole.count == 1 else f"hole {hole.number + 1} of {hole.count}"
    where = f"in a box {hole.diameter:.3g} from corner to corner at ({at})"
    return f"{which} of {body.id}, {where}, meets {other.id}: its fill decides the relation"
