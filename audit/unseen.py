"""What surfaces alone cannot show: whether a body lies inside one that has no inside.

Surfaces that do not cross prove nothing about a body that another one may enclose, when that other
one is open, say: its inside is not defined, so it was not checked. That must not read as a pass.
"""

from __future__ import annotations

from satcheck.audit.boxes import Box, holds
from satcheck.audit.ladder import Contact
from satcheck.audit.pair import Pair
from satcheck.audit.placed_body import PlacedBody
from satcheck.audit.verify import FREE


def unseen_inside(pair: Pair, contact: Contact) -> str | None:
    """A sentence about the inside that was not checked; None where containment is impossible:
    hulls apart, boxes that do not nest, an enclosing body that is a solid or flat."""
    unknown = not contact.proven and not pair.curved  # a curved touch is one by its bounds alone
    if contact.relation not in FREE or unknown or contact.gap_lower > 0:
        return None
    for outer, inner in ((pair.a, pair.b), (pair.b, pair.a)):
        health = outer.body.file.health
        if not outer.solid and not health.flat and holds(outer.bounds, _within(inner)):
            return f"the inside of {outer.id} was not checked: {_why(outer)}"
    return None


def _within(body: PlacedBody) -> Box:
    """A box that the body fills: that of a curved shape is rounded outward, its mesh is within."""
    return body.bounds if body.curved is None else body.mesh.bounds


def _why(body: PlacedBody) -> str:
    health = body.body.file.health
    if not health.closed:
        return "it is not closed"
    return "it is double-sided" if health.double_sided else "it is no solid"
