"""The rung of `--accuracy parts`: convex parts instead of triangles.

Parts differ from a mesh by a measured error. An overlap deeper than that error is proven; any other
answer is an estimate.
"""

from __future__ import annotations

import math

from satcheck import core
from satcheck.audit.bodies.boxes import largest_coordinate
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.parts import Covering, covering, inner_parts, split_together
from satcheck.audit.bodies.verdict import Verdict
from satcheck.audit.ladder.inner_bodies import deepest_pair
from satcheck.audit.request.trace import Trace
from satcheck.core.rounding import rounding_pad
from satcheck.report.report import Relation


def settle_by_parts(pair: Pair, trace: Trace) -> Verdict:
    """The verdict by the parts. It is proven if the measured error of the parts allows it; else it
    is an estimate."""
    if not pair.both_solid:
        trace.record("parts", "not asked", "a mesh that is not solid has no inside to fill")
        return Verdict("penetrating", False)
    if any(body.shared.has_sheets() for body in (pair.a, pair.b)):
        trace.record("parts", "not asked", "a sheet has no inside to fill, and parts leave it out")
        return Verdict("penetrating", False)
    split_together(pair)
    covers = [covering(body, trace) for body in (pair.a, pair.b)]
    if covers[0] is None or covers[1] is None:
        trace.record("parts", "failed", "see the issues")
        return Verdict("penetrating", False)
    gap = _gap(covers[0], covers[1])
    proven_gap = gap - covers[0].missing - covers[1].missing
    count = f"{len(covers[0].parts)} and {len(covers[1].parts)} parts"
    if proven_gap > 0:
        trace.record("parts", "separated", f"{count}, apart by more than their error")
        return Verdict("separated", True, proven_gap)
    if deepest_pair(inner_parts(pair.a, trace), inner_parts(pair.b, trace)) > 0:
        trace.record("parts", "penetrating", f"{count}, of which two inside the meshes overlap")
        return Verdict("penetrating", True)
    relation: Relation = "separated" if gap > 0 else "penetrating"
    trace.record("parts", relation, f"{count}, within their error")
    return Verdict(relation, False)


def _gap(a: Covering, b: Covering) -> float:
    """A lower bound of the distance of the nearest two parts, rounded down."""
    bounds = sorted(
        (core.box_gap(part_a.bounds, part_b.bounds), i, j)
        for i, part_a in enumerate(a.parts)
        for j, part_b in enumerate(b.parts)
    )
    nearest = math.inf
    for least, i, j in bounds:
        if least >= nearest:
            break
        result = core.check_pair(a.parts[i].shape, b.parts[j].shape, query="distance")
        if result.outcome != "separated" or result.lower is None:
            return 0.0
        nearest = min(nearest, result.lower)
    boxes = [part.bounds for part in (*a.parts, *b.parts)]
    return max(nearest - rounding_pad(largest_coordinate(*boxes)), 0.0)
