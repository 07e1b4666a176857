"""What is asked of one pair, by the settings and the rules of a report."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal

from msgspec import Struct

from satcheck.report.report import Effect, Finding
from satcheck.report.rule_book import Terms
from satcheck.report.settings import StatedSettings

# The keys that limit an overlap.
LIMITS = ("max_depth", "max_thickness", "max_volume")
# The limits that settings give to all pairs, and the names that decide by them.
OPTIONS_OF_LIMITS = {"max_depth": "--max-depth", "max_thickness": "--max-thickness"}


class OnRequest(Struct, frozen=True):
    """An effect that is computed only on request. setting: requests it, as the option of this name
    does. answer: its result in a finding; None: the trace alone has it."""

    setting: str
    answer: Callable[[Finding], object] | None = None


def _known_parts(finding: Finding) -> object:
    found = finding.part_pairs
    return found if found is not None and found.known else None


ON_REQUEST: dict[Effect, OnRequest] = {
    "volume": OnRequest("volume", lambda finding: finding.volume),
    "contacts": OnRequest("contacts", lambda finding: finding.contacts),
    "components": OnRequest("components", lambda finding: finding.components),
    "part-pairs": OnRequest("parts", _known_parts),
    "cross-check": OnRequest("cross_check"),
    "certificate": OnRequest("certificate", lambda finding: finding.certificate),
}


class Request(Struct, frozen=True):
    """Lengths and volumes are in units of the scene.

    by: effect -> the flag or rule that requests it; no entry: it is not requested. if_failing:
    effects that are requested if the pair fails, within a budget of the scene. clearance: None: no
    clearance is required. tolerance: None: the input precision. max_depth, max_thickness,
    max_volume: limits of an overlap. severity: of the errors of the pair; None: the default. rules:
    key -> the name of the rule, or of the option, that set it. across: in a check in a plane, the
    axis across it.
    """

    by: Mapping[Effect, str] = {}
    if_failing: tuple[Effect, ...] = ()
    clearance: float | None = None
    tolerance: float | None = None
    max_depth: float | None = None
    max_thickness: float | None = None
    max_volume: float | None = None
    severity: Literal["error", "warning", "note", "none"] | None = None
    rules: Mapping[str, str] = {}
    across: int | None = None

    def wants(self, effect: Effect) -> bool:
        return effect in self.by

    @property
    def limited(self) -> bool:
        """Return whether the pair may overlap within limits."""
        return not (self.max_depth is self.max_thickness is self.max_volume is None)

    def rule(self, key: str) -> str | None:
        """Return the name of the rule that set this key."""
        return self.rules.get(key)


def request_of(terms: Terms, settings: StatedSettings, across: int | None) -> Request:
    """Return what rules make of the settings for their pairs. A key of a rule overrides the
    setting. A pair that may overlap within limits has no clearance. Limits of the settings are for
    pairs to which rules give neither a limit nor a clearance."""
    by = {key: rule for key, rule in terms.items() if key != "allowed"}
    given = settings.tolerance
    values: dict[str, Any] = {
        "clearance": settings.clearance,
        "tolerance": None if isinstance(given, str) else given,
    }
    names: dict[str, str] = {}
    if not by.keys().isdisjoint(LIMITS):
        values["clearance"] = None
        by.pop("clearance", None)
    elif "clearance" not in by:
        limits = {key: getattr(settings, key) for key in OPTIONS_OF_LIMITS}
        values |= limits
        names = {key: OPTIONS_OF_LIMITS[key] for key, limit in limits.items() if limit is not None}
    values |= {key: getattr(rule, key) for key, rule in by.items()}
    if "clearance" in by:
        values["clearance"] = values["clearance"] or None
    lengths = values.keys() - {"severity"}  # Python callers may give an integer
    values |= {key: float(values[key]) for key in lengths if values[key] is not None}
    names |= {key: rule.name for key, rule in by.items()}
    return Request(**values, rules=names, across=across)
