"""The bodies of a scene at their current translations, and the states of their pairs."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck import core
from satcheck.audit.bodies.boxes import Box
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_bodies import place
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.finding import examine
from satcheck.audit.parallel import in_parallel
from satcheck.audit.request.planner import Planner
from satcheck.audit.request.settings import Settings
from satcheck.audit.request.trace import Trace
from satcheck.audit.resolve.pair_state import PairState, is_objected, is_overlap_excused, state_of
from satcheck.audit.resolve.walls import ORIGIN, BodyPair
from satcheck.audit.vectors import added, dot, scaled
from satcheck.core.conventions import Vector
from satcheck.scene.bodies import IDENTITY

if TYPE_CHECKING:
    from satcheck.core.overlap_volume import VolumeMeter
    from satcheck.scene import Body, Scene

# The relative width of the depth interval if there are many overlaps. A way out that is a few per
# cent too long is shortened later.
WAY_OUT_WIDTH = 0.25
WAY_OUT_BUDGET = 0.006
# Seconds of a slow machine that the ways out of few overlaps may take together.
CAREFUL_BUDGET = 4.0


class Layout:
    """The index of a body is its rank among the sorted ids, and a pair is (i, j) with i < j, so the
    order of the scene does not matter.

    home: bodies as the scene places them. placed: bodies now, moved by `offsets`. movable: the
    bodies that may be moved. settings: for the ways out. careful: few bodies overlap, so each gets
    more time.
    """

    def __init__(
        self,
        scene: Scene,
        settings: Settings,
        staying: frozenset[str],
        meter: VolumeMeter | None = None,
    ) -> None:
        """meter: needed where rules limit the volume of overlaps."""
        # The verdicts of a check, and a way out for every overlap.
        self._own, self._meter = settings, meter
        self.settings = replace(
            settings,
            depth=True,
            thickness=False,
            depth_width=WAY_OUT_WIDTH,
            depth_budget=WAY_OUT_BUDGET,
            contacts=False,
            components=False,
            volume=False,
            cross_check=False,
            certificate=False,
        )
        self._bodies = place(scene, self.settings)
        self._planner = Planner(self.settings, self._bodies.book, scene.composed)
        self._index = sorted(self._bodies.placed, key=self._bodies.ids.__getitem__)
        self.home = [self._bodies.placed[index] for index in self._index]
        self.placed = list(self.home)
        self.movable = frozenset(i for i, body in enumerate(self.home) if body.id not in staying)
        self.offsets = [ORIGIN] * len(self.home)
        self._excused: set[BodyPair] = set()
        self._known: dict[BodyPair, tuple[PlacedBody, PlacedBody, PairState]] = {}
        self.careful = False
        self.settle()

    def look_closely(self, overlaps: int) -> None:
        """From now on ways out are as short as those of a check, within the budget for this number
        of overlaps. Known ways out are computed again."""
        own, self.careful = self._own, True
        budget = min(own.depth_budget, CAREFUL_BUDGET / max(overlaps, 1))
        self.settings = replace(self.settings, depth_width=own.depth_width, depth_budget=budget)
        self._known = {pair: state for pair, state in self._known.items() if state[2].push is None}

    def move(self, offsets: dict[int, Vector]) -> None:
        """Put these bodies at these translations from home."""
        for i, offset in offsets.items():
            if offset != self.offsets[i]:
                home = self.home[i]
                self.offsets[i] = offset
                self.placed[i] = (
                    home
                    if offset == ORIGIN
                    else PlacedBody(translated(home.body, offset), home.shared)
                )

    def settle(self) -> None:
        """Keeps the known states for `restart`."""
        self._start = dict(self._known), set(self._excused)

    def restart(self) -> None:
        """Moves all bodies home."""
        self.placed, self.offsets = list(self.home), [ORIGIN] * len(self.home)
        self._known, self._excused = dict(self._start[0]), set(self._start[1])

    def squares(self, bodies: Iterable[int] | None = None) -> float:
        """The sum of the squared lengths of the translations of these bodies, by default of all."""
        chosen = self.offsets if bodies is None else [self.offsets[i] for i in bodies]
        return math.fsum(dot(offset, offset) for offset in chosen)

    def offset(self, pair: BodyPair) -> Vector:
        """t_a - t_b."""
        return added(self.offsets[pair[0]], scaled(self.offsets[pair[1]], -1.0))

    def pair(self, pair: BodyPair) -> Pair:
        """Without a touch band."""
        request = replace(self._planner.request(*self._members(pair)), tolerance=0.0)
        return Pair(self.placed[pair[0]], self.placed[pair[1]], self.settings, request, self._meter)

    def pair_after(self, pair: BodyPair, step: Vector) -> Pair:
        """The same pair with the first body moved further by `step`."""
        a, b = self.placed[pair[0]], self.placed[pair[1]]
        moved = PlacedBody(translated(a.body, step), a.shared)
        return Pair(moved, b, self.settings, self.pair(pair).request, self._meter)

    def clearance(self, pair: BodyPair) -> float:
        return self._planner.request(*self._members(pair)).clearance or 0.0

    def is_limited(self, pair: BodyPair) -> bool:
        """Whether the bodies may overlap, within limits."""
        return self._planner.request(*self._members(pair)).limited

    def is_checked(self, pair: BodyPair) -> bool:
        return self._bodies.book.is_checked(*self._members(pair))

    def _members(self, pair: BodyPair) -> tuple[int, int]:
        """In the order of the scene."""
        i, j = sorted(self._index[body] for body in pair)
        return i, j

    def close_pairs(self, boxes: Sequence[Box] | None = None) -> list[BodyPair]:
        """Checked pairs whose boxes (by default those of the bodies) are close enough to matter."""
        around = boxes or [body.bounds for body in self.placed]
        reach = self._planner.reach(
            {index: body.resolution for index, body in zip(self._index, self.placed, strict=True)}
        )
        close = core.close_pairs(around, reach, [0] * len(around))
        return [pair for pair in close if self.is_checked(pair)]

    def states(self, pairs: Sequence[BodyPair]) -> dict[BodyPair, PairState]:
        """The states of pairs at the current places. Pairs that did not move are not checked
        again."""
        unknown = [pair for pair in pairs if not self._is_known(pair)]
        for pair, state in zip(unknown, self._in_parallel(unknown), strict=True):
            self._known[pair] = (self.placed[pair[0]], self.placed[pair[1]], state)
            if state.excused:
                self._excused.add(pair)
            else:
                self._excused.discard(pair)
        return {pair: self._known[pair][2] for pair in pairs}

    def _is_known(self, pair: BodyPair) -> bool:
        known = self._known.get(pair)
        return known is not None and all(known[k] is self.placed[pair[k]] for k in range(2))

    def _in_parallel(self, pairs: Sequence[BodyPair]) -> Iterable[PairState]:
        threads = min(self.settings.jobs or os.cpu_count() or 1, len(pairs))
        if threads <= 1:
            return map(self._state, pairs)
        return in_parallel(self._state, pairs, threads)

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
        at_home = pair not in self._known and all(self.offsets[i] == ORIGIN for i in pair)
        strict = self.pair(pair)
        if at_home or pair in self._excused:
            request = self._planner.request(*self._members(pair))
            finding = examine(replace(strict, request=request), Trace()).finding
            objected = is_objected(finding, self.settings.fail_on)
            if not objected and finding.relation != "indeterminate":
                return PairState("free", excused=is_overlap_excused(finding))
            return state_of(strict, finding)
        return state_of(strict, examine(strict, Trace()).finding)


def translated(body: Body, offset: Vector) -> Body:
    """The body, moved in the world; each entry of its placement is rounded once."""
    transform = list(body.transform or IDENTITY)
    for row in range(3):
        transform[4 * row + 3] += offset[row]
    return replace(body, transform=tuple(transform))
