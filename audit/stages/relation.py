"""The stage `relation`: the ladder. Each rung settles the pairs that it can decide and leaves the
others to the next rung.

aabb -> obb -> hull -> triangles, or hull -> parts at --accuracy parts. The climb ends at a rung
that proves a gap beyond `gap_limit`. The highest allowed rung always answers. An answer that it
cannot prove is an estimate, and can only err towards "penetrating".

The core climbs and derives the verdict (`core/native/ladder/climb.hpp`). This module asks it, for
one pair or for many, calls the rungs that it does not have (half spaces, curved shapes, convex
parts and outlines in a plane), and puts the results of the rungs into words: the first stages of
the trace of a pair.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Literal

from satcheck import core
from satcheck.report.report import OVERLAPS, Stage
from satcheck.report.request import ON_REQUEST
from satcheck.scene.inspect import MOST_AROUND

if TYPE_CHECKING:
    from satcheck.audit.body import PlacedBody
    from satcheck.audit.draft import Draft
    from satcheck.audit.pair import Pair
    from satcheck.audit.settings import Accuracy
    from satcheck.core.conventions import Vector

    Question = tuple[core.PlacedGeometry, core.PlacedGeometry, float, float, float, float, bool]
    Rung = Literal["aabb", "obb", "hull", "triangles"]

# The last rung that the core climbs for each --accuracy. The core has no parts.
LAST: dict[Accuracy, Rung] = {
    "aabb": "aabb",
    "obb": "obb",
    "hull": "hull",
    "parts": "hull",
    "exact": "triangles",
}
TOO_MANY_STEPS = "deciding takes more steps than a pair may"
NO_STEPS_LEFT = "deciding takes more steps than the scene leaves for it: check the two alone"
# The result and the words of oriented boxes that are not apart.
_OBB = {
    "meet": ("meet", "sat: none of 15 axes separates"),
    "unturned": ("skipped", "neither placement turns: oriented boxes are the world boxes"),
    "sheared": ("skipped", "a transform shears: the carried box is no box"),
}
_NOT_CONVEX = "not both convex: hulls prove only separation"
# The axis of least overlap, or the axis that separates, by the features that it is made of.
_AXES = {
    "face-a": "a face normal of A",
    "face-b": "a face normal of B",
    "edge-edge": "an edge of A across one of B",
}


def settle(draft: Draft, climb: core.Climb | None = None) -> None:
    """Find how the bodies relate, by the lowest rung that settles it. climb: of the pair, if the
    core has made it already."""
    pair = draft.pair
    climb = _climb(pair) if climb is None else climb
    draft.steps = climb.steps
    draft.wants_more = climb.too_few_steps and draft.steps >= pair.steps
    if pair.on_half_space and pair.may("hull") and not _is_beyond(pair, climb):
        from satcheck.audit.stages.half_space import settle_half_space

        settle_half_space(draft, lambda: _by_rungs(draft, climb))
    else:
        _by_rungs(draft, climb)
    if pair.settings.planar is not None:
        from satcheck.audit.stages.in_plane import refine_nesting

        refine_nesting(draft, pair.settings.planar)


def apart_by_boxes(draft: Draft) -> bool:
    """Return whether the world boxes alone show a gap beyond `gap_limit`."""
    climb = _climb(draft.pair, "aabb")
    draft.stages += rungs_of(climb)
    _take(draft, climb)
    return climb.settled


def _is_beyond(pair: Pair, climb: core.Climb) -> bool:
    """Return whether a rung has proven a gap beyond `gap_limit`."""
    return climb.settled and climb.relation == "separated" and climb.gap_lower > pair.gap_limit


def _by_rungs(draft: Draft, climb: core.Climb) -> None:
    pair = draft.pair
    draft.stages += rungs_of(climb)
    if climb.settled or not pair.may("hull"):
        _take(draft, climb)
    elif pair.curved:
        from satcheck.audit.stages.curved import settle_curved

        settle_curved(draft)
    elif pair.may("parts"):
        from satcheck.audit.stages.parts import settle_by_parts

        settle_by_parts(draft)
    else:
        _take(draft, climb)


def _take(draft: Draft, climb: core.Climb) -> None:
    """Take the answer of the core."""
    weak = None
    if (hole := climb.hole) is not None:
        weak, draft.reason_code = open_hole(draft.pair, hole), "open-hole"
    if not climb.decided:
        weak = NO_STEPS_LEFT if draft.wants_more else TOO_MANY_STEPS
    draft.found(climb.relation, climb.proven, climb.gap_lower, climb.signed_distance, weak=weak)
    draft.crossing, draft.point, draft.climb = climb.crossing, climb.point, climb


def open_hole(pair: Pair, hole: core.OpenHole) -> str:
    """Return why the hole leaves the relation open."""
    body, other = (pair.a, pair.b) if hole.of_a else (pair.b, pair.a)
    at = ", ".join(f"{c:.4g}" for c in hole.centre)
    where = f"in a box {hole.diameter:.3g} from corner to corner at ({at})"
    if hole.doubtful:
        return (
            f"a part of {body.id}, {where}, meets {other.id}, and may be solid or a cavity: it "
            "faces outward within one that faces inward, or crosses another cavity"
        )
    which = "the hole" if hole.count == 1 else f"hole {hole.number + 1} of {hole.count}"
    return f"{which} of {body.id}, {where}, meets {other.id}: its fill decides the relation"


def _climb(pair: Pair, last: Rung | None = None) -> core.Climb:
    """Climb with one pair as far as the settings allow. Raises what making its bodies raises."""
    last = "aabb" if pair.curved else last or LAST[pair.settings.accuracy]
    method, steps = pair.settings.method, pair.steps
    return core.climb(_question(pair), "aabb", last, method, steps, pair.alone)


def start_climbs(pairs: Sequence[Pair], threads: int) -> Callable[[], list[core.Climb | None]]:
    """Start the climbs of pairs with the same settings and steps on `threads` threads; 0: one a
    core. The returned function waits for the results.

    A result is None if the climb failed, or if the pair has other steps; settle() then climbs
    again.
    """
    plain = [k for k, pair in enumerate(pairs) if not pair.curved]
    settings, steps = pairs[0].settings, pairs[0].steps
    questions = [_question(pairs[k]) for k in plain]
    climbing = core.Climbing(questions, LAST[settings.accuracy], threads, settings.method, steps)
    if len(plain) == len(pairs):
        return climbing.results

    def results() -> list[core.Climb | None]:
        climbs = dict(zip(plain, climbing.results(), strict=True))
        return [climbs.get(k) for k in range(len(pairs))]

    return results


def leaves_work(pair: Pair, climb: core.Climb | None) -> bool:
    """Return whether the pair needs computation after the climb."""
    if climb is None or pair.settings.accuracy == "parts" or pair.moves is not None:
        return True
    if climb.band in ("open", "hidden") or climb.thick is False:
        return True
    if not ON_REQUEST.keys().isdisjoint(pair.request.by):
        return True
    return "depth" in pair.request.by and climb.relation in OVERLAPS


def _question(pair: Pair) -> Question:
    a, b = pair.a.geometry, pair.b.geometry
    return a, b, pair.gap_limit, pair.tolerance, *pair.off, pair.wants_distance


def why_open(draft: Draft) -> str | None:
    """Return why the relation is undecided; None: it is decided."""
    if draft.exact == "indeterminate":
        return draft.weak or "undecided"
    pieces = _open_pieces_around(draft.pair) if draft.exact in ("separated", "touching") else None
    if pieces is not None:
        draft.reason_code = "open-pieces"
    return pieces


def _open_pieces_around(pair: Pair) -> str | None:
    """Return why one of two bodies that do not meet may still lie in the other; None: neither does.

    Each of the open pieces of a body is a sheet, but together they may be the wall of a solid: a
    box whose faces miss each other by more than the precision of the file has six open parts. They
    count as six sheets, but the box may be meant as a solid.
    """
    if pair.both_solid or pair.settings.allow_open:
        return None
    for outer, inner in ((pair.a, pair.b), (pair.b, pair.a)):
        if outer.solid or outer.body.open:
            continue
        health = outer.body.file.health
        in_pieces = not (health.closed or health.flat or outer.curved)
        if in_pieces and _is_around(outer, _point_of(inner)):
            return (
                f"open pieces of {outer.id} surround {inner.id}: close them, or say with "
                "--allow-open that they are meant to be open"
            )
    return None


def _point_of(body: PlacedBody) -> Vector:
    return body.mesh.vertex(0) if body.curved is None else body.curved.centre


def _is_around(body: PlacedBody, point: Vector) -> bool:
    low, high = body.bounds
    if not all(a <= c <= b for a, c, b in zip(low, point, high, strict=True)):
        return False
    return abs(body.surface().sheets_around(point)) > MOST_AROUND


def rungs_of(climb: core.Climb) -> list[Stage]:
    """Return the rungs that ran, in their order, without the touch band and the gap."""
    boxes, hulls, triangles, cost = climb.boxes, climb.hulls, climb.triangles, climb.nanoseconds
    rungs: list[Stage] = []
    if boxes or (hulls is None and triangles is None):  # else the climb began above them
        rungs.append(_world_boxes(climb.box_gap, cost[0] / 1000.0))
    if boxes:
        if boxes == "apart":
            result, detail = "separated", _separating_axis(*climb.box_axis)
        else:
            result, detail = _OBB[boxes]
        rungs.append(Stage("obb", result, cost[1] / 1000.0, detail))
    if hulls is not None:
        rungs.append(Stage("hull", *_hulls(climb, hulls, cost[2] / 1000.0)))
    if (nesting := climb.nesting) is not None:
        detail = "one world box holds the other"
        rungs.append(Stage("containment", nesting, cost[3] / 1000.0, detail))
    if triangles is not None:
        rungs.append(Stage("triangles", *_triangles(triangles, cost[4] / 1000.0)))
    return rungs


def _world_boxes(gap: float, microseconds: float) -> Stage:
    if gap > 0:
        detail = f"world boxes apart by at least {gap:.6g}"
        return Stage("aabb", "separated", microseconds, detail)
    return Stage("aabb", "meet", microseconds, "world boxes meet")


def _separating_axis(feature: str, a: int, b: int, tested: int) -> str:
    if feature == "edge-edge":
        axis = f"edge {'xyz'[a]} of A across edge {'xyz'[b]} of B"
    else:
        axis = f"face normal {'xyz'[a]} of A" if a >= 0 else f"face normal {'xyz'[b]} of B"
    return f"sat: {axis} separates, {tested} of 15 axes tested"


def _hulls(
    climb: core.Climb, hulls: core.PairResult, microseconds: float
) -> tuple[str, float, str]:
    outcome = hulls.outcome
    if climb.both_convex:
        return outcome, microseconds, f"both convex: {_method(hulls)}"
    if outcome == "separated":
        gap = max(hulls.lower or 0.0, climb.box_gap)
        return outcome, microseconds, f"hulls apart by at least {gap:.6g}"
    return "undecided" if outcome == "undecided" else "meet", microseconds, _NOT_CONVEX


def _method(hulls: core.PairResult) -> str:
    if hulls.feature not in _AXES:
        return f"{hulls.method} {hulls.feature}"
    axes = f"sat, {hulls.axes_tested} axes, least along {_AXES[hulls.feature]}"
    return f"{axes}: exact signs" if hulls.method == "exact" else axes


def _triangles(triangles: core.MeshRelation, microseconds: float) -> tuple[str, float, str]:
    if not triangles.decided:
        return "undecided", microseconds, "too many steps"
    a, b, edge_tests = triangles.triangle_a, triangles.triangle_b, triangles.edge_tests
    if edge_tests is None:
        said = f"{triangles.box_tests} box tests, {triangles.triangle_tests} triangle tests"
    else:
        said = f"{edge_tests} tests of edges of the outlines"
    if a >= 0 and b >= 0:
        said += f", triangles {a} and {b} meet"
    if not triangles.proven:
        said += ", sampled in a degenerate contact"
    return triangles.relation, microseconds, said
