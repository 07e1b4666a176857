"""What surfaces alone cannot show: whether a body lies inside one that has no inside.

Surfaces that do not cross prove nothing about a body that another one may enclose, when that other
one is open, say: its inside is not defined, so it was not checked. That must not read as a pass.
"""

from __future__ import annotations

from satcheck.audit.bodies.boxes import Box, holds
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.figures.verify import FREE
from satcheck.audit.ladder.ladder import Contact


def unseen_inside(pair: Pair, contact: Contact) -> str | None:
    """A sentence about the inside that was not checked; None where containment is impossible:
    hulls apart, boxes that do not nest, an enclosing body that is a solid or flat."""
    unknown = not contact.proven and not pair.curved  # a curved touch is one by its bounds alone
    if contact.relation not in FREE or unknown or contact.gap_lower > 0:
        return None
    return _unseen(pair, 0.0)


def unseen_way_out(pair: Pair, length: float) -> str | None:
    """The same of an overlap that passes because a translation of this length, in whatever
    direction, leaves surfaces that do not cross: it may lead into the other body."""
    return _unseen(pair, length)


def _unseen(pair: Pair, margin: float) -> str | None:
    for outer, inner in ((pair.a, pair.b), (pair.b, pair.a)):
        if outer.solid or outer.body.file.health.flat:
            continue
        low, high = outer.bounds
        reach = (
            (low[0] - margin, low[1] - margin, low[2] - margin),
            (high[0] + margin, high[1] + margin, high[2] + margin),
        )
        if holds(reach, _within(inner)):
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
