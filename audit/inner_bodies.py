"""Convex bodies proven to lie inside a solid, and the lower bound of a depth that they give.

Any translation that frees A also frees every convex body inside A from every one inside B, so the
deepest such pair is a proven lower bound of the depth.

One inner body is cheap: when the surface lies at most e below its hull, no surface point is deeper
than e in the hull, so the part of the hull deeper than e is all inside or all outside the mesh, and
the winding number of one of its points says which. The hull shrunk about a point c at depth r, by
1 - e / r, lies in that part: a face at distance h >= r from c moves in by e * h / r >= e. (Taking
e off the depth of the hulls would not do: near a sharp edge the eroded hull recedes by more.)
Where that is not enough the mesh is split into convex parts (satcheck.decompose), and their
shrunken copies, proven inside, take its place.
"""

from __future__ import annotations

from satcheck import core
from satcheck.audit.boxes import box_escape, diagonal, largest_coordinate
from satcheck.audit.pair import Pair
from satcheck.audit.parts import Part, inner_parts, split_together
from satcheck.audit.placed_body import PlacedBody
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector
from satcheck.audit.tolerances import rounding_pad


def depth_of_hulls(pair: Pair, plan: Plan) -> float:
    """A proven lower bound of the depth, world units, by one inner body each; 0.0 without them."""
    if not pair.both_solid:
        return 0.0
    inner_a, inner_b = shrunken_hull(pair.a), shrunken_hull(pair.b)
    if inner_a is None or inner_b is None:
        return 0.0
    lower = deepest_pair([inner_a], [inner_b])
    plan.record("depth", "lower bound", f"at least {lower:.6g} by hulls shrunk into the meshes")
    return lower


def depth_of_parts(pair: Pair, plan: Plan) -> float:
    """The same by the inner parts of the decomposed bodies."""
    split_together(pair)
    bodies = [inner_parts(body, plan) for body in (pair.a, pair.b)]
    counts = f"{len(bodies[0])} and {len(bodies[1])} inner parts"
    if not (bodies[0] and bodies[1]):
        plan.record("parts", "failed", counts)
        return 0.0
    deepest = deepest_pair(bodies[0], bodies[1])
    plan.record("parts", "lower bound", f"at least {deepest:.6g} by {counts}")
    return deepest


def shrunken_hull(body: PlacedBody) -> Part | None:
    """The hull of a nearly convex solid, shrunk until it lies inside; None where that fails."""
    if body.convex:
        return Part(body.hull_shape(), body.bounds)
    defect = body.defect()
    if defect >= diagonal(body.bounds):
        return None
    hull = body.hull().to_mesh()
    centre, depth = _deep_point(body, hull)
    defect += rounding_pad(largest_coordinate(body.bounds))
    if depth <= defect or not body.surface().winding_number(centre):
        return None
    factor = 1 - defect / depth
    rows = [
        [factor if row == column else 0.0 for column in range(3)] + [(1 - factor) * centre[row]]
        for row in range(3)
    ]
    shrunk = hull.transformed((*rows[0], *rows[1], *rows[2], 0.0, 0.0, 0.0, 1.0))
    return Part(core.Hull(shrunk.convex_hull()), shrunk.bounds)


def _deep_point(body: PlacedBody, hull: core.Mesh) -> tuple[Vector, float]:
    """A point inside the hull and a lower bound of its depth: the deeper of two cheap guesses."""
    import numpy as np

    low, high = body.bounds
    mean = hull.vertices.mean(axis=0)
    guesses: tuple[Vector, ...] = (
        (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])),
        (float(mean[0]), float(mean[1]), float(mean[2])),
    )
    best, deepest = guesses[1], 0.0
    for point in guesses:
        result = core.check_pair(core.Hull(np.array([point])), body.hull_shape(), query="depth")
        if result.outcome == "penetrating" and -(result.upper or 0.0) > deepest:
            best, deepest = point, -(result.upper or 0.0)
    return best, deepest


def deepest_pair(parts_a: list[Part], parts_b: list[Part]) -> float:
    """A lower bound of the depth of the deepest pair, a rounding below it.

    Pairs are tried by how deep their boxes overlap, which bounds their depth from above; the rest
    is skipped as soon as that bound falls below the deepest pair found.
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
    boxes = [part.bounds for part in (*parts_a, *parts_b)]
    return max(deepest - rounding_pad(largest_coordinate(*boxes)), 0.0)
