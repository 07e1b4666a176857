"""Checks in a plane, where bodies are prisms of one height."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from satcheck import core
from satcheck.audit.boxes import Box
from satcheck.audit.pair import Pair
from satcheck.audit.placed_body import PlacedBody
from satcheck.audit.plan import Plan
from satcheck.core.conventions import Plane, axes_of, axis_across

if TYPE_CHECKING:
    from satcheck.audit.ladder import Contact


def refine_nesting(pair: Pair, contact: Contact, plane: Plane, plan: Plan) -> Contact:
    """`contains` and `inside` where an outline lies within the other.

    The prisms share the planes of their ends, so as solids their surfaces always meet. Where the
    outer one is made to stick out at both ends, only the walls can meet.
    """
    if contact.relation != "penetrating":
        return contact
    if _holds(pair.a.bounds, pair.b.bounds, plane):
        found = core.mesh_relation(_longer(pair.a, plane), pair.b.surface()).relation
        if found == "contains":
            plan.record("containment", found, "the outline of B lies within that of A")
            return replace(contact, relation="contains")
    if _holds(pair.b.bounds, pair.a.bounds, plane):
        found = core.mesh_relation(pair.a.surface(), _longer(pair.b, plane)).relation
        if found == "inside":
            plan.record("containment", found, "the outline of A lies within that of B")
            return replace(contact, relation="inside")
    return contact


def _holds(outer: Box, inner: Box, plane: Plane) -> bool:
    return all(
        outer[0][axis] <= inner[0][axis] and inner[1][axis] <= outer[1][axis]
        for axis in axes_of(plane)
    )


def _longer(body: PlacedBody, plane: Plane) -> core.Surface:
    """Twice as high about its middle, exactly: the height is a power of two."""
    axis = axis_across(plane)
    height = body.bounds[1][axis]
    transform = [float(row == column) for row in range(4) for column in range(4)]
    transform[5 * axis], transform[4 * axis + 3] = 2.0, -0.5 * height
    return core.Surface(body.mesh.transformed(transform), body.solid)
