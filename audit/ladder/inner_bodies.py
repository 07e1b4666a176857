"""The lower bound of a depth from convex parts, for `--accuracy parts`.

A translation that frees A also frees every convex body inside A from every convex body inside B. So
the depth of the deepest such pair is a proven lower bound of the depth. The bodies are shrunken
copies of convex parts (satcheck.decompose), each proven to lie inside its mesh.
"""

from __future__ import annotations

from satcheck import core
from satcheck.audit.bodies.boxes import box_escape, largest_coordinate
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.parts import Part, inner_parts, split_together
from satcheck.audit.request.trace import Trace
from satcheck.core.rounding import rounding_pad


def depth_of_parts(pair: Pair, trace: Trace) -> float:
    """A proven lower bound of the depth, world units, by the inner parts of the bodies."""
    split_together(pair)
    bodies = [inner_parts(body, trace) for body in (pair.a, pair.b)]
    counts = f"{len(bodies[0])} and {len(bodies[1])} inner parts"
    if not (bodies[0] and bodies[1]):
        trace.record("parts", "failed", counts)
        return 0.0
    deepest = deepest_pair(bodies[0], bodies[1])
    trace.record("parts", "lower bound", f"at least {deepest:.6g} by {counts}")
    return deepest


def deepest_pair(parts_a: list[Part], parts_b: list[Part]) -> float:
    """A lower bound of the depth of the deepest pair, rounded down; 0.0: a body has no inner part,
    or no inner parts overlap.

    Pairs are tried in the order of the overlap of their boxes, which is an upper bound of the
    depth. The search ends when that bound is below the deepest pair so far.
    """
    bounds = [
        (box_escape(part_a.bounds, part_b.bounds)[0], i, j)
        for i, part_a in enumerate(parts_a)
        for j, part_b in enumerate(parts_b)
    ]
    bounds.sort(key=lambda bound: (-bound[0], bound[1], bound[2]))
    deepest = 0.0
    for most, i, j in bounds:
        if most <= deepest:
            break
        result = core.check_pair(parts_a[i].shape, parts_b[j].shape, query="depth")
        if result.outcome == "penetrating" and result.upper is not None:
            deepest = max(deepest, -result.upper)
    if deepest == 0.0:
        return 0.0
    boxes = [part.bounds for part in (*parts_a, *parts_b)]
    return max(deepest - rounding_pad(largest_coordinate(*boxes)), 0.0)
