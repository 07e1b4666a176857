"""The planner makes the `Request` of each pair from the flags of a check and the rules of its
scene.

It alone decides which stages run.
"""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.request.rule_book import NO_TERMS, RuleBook, Terms
from satcheck.audit.request.settings import Settings
from satcheck.audit.rounding import EXACT_WIDTH
from satcheck.report.report import Effect
from satcheck.report.settings import StatedSettings
from satcheck.scene.rules import Rule, Severity

# The key of a rule that requests an effect.
KEY_OF_EFFECT: dict[Effect, str] = {
    "depth": "max_depth",
    "thickness": "max_thickness",
    "distance": "clearance",
    "volume": "max_volume",
}
# The keys that limit an overlap.
LIMITS = ("max_depth", "max_thickness", "max_volume")
ALWAYS = "always"
MOTIONS = "the motions of the scene"
FOR_MESHES = "by default, for mesh files alone"


class Request(Struct, frozen=True):
    """The request for one pair. Lengths and volumes are in units of the scene.

    by: effect -> the flag or rule that requests it; no entry: it is not requested. clearance: None:
    no clearance is required. tolerance: None: the input precision. max_depth, max_thickness,
    max_volume: limits of an overlap. severity: of the errors of the pair; None: the default. rules:
    key -> the name of the rule that set it.
    """

    by: Mapping[Effect, str]
    clearance: float | None = None
    tolerance: float | None = None
    max_depth: float | None = None
    max_thickness: float | None = None
    max_volume: float | None = None
    severity: Severity | None = None
    rules: Mapping[str, str] | None = None

    def wants(self, effect: Effect) -> bool:
        return effect in self.by

    def swept(self) -> Request:
        """The same request for a pair whose bodies move relative to each other."""
        return replace(self, by={**self.by, "sweep": MOTIONS})

    @property
    def limited(self) -> bool:
        """Whether the pair may overlap within limits."""
        return not (self.max_depth is self.max_thickness is self.max_volume is None)

    def rule(self, key: str) -> str | None:
        """The name of the rule that set this key."""
        return None if self.rules is None else self.rules.get(key)


class Planner:
    """Makes the requests for all pairs of a scene.

    composed: a scene file places the bodies. Depth is then not computed by default: a scene has
    many pairs, and its rules can request the depth of some. moving: some bodies move.
    """

    def __init__(
        self, settings: Settings, book: RuleBook, composed: bool = False, moving: bool = False
    ) -> None:
        self.settings = settings
        self.moving = moving
        self._book = book
        self._composed = composed
        self._by_flags = request_for(settings, composed=composed)
        self._requests: dict[tuple[int, ...], Request] = {}

    def request(self, i: int, j: int) -> Request:
        key = self._book.key(i, j)
        if key not in self._requests:
            terms = self._book.terms(i, j)
            self._requests[key] = request_for(self.settings, terms, composed=self._composed)
        return self._requests[key]

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
        request = self.request(i, j)
        band = resolution if request.tolerance is None else request.tolerance
        of_curves = 0.0 if self.settings.planar is None else resolution
        return max(band, (request.clearance or 0.0) + of_curves)

    def reach(self, resolutions: Mapping[int, float]) -> list[float]:
        """A length for each of these bodies. The sum of two lengths is at least the gap limit of
        the pair."""
        settings = self.settings
        # In a plane, curves may be closer than their polygons by the resolution.
        flat = settings.planar is not None
        own = [self._book.longest(key) for key in ("clearance", "tolerance")]
        clearance = settings.clearance or 0.0
        return [
            max(
                resolution if settings.tolerance is None else 0.5 * settings.tolerance,
                0.5 * max(clearance, *(lengths[body] for lengths in own))
                + (resolution * (1 + EXACT_WIDTH) if flat else 0.0),
            )
            for body, resolution in resolutions.items()
        ]


def request_for(settings: Settings, terms: Terms = NO_TERMS, *, composed: bool = False) -> Request:
    """The request that follows from flags and rules. A key of a rule overrides the flag. A pair
    that may overlap within limits has no clearance."""
    limits = {key: getattr(terms, key) for key in LIMITS}
    limited = any(limits.values())
    clearance = None if limited else settings.clearance
    if terms.clearance is not None and not limited:
        clearance = terms.clearance.clearance or None
    deciding = {
        **limits,
        "clearance": None if limited else terms.clearance,
        "tolerance": terms.tolerance,
        "severity": terms.severity,
    }
    thickness = settings.depth if settings.thickness is None else settings.thickness
    by: dict[Effect, str | None] = {
        "overlap": ALWAYS,
        "depth": _requester_of_figure(settings.depth, terms.max_depth, composed),
        "thickness": _requester_of_figure(thickness, terms.max_thickness, composed)
        or _requester_of_tolerance(settings),
        "distance": None if clearance is None else _name(terms.clearance) or "--clearance",
        "volume": "--volume" if settings.volume else _name(terms.max_volume),
        "contacts": "--contacts" if settings.contacts else None,
        "components": "--components" if settings.components else None,
        "cross-check": "--cross-check" if settings.cross_check else None,
        "certificate": "--certificate" if settings.certificate else None,
    }
    return Request(
        by={effect: who for effect, who in by.items() if who},
        clearance=clearance,
        tolerance=_value(terms.tolerance, "tolerance", settings.tolerance),
        **{key: _value(rule, key, None) for key, rule in limits.items()},
        severity=None if terms.severity is None else terms.severity.severity,
        rules={key: rule.name for key, rule in deciding.items() if rule is not None} or None,
    )


def _requester_of_figure(setting: bool | None, rule: Rule | None, composed: bool) -> str | None:
    """The flag or rule that requests the depth or the thickness. rule: the one that limits it."""
    if setting:
        return "--depth"
    if rule is not None:
        return rule.name
    return FOR_MESHES if setting is None and not composed else None


def _requester_of_tolerance(settings: Settings) -> str | None:
    if settings.surface_tolerance is None or settings.thickness is False:
        return None
    return "--surface-tolerance"


def _requests_effect(rule: Rule, key: str) -> bool:
    """Whether the rule requests the effect of the key. A clearance of 0 requests nothing; a limit
    of 0 does."""
    value = getattr(rule, key)
    return bool(value) if key == "clearance" else value is not None


def _name(rule: Rule | None) -> str | None:
    return None if rule is None else rule.name


def _value(rule: Rule | None, key: str, default: float | None) -> float | None:
    value = default if rule is None else getattr(rule, key)
    return None if value is None else float(value)  # Python callers may give an integer
