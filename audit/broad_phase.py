"""Which asked pairs have world boxes close enough to be looked at.

The search is that of the core; here its question is put: how far each body reaches, and what the
scene exempts, so that no exempt pair is ever made.
"""

from __future__ import annotations

from collections.abc import Iterable

from satcheck import core
from satcheck.audit.roster import Roster, kinds_of
from satcheck.audit.settings import Settings

IndexPair = tuple[int, int]


def close_pairs(roster: Roster, settings: Settings) -> list[IndexPair]:
    """Asked pairs of placed bodies, sorted, no further apart by their boxes than is asked about."""
    index = tuple(roster.placed)
    place = {body: k for k, body in enumerate(index)}
    kinds, exempt_kinds = kinds_of([roster.ignored_of[i] for i in index])
    found = core.close_pairs(
        [body.bounds for body in roster.placed.values()],
        _reach(roster, settings),
        kinds,
        exempt_kinds,
        _among(roster.allowed_pairs(), place),
    )
    return found if len(index) == len(roster.ids) else [(index[i], index[j]) for i, j in found]


def _reach(roster: Roster, settings: Settings) -> list[float]:
    """Lengths of which two add up to what is asked about the pair, at least."""
    half_clearance = 0.5 * (settings.clearance or 0.0)
    if settings.tolerance is not None:
        return [max(half_clearance, 0.5 * settings.tolerance)] * len(roster.placed)
    return [max(half_clearance, body.resolution) for body in roster.placed.values()]


def _among(pairs: Iterable[IndexPair], place: dict[int, int]) -> list[IndexPair]:
    return [(place[i], place[j]) for i, j in pairs if i in place and j in place]
