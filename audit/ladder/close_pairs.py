"""The pairs whose world boxes are close enough for the ladder.

The core does the search. This module prepares it: how far each body reaches, and which pairs the
scene exempts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from satcheck import core
from satcheck.audit.bodies.placed_bodies import PlacedBodies
from satcheck.audit.request.planner import Planner
from satcheck.core.conventions import Bounds

IndexPair = tuple[int, int]


def close_pairs(
    bodies: PlacedBodies, planner: Planner, swept: Callable[[str, Bounds], Bounds] | None = None
) -> list[IndexPair]:
    """Pairs of placed bodies to check, sorted, whose boxes are close enough to matter.

    swept: the world box of a body over its whole motion, from its id and its box as placed.
    """
    index, book = tuple(bodies.placed), bodies.book
    place = {body: k for k, body in enumerate(index)}
    boxes = {k: body.bounds for k, body in bodies.placed.items()}
    if swept is not None:
        boxes = {k: swept(bodies.ids[k], box) for k, box in boxes.items()}
    close = core.close_pairs(
        list(boxes.values()),
        planner.reach({k: body.resolution for k, body in bodies.placed.items()}),
        [book.kind_of[i] for i in index],
        book.exempt_kinds(),
        _among(book.exempt_named(), place),
    )
    pairs = close if len(index) == len(bodies.ids) else [(index[i], index[j]) for i, j in close]
    if len(set(bodies.units.values())) > 1:
        pairs = [pair for pair in pairs if bodies.is_comparable(*pair)]
    if endless := {(i, j) for i, j, _ in bodies.endless_pairs()}:
        pairs = [pair for pair in pairs if pair not in endless]
    if not book.rules:
        return pairs
    requested = [pair for pair in pairs if book.is_checked(*pair)]
    return (
        _within_own_gaps(bodies, boxes, planner, requested) if planner.lengths_differ else requested
    )


def _among(pairs: Iterable[IndexPair], place: dict[int, int]) -> list[IndexPair]:
    return [(place[i], place[j]) for i, j in pairs if i in place and j in place]


def _within_own_gaps(
    bodies: PlacedBodies, boxes: Mapping[int, Bounds], planner: Planner, pairs: list[IndexPair]
) -> list[IndexPair]:
    """Drops pairs beyond their own gap. The broad phase used the largest gap of each body."""
    placed = bodies.placed
    return [
        (i, j)
        for i, j in pairs
        if core.box_gap(boxes[i], boxes[j])
        <= planner.gap_limit(i, j, placed[i].resolution + placed[j].resolution)
    ]
