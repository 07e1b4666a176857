"""The results of the rungs of a climb in words: the first stages of the trace of a pair."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from satcheck.report.report import Stage

if TYPE_CHECKING:
    from satcheck import core

_UNTURNED = "neither placement turns: oriented boxes are the world boxes"
_SHEARED = "a transform shears: the carried box is no box"
_NOT_CONVEX = "not both convex: hulls prove only separation"
# The axis of least overlap, or the axis that separates, by the features that it is made of.
_AXES = {
    "face-a": "a face normal of A",
    "face-b": "a face normal of B",
    "edge-edge": "an edge of A across one of B",
}


def rungs_of(climb: core.Climb) -> list[Stage]:
    """Return the rungs that ran, in their order, without the touch band and the gap."""
    hulls, triangles = climb.hulls, climb.triangles
    rungs: list[tuple[int, str, str, str]] = []
    if climb.boxes or (hulls is None and triangles is None):  # else the climb began above them
        rungs.append((0, "aabb", *_world_boxes(climb.box_gap)))
    if climb.boxes:
        rungs.append((1, "obb", *_oriented_boxes(climb)))
    if hulls is not None:
        rungs.append((2, "hull", *_hulls(climb, hulls)))
    if climb.nesting is not None:
        rungs.append((3, "containment", climb.nesting, "one world box holds the other"))
    if triangles is not None:
        rungs.append((4, "triangles", *_triangles(triangles)))
    cost = climb.nanoseconds
    return [Stage(rung, result, cost[k] / 1000.0, detail) for k, rung, result, detail in rungs]


def _world_boxes(gap: float) -> tuple[str, str]:
    if gap > 0:
        return "separated", f"world boxes apart by at least {gap:.6g}"
    return "meet", "world boxes meet"


def _oriented_boxes(climb: core.Climb) -> tuple[str, str]:
    match climb.boxes:
        case "apart":
            return "separated", _separating_axis(*climb.box_axis)
        case "sheared":
            return "skipped", _SHEARED
        case "unturned":
            return "skipped", _UNTURNED
    return "meet", "sat: none of 15 axes separates"


def _separating_axis(feature: str, a: int, b: int, tested: int) -> str:
    names = [f"{'xyz'[k]} of {body}" for k, body in ((a, "A"), (b, "B")) if k >= 0]
    axis = " across ".join(f"edge {name}" for name in names)
    if feature != "edge-edge":
        axis = f"face normal {names[0]}"
    return f"sat: {axis} separates, {tested} of 15 axes tested"


def _hulls(climb: core.Climb, hulls: core.PairResult) -> tuple[str, str]:
    if climb.both_convex:
        return hulls.outcome, f"both convex: {_method(hulls)}"
    if hulls.outcome == "separated":
        gap = max(hulls.lower or 0.0, climb.box_gap)
        return "separated", f"hulls apart by at least {gap:.6g}"
    return "undecided" if hulls.outcome == "undecided" else "meet", _NOT_CONVEX


def _method(hulls: core.PairResult) -> str:
    if hulls.feature not in _AXES:
        return f"{hulls.method} {hulls.feature}"
    axes = f"sat, {hulls.axes_tested} axes, least along {_AXES[hulls.feature]}"
    return f"{axes}: exact signs" if hulls.method == "exact" else axes


def _triangles(triangles: core.MeshRelation) -> tuple[str, str]:
    if not triangles.decided:
        return "undecided", "too many steps"
    return triangles.relation, ", ".join(_tests(triangles))


def _tests(triangles: core.MeshRelation) -> Iterator[str]:
    if triangles.edge_tests is None:
        yield f"{triangles.box_tests} box tests, {triangles.triangle_tests} triangle tests"
    else:
        yield f"{triangles.edge_tests} tests of edges of the outlines"
    if triangles.triangle_a >= 0 and triangles.triangle_b >= 0:
        yield f"triangles {triangles.triangle_a} and {triangles.triangle_b} meet"
    if not triangles.proven:
        yield "sampled in a degenerate contact"
