"""Lets floating bodies fall, along gravity and without turning, until they lie on something.

Bodies that touch each other fall together. The lowest fall first, so that the others can come to
lie on them. Conservative advancement (`audit/motion`) finds the first contact on the way, and skips
none.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from msgspec import Struct
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_bodies import place
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.figures.escape import FREE
from satcheck.audit.finding import examine
from satcheck.audit.motion.impact import first_impact
from satcheck.audit.motion.moving_pair import MovingPair, Unanswerable
from satcheck.audit.motion.track import STANDS, track_of
from satcheck.audit.request.planner import request_for
from satcheck.audit.request.settings import Settings
from satcheck.audit.request.trace import Trace
from satcheck.audit.resolve.layout import translated
from satcheck.audit.statics.graph import Graph, graph_of
from satcheck.audit.statics.subjects import subjects_of
from satcheck.audit.statics.terms import terms_for
from satcheck.audit.statics.touching import contacts_of
from satcheck.core import box_gap
from satcheck.core.conventions import Vector
from satcheck.core.errors import SatcheckError
from satcheck.report.resolution import Drop
from satcheck.scene import Scene
from satcheck.scene.motion import Translation
from satcheck.scene.statics import terms_of

Floats = NDArray[np.float64]

NOTHING_BELOW = "nothing is below it"
STAYS = "it is pinned, or touches a body that is"
TOO_FAR = "it would move farther than the longest motion"
NOT_DECIDED = "where it would land is not decided"
# A fall is rounded to fewer digits if that changes it by at most this share of the tolerance.
PLAIN = 1e-6
DIGITS = range(2, 10)
# A body that lands may show that another one floats only now. So often, at most, all are looked at.
MOST_PASSES = 20


class _Landing(Struct, frozen=True):
    """How far an island falls, and onto which subject. onto: None: it does not land; reason says
    why."""

    length: float
    onto: int | None
    reason: str | None = None


def drop(
    scene: Scene, settings: Settings, staying: frozenset[str], longest: float = math.inf
) -> tuple[dict[str, Vector], list[Drop]]:
    """(id -> translation, what happened to each floating body). staying: ids of bodies that are not
    moved. longest: no body falls farther. Raises SatcheckError `nothing-fixed` if no body is static
    or mounted."""
    falling = _Falling(scene, settings, staying, longest)
    for _ in range(MOST_PASSES):
        if not falling.let_fall():
            break
    return falling.translations(), falling.drops()


class _Falling:
    def __init__(
        self, scene: Scene, settings: Settings, staying: frozenset[str], longest: float
    ) -> None:
        bodies = place(scene, settings)
        everything = terms_of(scene.in_order(), scene.body_rules)
        material = [k for k in bodies.placed if not everything[k].value("region")]
        self._book = bodies.book
        self._index = material
        self._subjects = subjects_of(
            [bodies.placed[k] for k in material], [everything[k] for k in material]
        )
        if all(subject.fixed is None for subject in self._subjects):
            message = "no body is static or mounted, so nothing can hold the others"
            raise SatcheckError("nothing-fixed", f"{message}: call the floor static")
        free = [subject.body for subject in self._subjects if subject.fixed is None]
        terms = terms_for(scene, free)
        self._down = np.array(terms.gravity)
        self._tolerance, self._settings = terms.tolerance, settings
        self._staying, self._longest = staying, longest
        self._alone = not bodies.unusable
        self._home = [subject.body for subject in self._subjects]
        self._fallen = np.zeros(len(self._subjects))
        self._landed: dict[int, _Landing] = {}

    def let_fall(self) -> bool:
        """Moves every floating island once. Whether any of them moved."""
        graph = self._graph()
        floating = [
            members for members in graph.islands if all(graph.floating[k] == "yes" for k in members)
        ]
        moved = False
        for members in sorted(floating, key=lambda members: -max(map(self._lowest, members))):
            landing = self._landing(members)
            if landing.onto is not None:
                moved = moved or landing.length > 0
                self._move(members, self._plain(members, landing.length))
            for k in members:
                self._landed[k] = landing
        return moved

    def _graph(self) -> Graph:
        contacts, _ = contacts_of(self._subjects, self._tolerance, self._settings)
        return graph_of(self._subjects, contacts, alone=self._alone)

    def _lowest(self, k: int) -> float:
        """How far the box of the body reaches down."""
        low, high = (np.array(end) for end in self._subjects[k].body.bounds)
        return float(np.maximum(self._down * low, self._down * high).sum())

    def _landing(self, members: Sequence[int]) -> _Landing:
        if any(self._subjects[k].id in self._staying for k in members):
            return _Landing(0.0, None, STAYS)
        bottom = max(map(self._lowest, range(len(self._subjects))))
        nearest = _Landing(math.inf, None, NOTHING_BELOW)
        for k in members:
            for other in self._below(k, members, bottom - self._height(k)):
                length = self._free_way(k, other, bottom - self._height(k))
                if isinstance(length, str):
                    return _Landing(0.0, None, f"{NOT_DECIDED}: {length}")
                if length < nearest.length:
                    nearest = _Landing(length, other)
        if nearest.onto is not None and self._fallen[members[0]] + nearest.length > self._longest:
            return _Landing(0.0, None, TOO_FAR)
        return nearest

    def _plain(self, members: Sequence[int], length: float) -> float:
        """The length with the fewest digits at which the bodies are still free of what stops
        them."""
        for digits in DIGITS:
            plain = round(length, digits)
            near = abs(plain - length) <= PLAIN * self._tolerance
            if near and plain > 0 and self._is_free(members, plain):
                return plain
        return length

    def _is_free(self, members: Sequence[int], length: float) -> bool:
        exactly = replace(self._settings, tolerance=0.0, depth=False)
        request = request_for(exactly, composed=True)
        others = [other for other in range(len(self._subjects)) if other not in members]
        for k in members:
            body = self._moved(k, self._fallen[k] + length)
            for other in others:
                obstacle = self._subjects[other].body
                apart = box_gap(body.bounds, obstacle.bounds) > 0
                if not apart and self._is_checked(k, other):
                    finding = examine(Pair(body, obstacle, exactly, request), Trace()).finding
                    if finding.exact_relation not in FREE:
                        return False
        return True

    def _height(self, k: int) -> float:
        """Where the box of the body begins, along gravity."""
        low, high = (np.array(end) for end in self._subjects[k].body.bounds)
        return float(np.minimum(self._down * low, self._down * high).sum())

    def _below(self, k: int, members: Sequence[int], way: float) -> Iterator[int]:
        """Bodies that the box of the body meets on its way."""
        low, high = (np.array(end) for end in self._subjects[k].body.bounds)
        step = self._down * way
        low, high = np.minimum(low, low + step), np.maximum(high, high + step)
        for other, subject in enumerate(self._subjects):
            other_low, other_high = subject.body.bounds
            meets = (low <= np.array(other_high)).all() and (high >= np.array(other_low)).all()
            if meets and other not in members and self._is_checked(k, other):
                yield other

    def _is_checked(self, k: int, other: int) -> bool:
        """Pairs that the scene allows may overlap: a body falls through the other one."""
        i, j = sorted((self._index[k], self._index[other]))
        return self._book.is_checked(i, j)

    def _free_way(self, k: int, other: int, way: float) -> float | str:
        """How far a body falls before it overlaps with another one: inf, if it does not; or why
        that is not decided."""
        request = request_for(self._settings, composed=True)
        pair = Pair(self._subjects[k].body, self._subjects[other].body, self._settings, request)
        x, y, z = (self._down * way).tolist()
        try:
            impact = first_impact(MovingPair(pair, track_of(Translation((x, y, z))), STANDS))
        except Unanswerable as why:
            return str(why)
        if impact.upper is not None:
            return impact.lower * way
        return math.inf if impact.reason is None else impact.reason

    def _move(self, members: Sequence[int], length: float) -> None:
        for k in members:
            self._fallen[k] += length
            body = self._moved(k, self._fallen[k])
            (self._subjects[k],) = subjects_of([body], [self._subjects[k].terms])

    def _moved(self, k: int, length: float) -> PlacedBody:
        x, y, z = (self._down * length).tolist()
        home = self._home[k]
        return PlacedBody(translated(home.body, (x, y, z)), home.shared)

    def translations(self) -> dict[str, Vector]:
        moves = {}
        for subject, length in zip(self._subjects, self._fallen, strict=True):
            if length > 0:
                x, y, z = (self._down * length).tolist()
                moves[subject.id] = (x, y, z)
        return moves

    def drops(self) -> list[Drop]:
        return [
            Drop(
                body=self._subjects[k].id,
                length=float(self._fallen[k]),
                onto=None if landing.onto is None else self._subjects[landing.onto].id,
                reason=landing.reason,
            )
            for k, landing in sorted(self._landed.items())
        ]
