"""Checks in a plane: each body is a prism whose height exceeds the width of every body.

A polygon lies within its body, whose boundary is nowhere farther from it than the body's deviation.
So

- the gap of two bodies is that of their polygons, less both deviations at most.
- the depth is at least that of the polygons. Convex polygons grown by their deviations hold the
  bodies, so it is more by at most both deviations. Of other polygons a translation proves an upper
  end only where it leaves a gap as wide as both deviations.
"""

from __future__ import annotations

import math

from msgspec.structs import replace

from satcheck import core
from satcheck.audit.body import Box, PlacedBody
from satcheck.audit.draft import Depth, Draft, Escape, Gap
from satcheck.audit.pair import Pair
from satcheck.audit.stages.depth import against, relation_after, way_out_of_hulls
from satcheck.core.conventions import Plane, axes_of, axis_across
from satcheck.core.rounding import rounding_pad
from satcheck.report.judge import keeps
from satcheck.report.report import OVERLAPS, Relation, Vector


def refine_nesting(draft: Draft, plane: Plane) -> None:
    """Decide `contains`, `inside` and `coincident` by the outlines.

    The prisms have different heights, which mean nothing. A prism that is made taller shows whether
    its outline contains the other. Two prisms of one height show whether the outlines coincide.
    """
    if draft.exact in OVERLAPS:
        draft.exact = _nesting(draft.pair.a, draft.pair.b, plane)
        if draft.exact != "penetrating":
            draft.record("containment", draft.exact, "the outlines, as prisms of heights that suit")


def _nesting(a: PlacedBody, b: PlacedBody, plane: Plane) -> Relation:
    holds_b, holds_a = _holds(a.bounds, b.bounds, plane), _holds(b.bounds, a.bounds, plane)
    height = max(body.bounds[1][axis_across(plane)] for body in (a, b))
    if holds_a and holds_b and _related(a, height, b, height, plane) == "coincident":
        return "coincident"
    if holds_b and _related(a, 2 * height, b, height, plane) == "contains":
        return "contains"
    if holds_a and _related(a, height, b, 2 * height, plane) == "inside":
        return "inside"
    return "penetrating"


def _related(a: PlacedBody, height_a: float, b: PlacedBody, height_b: float, plane: Plane) -> str:
    return core.mesh_relation(_reaching(a, height_a, plane), _reaching(b, height_b, plane)).relation


def wall_gap(outer: PlacedBody, inner: PlacedBody, plane: Plane) -> float:
    """The distance of a body's outline from an outline that it contains."""
    height = max(body.bounds[1][axis_across(plane)] for body in (outer, inner))
    around, within = _reaching(outer, 2 * height, plane), _reaching(inner, height, plane)
    return core.mesh_distance(around, within).distance


def _holds(outer: Box, inner: Box, plane: Plane) -> bool:
    return all(
        outer[0][axis] <= inner[0][axis] and inner[1][axis] <= outer[1][axis]
        for axis in axes_of(plane)
    )


def _reaching(body: PlacedBody, height: float, plane: Plane) -> core.Surface:
    """The same prism with another height."""
    import numpy as np

    vertices, axis = np.array(body.mesh.vertices), axis_across(plane)
    vertices[:, axis] = np.copysign(height, vertices[:, axis])
    return core.Surface(core.Mesh(vertices, body.mesh.triangles), body.solid)


# A way out is tried longer by so many times the deviations: what it leads away from may be oblique.
_LONGER = (1.0, 1.5, 2.0, 4.0, 8.0)


def gap_of_curves(pair: Pair, gap: Gap) -> Gap:
    """The gap of the bodies, from that of their polygons. `within` stays that of the polygons: the
    touch band is wide enough for both."""
    lower = max(math.nextafter(gap.lower - pair.closer, -math.inf), 0.0)
    clearance = pair.request.clearance
    kept = not clearance or keeps(clearance, lower, gap.upper)
    return replace(gap, lower=lower, kept=kept)


def depth_of_curves(draft: Draft, depth: Depth) -> Depth:
    """The depth of the bodies, from that of their polygons."""
    pair = draft.pair
    convex = draft.signed is not None
    pad = rounding_pad(pair.largest_coordinate)
    ways = [(math.hypot(*depth.escape.mtv), depth.normal)]
    bounds = [depth.upper + pair.closer + pad] if convex else []
    if not convex:
        hulls = way_out_of_hulls(pair)
        ways.append((hulls.length, hulls.normal))
        bounds.append(hulls.upper + pair.closer + pad)
    escape = _way_out(pair, ways, pad) if pair.may("hull") else None
    if escape is None:
        no_move = f"no move leaves a gap of {pair.closer:.3g} for the curves"
        draft.record("verify", "failed", no_move)
        length, normal = ways[-1]
        escape = Escape(against(normal, length + pair.closer), normal, False, math.inf)
    else:
        draft.record("verify", "separated", f"A moved past its curves, by {pair.closer:.3g} more")
    upper = max(min(*bounds, escape.bound), depth.lower)
    return Depth(depth.lower, upper, escape)


def _way_out(pair: Pair, ways: list[tuple[float, Vector]], pad: float) -> Escape | None:
    """The shortest translation of those tried that leaves a gap for the curves; None: none did."""
    tried = ((length + k * pair.closer, normal) for length, normal in ways for k in _LONGER)
    for length, normal in sorted(tried):
        total = length + 4 * pad
        move = against(normal, total)
        if _leaves_gap(pair, move, pad):
            return Escape(move, normal, True, total + pad)
    return None


def _leaves_gap(pair: Pair, move: Vector, pad: float) -> bool:
    """Whether the polygons, once A is moved, are as far apart as the curves may be off them."""
    if pair.both_convex or not pair.may("exact"):
        hull = core.Hull(pair.a.mesh.translated(move).convex_hull())
        apart = core.check_pair(hull, pair.b.hull_shape(), query="distance")
        return (apart.lower or 0.0) - pad >= pair.closer
    if relation_after(pair, move) != "separated":
        return False
    moved = pair.a.surface().translated(move)
    gap = core.mesh_distance(moved, pair.b.surface(), 2 * pair.closer + 2 * pad)
    return gap.distance - pad >= pair.closer


def overlap_of_curves(draft: Draft) -> bool:
    """Whether the bodies are shown to overlap in the way in which their polygons do."""
    pair = draft.pair
    assert pair.settings.planar is not None
    if draft.exact in ("contains", "inside"):
        outer, inner = pair.a, pair.b
        if draft.exact == "inside":
            outer, inner = inner, outer
        gap = wall_gap(outer, inner, pair.settings.planar)
        return gap > pair.closer + rounding_pad(pair.largest_coordinate)
    if draft.exact != "penetrating":
        return False
    return _sticks_out(pair, pair.a, pair.b) and _sticks_out(pair, pair.b, pair.a)


def _sticks_out(pair: Pair, one: PlacedBody, other: PlacedBody) -> bool:
    """By their boxes."""
    assert pair.settings.planar is not None
    (low, high), (least, most) = one.bounds, other.bounds
    return any(
        least[axis] - low[axis] > pair.closer or high[axis] - most[axis] > pair.closer
        for axis in axes_of(pair.settings.planar)
    )
