"""Calls of the ladder in the core: the request for one pair, and for many pairs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Literal

from satcheck import core
from satcheck.report.report import OVERLAPS

if TYPE_CHECKING:
    from satcheck.audit.pair import Pair
    from satcheck.audit.settings import Accuracy
    from satcheck.report.report import Effect

    Request = tuple[core.PlacedGeometry, core.PlacedGeometry, float, float, float, float, bool]
    Rung = Literal["aabb", "obb", "hull", "triangles"]

# The last rung that the core climbs for each --accuracy. The core has no parts.
LAST: dict[Accuracy, Rung] = {
    "aabb": "aabb",
    "obb": "obb",
    "hull": "hull",
    "parts": "hull",
    "exact": "triangles",
}
# Effects that are computed after the ladder for every verdict.
_EXTRAS: frozenset[Effect] = frozenset(
    ("volume", "contacts", "components", "cross-check", "certificate", "sweep")
)


def climb_pair(pair: Pair, first: Rung = "aabb", last: Rung | None = None) -> core.Climb:
    """Climbs with one pair from `first` to `last`, by default as far as the settings allow. Raises
    what making its bodies raises."""
    last = last or LAST[pair.settings.accuracy]
    if pair.curved:
        last = "aabb"
    return core.climb(_request(pair), first, last, pair.settings.method)


def start_climbs(pairs: Sequence[Pair], threads: int) -> Callable[[], list[core.Climb | None]]:
    """Starts the climbs of pairs with the same settings on `threads` threads; 0: one a core. The
    returned function waits for the results.

    A result is None if the climb failed, or if the pair has other steps; settle() then climbs
    again.
    """
    plain = [k for k, pair in enumerate(pairs) if not pair.curved]
    last = LAST[pairs[0].settings.accuracy]
    alone = len(pairs) == 1 and pairs[0].alone
    climbing = core.Climbing(
        [_request(pairs[k]) for k in plain], last, threads, alone, pairs[0].settings.method
    )
    if len(plain) == len(pairs):
        return climbing.results

    def results() -> list[core.Climb | None]:
        climbs = dict(zip(plain, climbing.results(), strict=True))
        return [climbs.get(k) for k in range(len(pairs))]

    return results


def leaves_work(pair: Pair, climb: core.Climb | None) -> bool:
    """Whether the pair needs computation after the climb."""
    if climb is None or pair.settings.accuracy == "parts" or pair.paths is not None:
        return True
    if climb.band in ("open", "hidden") or climb.thick is False:
        return True
    if not _EXTRAS.isdisjoint(pair.request.by):
        return True
    return "depth" in pair.request.by and climb.relation in OVERLAPS


def _request(pair: Pair) -> Request:
    a, b = pair.a.geometry, pair.b.geometry
    return a, b, pair.gap_limit, pair.tolerance, *pair.off, pair.wants_distance
