"""The pairs of a scene that are close enough to matter, found block by block as they are needed, so
that a scene in which all bodies are close does not hold all its pairs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import chain, islice

from satcheck import core
from satcheck.audit.bodies import PlacedBodies
from satcheck.audit.planner import Planner
from satcheck.core.conventions import Bounds

IndexPair = tuple[int, int]
Keep = Callable[[int, int], bool]
# Pairs that come from the core together.
TAKEN = 100_000


class ClosePairs:
    """Checked pairs of placed bodies, sorted, whose boxes are close enough.

    swept: the world box of a body over its whole motion. keep: an iteration drops the other pairs.
    """

    def __init__(
        self,
        bodies: PlacedBodies,
        planner: Planner,
        swept: Callable[[str], Bounds] | None = None,
        keep: Keep | None = None,
    ) -> None:
        self._index, book = tuple(bodies.placed), bodies.book
        place = {body: k for k, body in enumerate(self._index)}
        boxes = {k: body.bounds for k, body in bodies.placed.items()}
        if swept is not None:
            boxes = {k: swept(bodies.ids[k]) for k in boxes}
        endless = [(i, j) for i, j, _ in bodies.endless_pairs()]
        exempt = [
            (place[i], place[j])
            for i, j in (*book.exempt_named(), *endless)
            if i in place and j in place
        ]
        self._query = (
            list(boxes.values()),
            planner.reach({k: body.resolution for k, body in bodies.placed.items()}),
            [book.kind_of[i] for i in self._index],
            book.exempt_kinds(),
            exempt,
        )
        self._keeps: list[Keep] = []
        if len(set(bodies.units.values())) > 1:
            self._keeps.append(bodies.is_comparable)
        if book.rules:
            self._keeps.append(book.is_checked)
        if book.rules and planner.lengths_differ:
            self._keeps.append(_within_own_gaps(bodies, boxes, planner))
        if keep is not None:
            self._keeps.append(keep)

    def __iter__(self) -> Iterator[IndexPair]:
        return chain.from_iterable(self._taken(core.ClosePairs(*self._query)))

    def blocks(self, size: int) -> Iterator[list[IndexPair]]:
        """Yield the pairs, so many at a time; at the end fewer."""
        pairs = iter(self)
        return iter(lambda: list(islice(pairs, size)), [])

    def count(self) -> int:
        """Return the number of pairs without a list of them."""
        found = core.ClosePairs(*self._query)
        return sum(map(len, self._taken(found))) if self._keeps else found.count()

    def _taken(self, found: core.ClosePairs) -> Iterator[list[IndexPair]]:
        index = self._index
        is_each = index == tuple(range(len(index)))
        while pairs := found.take(TAKEN):
            if not is_each:
                pairs = [(index[i], index[j]) for i, j in pairs]
            for keep in self._keeps:
                pairs = [pair for pair in pairs if keep(*pair)]
            yield pairs


def _within_own_gaps(bodies: PlacedBodies, boxes: dict[int, Bounds], planner: Planner) -> Keep:
    """Return what drops pairs beyond their own gap: the broad phase uses the largest gap of each
    body."""
    placed = bodies.placed

    def is_within(i: int, j: int) -> bool:
        limit = planner.gap_limit(i, j, placed[i].resolution + placed[j].resolution)
        return core.box_gap(boxes[i], boxes[j]) <= limit

    return is_within
