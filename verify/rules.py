"""The rules of a report: which pairs are exempt, and what is asked of the others.

Of several rules about a pair the last one that sets a key decides it. Written apart from the
solver's, which compiles the same rules to sets of bodies.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from itertools import combinations
from typing import Any

from satcheck.verify.bodies import Placed
from satcheck.verify.exact import Rejected

GROUP = "group:"
NUMBERS = ("max_depth", "max_volume", "clearance", "tolerance")
# Of findings, from the least; `silenced` is an error of a pair whose rule says `none`.
SEVERITIES = ("none", "silenced", "note", "warning", "error")
RULE_SEVERITIES = ("none", "note", "warning", "error")
KEYS = ("allowed", *NUMBERS, "severity")


@dataclass(frozen=True, slots=True)
class Asked:
    """What the report says is asked of a pair. tolerance: None: the input precision. severity: of
    its errors; None: error. names: key -> the name of the rule that sets it. across: the axis
    across the plane in which the bodies are outlines; None: they are as they are."""

    tolerance: float | None
    clearance: float | None
    allow_open: bool
    max_depth: float | None = None
    max_volume: float | None = None
    severity: str | None = None
    names: Mapping[str, str] = field(default_factory=dict)
    across: int | None = None

    def name(self, key: str) -> str | None:
        """Of the rule that sets the key; None: none does."""
        return self.names.get(key)

    @property
    def limited(self) -> bool:
        """The pair may overlap, within limits."""
        return self.max_depth is not None or self.max_volume is not None


# What a rule may say of a pair in the place of the settings.
ASKED = frozenset(("tolerance", "clearance", "max_depth", "max_volume", "severity"))

Json = dict[str, Any]
# What the rules see of a body: on which sides of which rules it is, the ignored groups it is in,
# whether it stands still while pairs of such bodies are not asked about.
Kind = tuple[tuple[tuple[int, bool], ...], frozenset[str], bool]


class Rules:
    """bodies: those of the report, by id."""

    def __init__(self, document: Json, bodies: Mapping[str, Placed]) -> None:
        exempt = document.get("exempt")
        if not isinstance(exempt, dict) or not isinstance(exempt.get("groups"), list):
            raise Rejected("not a report: 'exempt' names no groups")
        listed = document.get("rules")
        if not isinstance(listed, list):
            raise Rejected("not a report: 'rules' is no list")
        self._rules = [_checked(rule) for rule in listed]
        groups = {group for group in exempt["groups"] if isinstance(group, str)}
        static = exempt.get("static_pairs") is True
        self._kinds: dict[str, Kind] = {
            id_: (self._about(body), body.groups & groups, static and body.static)
            for id_, body in bodies.items()
        }
        self._terms: dict[tuple[Kind, Kind], tuple[Json, dict[str, str]]] = {}

    def _about(self, body: Placed) -> tuple[tuple[int, bool], ...]:
        return tuple(
            (number, side == "a")
            for number, rule in enumerate(self._rules)
            for side in "ab"
            if _selects(rule[side], body)
        )

    def is_ignored(self, a: Placed, b: Placed) -> bool:
        """Neither asked about nor counted."""
        return _ignored(self._kinds[a.id], self._kinds[b.id])

    def terms(self, a: Placed, b: Placed) -> Json:
        """key -> value, of those that a rule sets for the pair."""
        return self._of_kinds(self._kinds[a.id], self._kinds[b.id])[0]

    def names(self, a: Placed, b: Placed) -> dict[str, str]:
        """key -> the name of the rule that sets it for the pair."""
        return self._of_kinds(self._kinds[a.id], self._kinds[b.id])[1]

    def is_exempt(self, a: Placed, b: Placed) -> bool:
        return self.is_ignored(a, b) or self.terms(a, b).get("allowed") is True

    def count(self) -> tuple[int, int]:
        """Pairs that are counted, and how many of these are allowed."""
        sizes = Counter(self._kinds.values())
        pairs = [(kind, kind, n * (n - 1) // 2) for kind, n in sizes.items()]
        pairs += [(one, other, sizes[one] * sizes[other]) for one, other in combinations(sizes, 2)]
        counted = [(one, other, n) for one, other, n in pairs if not _ignored(one, other)]
        allowed = sum(
            n for one, other, n in counted if self._of_kinds(one, other)[0].get("allowed")
        )
        return sum(n for *_, n in counted), allowed

    def _of_kinds(self, one: Kind, other: Kind) -> tuple[Json, dict[str, str]]:
        if not one[0] or not other[0]:
            return {}, {}
        if (one, other) not in self._terms:
            others = set(other[0])
            terms: Json = {}
            names: dict[str, str] = {}
            for number, first in one[0]:
                if (number, not first) in others:
                    rule = self._rules[number]
                    said = [key for key in KEYS if rule.get(key) is not None]
                    terms |= {key: rule[key] for key in said}
                    names |= dict.fromkeys(said, _name(rule))
            self._terms[one, other] = terms, names
        return self._terms[one, other]


def _ignored(one: Kind, other: Kind) -> bool:
    return bool(one[1] & other[1]) or (one[2] and other[2])


def _selects(selector: str, body: Placed) -> bool:
    if selector.startswith(GROUP):
        glob = selector.removeprefix(GROUP)
        return any(fnmatchcase(group, glob) for group in body.groups)
    return fnmatchcase(body.id, selector)


def _name(rule: Json) -> str:
    """Where it is written, or else which pairs it is about."""
    return rule.get("where") or f"{rule['a']} and {rule['b']}"


def _checked(rule: Any) -> Json:
    if not isinstance(rule, dict) or not all(
        isinstance(rule.get(side), str) and rule[side].removeprefix(GROUP) for side in "ab"
    ):
        raise Rejected("not a report: a rule has two selectors")
    for key in NUMBERS:
        value = rule.get(key)
        known = isinstance(value, int | float) and not isinstance(value, bool)
        if value is not None and not (known and math.isfinite(value) and value >= 0):
            raise Rejected(f"not a report: {key} of a rule is no length or volume")
    if rule.get("severity") not in (None, *RULE_SEVERITIES) or rule.get("allowed") not in (
        None,
        True,
        False,
    ):
        raise Rejected("not a report: a rule says what no rule can")
    return rule
