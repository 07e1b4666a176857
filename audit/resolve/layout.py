"""The bodies of a scene at their current translations, and the states of their pairs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck import core
from satcheck.audit.bodies import place
from satcheck.audit.body import PlacedBody
from satcheck.audit.draft import Draft
from satcheck.audit.finding import examine
from satcheck.audit.pair import Pair
from satcheck.audit.parallel import in_parallel
from satcheck.audit.planner import Planner
from satcheck.audit.resolve.pair_state import PairState, state_of
from satcheck.audit.settings import Settings
from satcheck.audit.vectors import added, scaled
from satcheck.core.conventions import Vector
from satcheck.scene.bodies import IDENTITY

if TYPE_CHECKING:
    from satcheck.core.overlap_volume import VolumeMeter
    from satcheck.scene import Body, Scene

BodyPair = tuple[int, int]

ORIGIN: Vector = (0.0, 0.0, 0.0)
# Seconds of a slow machine that all ways out of a round may take together, and the least for one.
ROUND_BUDGET = 4.0
LEAST_BUDGET = 0.006
# Bodies may end farther out than any body of the scene, and half spaces still have to hold them.
ROOM = 8.0


class Layout:
    """The index of a body is its rank among the sorted ids, and a pair is (i, j) with i < j, so the
    order of the scene does not matter.

    home: bodies as the scene places them. placed: bodies now, moved by `offsets`. movable: the
    bodies that may be moved.
    """

    def __init__(
        self,
        scene: Scene,
        settings: Settings,
        staying: frozenset[str],
        meter: VolumeMeter | None = None,
    ) -> None:
        """settings: they ask for the depth. meter: needed where rules limit the volume of
        overlaps."""
        self._meter = meter
        self._bodies = place(scene.reaching(ROOM), settings)
        self._planner = Planner(settings, self._bodies.book, scene.composed)
        self._index = sorted(self._bodies.placed, key=self._bodies.ids.__getitem__)
        self.home = [self._bodies.placed[index] for index in self._index]
        self.placed = list(self.home)
        self.movable = frozenset(i for i, body in enumerate(self.home) if body.id not in staying)
        self.offsets = [ORIGIN] * len(self.home)
        self._known: dict[BodyPair, tuple[PlacedBody, PlacedBody, PairState]] = {}
        share = max(LEAST_BUDGET, ROUND_BUDGET / max(len(self.close_pairs()), 1))
        self.settings = replace(settings, budget=min(settings.budget, share))

    def move(self, offsets: dict[int, Vector]) -> None:
        """Put these bodies at these translations from home."""
        for i, offset in offsets.items():
            home = self.home[i]
            self.offsets[i] = offset
            self.placed[i] = PlacedBody(translated(home.body, offset), home.shared)

    def offset(self, pair: BodyPair) -> Vector:
        """t_a - t_b."""
        return added(self.offsets[pair[0]], scaled(self.offsets[pair[1]], -1.0))

    def clearance(self, pair: BodyPair) -> float:
        return self._planner.request(*self._members(pair)).clearance or 0.0

    def is_checked(self, pair: BodyPair) -> bool:
        return self._bodies.book.is_checked(*self._members(pair))

    def _members(self, pair: BodyPair) -> tuple[int, int]:
        """In the order of the scene."""
        i, j = sorted(self._index[body] for body in pair)
        return i, j

    def close_pairs(self) -> list[BodyPair]:
        """Checked pairs whose boxes are close enough to matter."""
        reach = self._planner.reach(
            {index: body.resolution for index, body in zip(self._index, self.placed, strict=True)}
        )
        boxes = [body.bounds for body in self.placed]
        close = core.ClosePairs(boxes, reach, [0] * len(boxes)).take()
        return [pair for pair in close if self.is_checked(pair)]

    def states(self, pairs: Sequence[BodyPair]) -> dict[BodyPair, PairState]:
        """The states of pairs at the current places. Pairs that did not move are not checked
        again."""
        stale = [pair for pair in pairs if not self._is_known(pair)]
        threads = min(self.settings.jobs or os.cpu_count() or 1, len(stale))
        found = in_parallel(self._state, stale, threads) if threads > 1 else map(self._state, stale)
        for pair, state in zip(stale, found, strict=True):
            self._known[pair] = (self.placed[pair[0]], self.placed[pair[1]], state)
        return {pair: self._known[pair][2] for pair in pairs}

    def _is_known(self, pair: BodyPair) -> bool:
        known = self._known.get(pair)
        return known is not None and all(known[k] is self.placed[pair[k]] for k in range(2))

    def _state(self, pair: BodyPair) -> PairState:
        """A failure makes the pair undecided, so that the others are still resolved. The final
        check reports it."""
        try:
            return self._judged(pair)
        except Exception:  # noqa: BLE001 as in a check
            return PairState("undecided")

    def _judged(self, pair: BodyPair) -> PairState:
        """At home, and for excused pairs, the touch band of a check applies. Elsewhere it does not,
        because moved bodies must be free."""
        known = self._known.get(pair)
        request = self._planner.request(*self._members(pair))
        a, b = (self.placed[i] for i in pair)
        strict = Pair(a, b, self.settings, replace(request, tolerance=0.0), self._meter)
        at_home = known is None and all(self.offsets[i] == ORIGIN for i in pair)
        banded = at_home or (known is not None and known[2].excused)
        asked = replace(strict, request=request) if banded else strict
        return state_of(strict, examine(Draft(asked)), banded=banded)


def translated(body: Body, offset: Vector) -> Body:
    """The body, moved in the world; each entry of its placement is rounded once."""
    transform = list(body.transform or IDENTITY)
    for row in range(3):
        transform[4 * row + 3] += offset[row]
    return replace(body, transform=tuple(transform))
