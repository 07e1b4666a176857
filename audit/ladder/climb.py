"""Pairs up the ladder of the core: what it is asked about one of them, and about many."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Literal

from satcheck import core
from satcheck.audit.report.report import OVERLAPS

if TYPE_CHECKING:
    from satcheck.audit.asked.planner import Asked
    from satcheck.audit.asked.settings import Accuracy
    from satcheck.audit.bodies.pair import Pair
    from satcheck.audit.report.report import Effect

    Question = tuple[core.PlacedGeometry, core.PlacedGeometry, float, float, bool]
    Rung = Literal["aabb", "obb", "hull", "triangles"]

# The last rung that the core climbs for each --accuracy; parts are no matter of the core.
LAST: dict[Accuracy, Rung] = {
    "aabb": "aabb",
    "obb": "obb",
    "hull": "hull",
    "parts": "hull",
    "exact": "triangles",
}
# What is computed after the ladder, whatever it found.
_EXTRAS: frozenset[Effect] = frozenset(
    ("volume", "contacts", "cross-check", "certificate", "sweep")
)


def climb(pair: Pair, first: Rung = "aabb", last: Rung | None = None) -> core.Climb:
    """One pair, from this rung on, up to `last` or as far as its settings go. Raises what making
    its bodies raises."""
    last = last or LAST[pair.settings.accuracy]
    if pair.curved:
        last = "aabb"
    elif pair.outlined and first == "aabb" and last != "aabb":
        last = "obb"  # between the boxes and the hulls come the outlines
    return core.climb(_question(pair), first, last)


def start_climbs(pairs: Sequence[Pair], threads: int) -> Callable[[], list[core.Climb | None]]:
    """Many pairs with the same settings, on `threads` threads, 0: one a core. The call waits.

    None for a pair that has to be asked alone: its climb failed, or has steps of its own.
    """
    plain = [k for k, pair in enumerate(pairs) if not (pair.curved or pair.outlined)]
    last = LAST[pairs[0].settings.accuracy]
    alone = len(pairs) == 1 and pairs[0].alone
    climbing = core.Climbing([_question(pairs[k]) for k in plain], last, threads, alone)
    if len(plain) == len(pairs):
        return climbing.found

    def found() -> list[core.Climb | None]:
        among = dict(zip(plain, climbing.found(), strict=True))
        return [among.get(k) for k in range(len(pairs))]

    return found


def leaves_work(pair: Pair, found: core.Climb | None) -> bool:
    """Whether more than words is left to do after the climb."""
    if found is None or pair.settings.accuracy == "parts" or pair.paths is not None:
        return True
    return _is_asked_more(pair.asked, found) or _band_is_open(found)


def _is_asked_more(asked: Asked, found: core.Climb) -> bool:
    if not _EXTRAS.isdisjoint(asked.by):
        return True
    return "depth" in asked.by and _overlaps(found)


def _band_is_open(found: core.Climb) -> bool:
    """Whether a search may follow."""
    way = found.way_within
    return way is not None and way.side in ("open", "hidden")


def _overlaps(found: core.Climb) -> bool:
    if found.triangles is not None:
        return found.triangles.relation in OVERLAPS
    return found.hulls is None or found.hulls.outcome == "penetrating"


def _question(pair: Pair) -> Question:
    a, b = pair.a.geometry, pair.b.geometry
    return a, b, pair.asked_gap, pair.tolerance, pair.wants_distance
