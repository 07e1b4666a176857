"""What polygons prove about the curves that they approximate, in a check in a plane.

The boundary of a body and its polygon are nowhere farther apart than the body's deviation. So

- the gap of two bodies is that of their polygons, less both deviations at most. It is more by at
  most the deviations of polygons that are not inscribed: an inscribed one lies within its body.
- convex polygons grown by their deviations hold the bodies, so the depth is more by at most both
  deviations. It is less by at most those of polygons that are not inscribed: while the difference
  of the polygons reaches farther around the origin than the boundaries may be off, the boundaries
  run around each other or cross.
- of other polygons a translation proves an upper end only where it leaves a gap as wide as both
  deviations. The lower end is theirs where both are inscribed, else that of a point deep in both.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck import core
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.bodies.verdict import Verdict
from satcheck.audit.figures.depth import Depth
from satcheck.audit.figures.escape import Escape, relation_after
from satcheck.audit.figures.gap import Gap
from satcheck.audit.ladder.cheap_bounds import way_out_of_hulls
from satcheck.audit.ladder.in_plane import wall_gap
from satcheck.audit.request.trace import Trace
from satcheck.audit.rounding import keeps
from satcheck.audit.vectors import added, scaled
from satcheck.core.conventions import axes_of
from satcheck.core.rounding import rounding_pad
from satcheck.report.report import Vector

if TYPE_CHECKING:
    from satcheck.core import PairResult
    from satcheck.core.curved.signed import Signed

# A way out is tried longer by so many times the deviations: what it leads away from may be oblique.
_LONGER = (1.0, 1.5, 2.0, 4.0, 8.0)


def gap_of_curves(pair: Pair, gap: Gap) -> Gap:
    """The gap of the bodies, from that of their polygons. `within` stays that of the polygons: the
    touch band is wide enough for both."""
    lower = max(math.nextafter(gap.lower - pair.closer, -math.inf), 0.0)
    upper = math.nextafter(gap.upper + pair.farther, math.inf)
    clearance = pair.request.clearance
    kept = not clearance or keeps(clearance, lower, upper)
    return replace(gap, lower=lower, upper=upper, kept=kept)


def depth_of_curves(pair: Pair, verdict: Verdict, depth: Depth, trace: Trace) -> Depth:
    """The depth of the bodies, from that of their polygons."""
    convex = verdict.signed_distance is not None
    pad = rounding_pad(pair.largest_coordinate)
    lower = depth.lower
    if pair.farther:
        shown = depth.lower - pair.farther if convex else _lower_by_point(pair, depth)
        lower = max(shown - pad, 0.0)
    ways = [(math.hypot(*depth.escape.mtv), depth.normal)]
    bounds = [depth.upper + pair.closer + pad] if convex else []
    if not convex:
        hulls = way_out_of_hulls(pair)
        ways.append((hulls.length, hulls.normal))
        bounds.append(hulls.upper + pair.closer + pad)
    escape_and_normal = _way_out(pair, ways, pad) if pair.may("hull") else None
    if escape_and_normal is None:
        trace.record(
            "verify", "failed", f"no move leaves a gap of {pair.closer:.3g} for the curves"
        )
        length, normal = ways[-1]
        escape = Escape(_along(normal, length + pair.closer), False, math.inf)
    else:
        escape, normal = escape_and_normal
        trace.record("verify", "separated", f"A moved past its curves, by {pair.closer:.3g} more")
    upper = max(min(*bounds, escape.bound), lower)
    return Depth(lower, upper, normal, escape)


def _lower_by_point(pair: Pair, depth: Depth) -> float:
    """By a point between what meets once A has left B."""
    if not (depth.escape.verified and pair.may("exact")):
        return 0.0
    move = depth.escape.mtv
    moved = pair.a.surface().refit(pair.a.mesh.translated(move))
    nearest = core.mesh_distance(moved, pair.b.surface())
    there = added(scaled(move, -1.0), nearest.witness_a)
    near = scaled(added(there, nearest.witness_b), 0.5)
    return _depth_by_point(pair, near, math.hypot(*move) / 2)


def _depth_by_point(pair: Pair, near: Vector, step: float) -> float:
    from satcheck.audit.figures.deep_point import depth_around

    assert pair.settings.planar is not None
    off = pair.a.body.file.deviation, pair.b.body.file.deviation
    return depth_around((pair.a, pair.b), off, near, step, pair.settings.planar)


def _way_out(
    pair: Pair, ways: list[tuple[float, Vector]], pad: float
) -> tuple[Escape, Vector] | None:
    """The shortest translation of those tried that leaves a gap for the curves; None: none did."""
    for length, normal in sorted(_lengthened(pair, ways)):
        total = length + 4 * pad
        move = _along(normal, total)
        if _leaves_gap(pair, move, pad):
            return Escape(move, True, total + pad), normal
    return None


def _along(normal: Vector, length: float) -> Vector:
    x, y, z = scaled(normal, -length)
    return x + 0.0, y + 0.0, z + 0.0  # no negative zeros


def _lengthened(pair: Pair, ways: list[tuple[float, Vector]]) -> Iterator[tuple[float, Vector]]:
    for length, normal in ways:
        for share in _LONGER:
            yield length + share * pair.closer, normal


def _leaves_gap(pair: Pair, move: Vector, pad: float) -> bool:
    """Whether the polygons, once A is moved, are as far apart as the curves may be off them."""
    if pair.both_convex or not pair.may("exact"):
        hull = core.Hull(pair.a.mesh.translated(move).convex_hull())
        apart = core.check_pair(hull, pair.b.hull_shape(), query="distance")
        return (apart.lower or 0.0) - pad >= pair.closer
    if relation_after(pair, move) != "separated":
        return False
    moved = pair.a.surface().refit(pair.a.mesh.translated(move))
    gap = core.mesh_distance(moved, pair.b.surface(), 2 * pair.closer + 2 * pad)
    return gap.distance - pad >= pair.closer


def overlap_of_curves(pair: Pair, verdict: Verdict) -> bool:
    """Whether the bodies are shown to overlap in the way in which their polygons do."""
    assert pair.settings.planar is not None
    if verdict.relation in ("contains", "inside"):
        outer, inner = pair.a, pair.b
        if verdict.relation == "inside":
            outer, inner = inner, outer
        gap = wall_gap(outer, inner, pair.settings.planar)
        return gap > pair.closer + rounding_pad(pair.largest_coordinate)
    if verdict.relation != "penetrating":
        return False
    signed = verdict.signed_distance
    if pair.farther and (signed is None or _is_shallow(pair, signed)):
        return False
    return _sticks_out(pair, pair.a, pair.b) and _sticks_out(pair, pair.b, pair.a)


def is_hidden(pair: Pair, verdict: Verdict, depth: Depth | None) -> bool:
    """Whether the polygons overlap, and it is not shown that the curves do. depth: of the curves,
    where it is known."""
    if not pair.farther or (depth is not None and depth.lower > 0):
        return False
    if verdict.signed_distance is not None:
        return _is_shallow(pair, verdict.signed_distance)
    middle, size = _common_box(pair)
    return not _depth_by_point(pair, verdict.point or middle, size / 4) > 0


def _common_box(pair: Pair) -> tuple[Vector, float]:
    """Of the boxes of both: its middle, and its longer side in the plane."""
    assert pair.settings.planar is not None
    (low_a, high_a), (low_b, high_b) = pair.a.bounds, pair.b.bounds
    low = [max(p, q) for p, q in zip(low_a, low_b, strict=True)]
    high = [min(p, q) for p, q in zip(high_a, high_b, strict=True)]
    x, y, z = ((p + q) / 2 for p, q in zip(low, high, strict=True))
    return (x, y, z), max(high[axis] - low[axis] for axis in axes_of(pair.settings.planar))


def _is_shallow(pair: Pair, overlap: PairResult | Signed) -> bool:
    return -(overlap.upper or 0.0) <= pair.farther


def _sticks_out(pair: Pair, one: PlacedBody, other: PlacedBody) -> bool:
    """By their boxes."""
    assert pair.settings.planar is not None
    (low, high), (least, most) = one.bounds, other.bounds
    return any(
        least[axis] - low[axis] > pair.closer or high[axis] - most[axis] > pair.closer
        for axis in axes_of(pair.settings.planar)
    )
