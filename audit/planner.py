"""The planner makes the `Request` of each pair from the flags of a check and the rules of its
scene. It alone decides which figures are asked for; a stage may measure another to decide a
relation."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache

from msgspec.structs import replace

from satcheck.audit.settings import Settings
from satcheck.core.conventions import LARGEST_LENGTH
from satcheck.report.judge import EXACT_WIDTH
from satcheck.report.report import Effect, RuleReport
from satcheck.report.request import ON_REQUEST, Request, request_of
from satcheck.report.rule_book import RuleBook, Terms
from satcheck.report.settings import StatedSettings

# The key of a rule that requests an effect.
KEY_OF_EFFECT: dict[Effect, str] = {
    "depth": "max_depth",
    "thickness": "max_thickness",
    "distance": "clearance",
    "volume": "max_volume",
}
ALWAYS = "always"
MOTIONS = "the motions of the scene"
FOR_MESHES = "by default, for mesh files alone"
FOR_FAILURES = "by default, for pairs that fail"


class Planner:
    """Makes the requests for all pairs of a scene.

    composed: a scene file places the bodies. By default, figures are then computed for the pairs
    that fail (`figures.py`). moving: some bodies move.
    """

    def __init__(
        self, settings: Settings, book: RuleBook, composed: bool = False, moving: bool = False
    ) -> None:
        self.settings = settings
        self.moving = moving
        self._book = book
        self._composed = composed
        self._by_flags = _by_flags(settings, composed=composed)
        self._requests: dict[tuple[int, ...], Request] = {}

    def request(self, i: int, j: int) -> Request:
        if not self._book.rules:
            return self._by_flags
        key = self._book.key(i, j)
        request = self._requests.get(key)
        if request is None:
            request = self._by_flags
            if terms := self._book.terms(i, j):
                request = request_for(self.settings, terms, composed=self._composed)
            self._requests[key] = request
        return request

    def requested_by(self, effect: Effect) -> tuple[str, ...]:
        """The flag and the rules that request the effect; empty: none does."""
        if effect == "sweep":
            return (MOTIONS,) if self.moving else ()
        flag = self._by_flags.by.get(effect)
        key = KEY_OF_EFFECT.get(effect)
        rules = (rule.name for rule in self._book.rules if key and _requests_effect(rule, key))
        return tuple(dict.fromkeys(([flag] if flag else []) + list(rules)))

    def stated(self) -> StatedSettings:
        """The settings, and whether the depth and the thickness of every overlap are computed."""
        request = self._by_flags
        return self.settings.stated(
            depth=request.wants("depth"), thickness=request.wants("thickness")
        )

    @property
    def lengths_differ(self) -> bool:
        """Whether rules give some pairs a clearance or a tolerance of their own."""
        return self._book.sets("clearance") or self._book.sets("tolerance")

    def gap_limit(self, i: int, j: int, resolution: float) -> float:
        """A larger gap of this pair needs no figure. resolution: the sum of both bodies."""
        if self.settings.distance:
            return math.inf
        request = self.request(i, j)
        band = resolution if request.tolerance is None else request.tolerance
        of_curves = 0.0 if self.settings.planar is None else resolution
        return max(band, (request.clearance or 0.0) + of_curves)

    def reach(self, resolutions: Mapping[int, float]) -> list[float]:
        """A length for each of these bodies. The sum of two lengths is at least the gap limit of
        the pair."""
        settings = self.settings
        if settings.distance:
            return [LARGEST_LENGTH] * len(resolutions)
        # In a plane, curves may be closer than their polygons by the resolution.
        flat = settings.planar is not None
        own = [*map(max, *(self._book.longest(key) for key in ("clearance", "tolerance")))]
        clearance = settings.clearance or 0.0
        return [
            max(
                resolution if settings.tolerance is None else 0.5 * settings.tolerance,
                0.5 * max(clearance, own[body]) + (resolution * (1 + EXACT_WIDTH) if flat else 0.0),
            )
            for body, resolution in resolutions.items()
        ]


def request_for(
    settings: Settings, terms: Terms | None = None, *, composed: bool = False
) -> Request:
    """Return the request that follows from flags and rules, with who requests each effect."""
    across = None if settings.planar is None else settings.across
    request = request_of(terms or {}, settings, across)

    def figure(setting: bool | None, limit: str) -> str | None:
        """Return who requests the depth or the thickness. limit: the key of rules for it."""
        by_default = None if composed or setting is False else FOR_MESHES
        return "--depth" if setting else request.rule(limit) or by_default

    thick = figure(
        settings.depth if settings.thickness is None else settings.thickness, "max_thickness"
    )
    if thick is None and settings.surface_tolerance is not None and settings.thickness is not False:
        thick = "--surface-tolerance"
    by: dict[Effect, str | None] = {
        "overlap": ALWAYS,
        "depth": figure(settings.depth, "max_depth"),
        "thickness": thick,
        "distance": None
        if request.clearance is None and not settings.distance
        else request.rule("clearance") or ("distance" if settings.distance else "--clearance"),
    }
    for effect, extra in ON_REQUEST.items():
        option = (
            f"--{extra.setting.replace('_', '-')}" if getattr(settings, extra.setting) else None
        )
        by[effect] = option or request.rule(KEY_OF_EFFECT.get(effect, ""))
    # A coarser accuracy is chosen for speed.
    by_failing = composed and settings.depth is None and settings.accuracy == "exact"
    wanted: dict[Effect, bool | None] = {"depth": None, "thickness": settings.thickness}
    return replace(
        request,
        by={effect: who for effect, who in by.items() if who},
        if_failing=tuple(
            effect
            for effect, setting in wanted.items()
            if by_failing and setting is None and not by[effect]
        ),
    )


# Checks with the same settings share it: it takes longer than the relation of two boxes.
_by_flags = lru_cache(maxsize=8)(request_for)


def _requests_effect(rule: RuleReport, key: str) -> bool:
    """Whether the rule requests the effect of the key. A clearance of 0 requests nothing; a limit
    of 0 does."""
    value = getattr(rule, key)
    return bool(value) if key == "clearance" else value is not None
