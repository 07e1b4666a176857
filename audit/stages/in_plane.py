"""Checks in a plane: each body is a prism whose height exceeds the width of every body."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck import core
from satcheck.audit.body import Box, PlacedBody
from satcheck.audit.draft import Trace
from satcheck.audit.pair import Pair
from satcheck.core.conventions import Plane, axes_of, axis_across
from satcheck.report.report import OVERLAPS, Relation

if TYPE_CHECKING:
    from satcheck.audit.draft import Verdict


def refine_nesting(pair: Pair, verdict: Verdict, plane: Plane, trace: Trace) -> Verdict:
    """Decides `contains`, `inside` and `coincident` by the outlines.

    The prisms have different heights, which mean nothing. A prism that is made taller shows whether
    its outline contains the other. Two prisms of one height show whether the outlines coincide.
    """
    if verdict.relation not in OVERLAPS:
        return verdict
    relation = _nesting(pair.a, pair.b, plane)
    if relation != "penetrating":
        trace.record("containment", relation, "the outlines, as prisms of heights that suit")
    return replace(verdict, relation=relation)


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
