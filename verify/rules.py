"""The rules of a report: which pairs are exempt, and which limits the others have.

If several rules of a pair set the same key, the last one counts. This code is independent of the
solver's, which compiles the same rules to sets of bodies.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from itertools import combinations
from typing import Any

from satcheck.report.report import Exempt, RuleReport
from satcheck.verify.bodies import Placed

GROUP = "group:"
LIMITS = ("max_depth", "max_thickness", "max_volume")
NUMBERS = (*LIMITS, "clearance", "tolerance")
# Of findings, from the least; `silenced` is an error of a pair whose rule says `none`.
SEVERITIES = ("none", "silenced", "note", "warning", "error")

KEYS = ("allowed", *NUMBERS, "severity")


@dataclass(frozen=True, slots=True)
class Request:
    """What a check requires of a pair, by settings and rules of its report. tolerance: None: the
    input precision. severity: of its errors; None: error. names: key -> the name of the rule that
    sets it. across: with --planar, the axis normal to the plane; else None."""

    tolerance: float | None
    clearance: float | None
    allow_open: bool
    max_depth: float | None = None
    max_thickness: float | None = None
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
        return any(getattr(self, key) is not None for key in LIMITS)


# The keys of a rule that replace settings.
TERMS = frozenset((*NUMBERS, "severity"))

Terms = dict[str, Any]  # key of a rule -> its value
# The facts about a body that rules depend on: its sides of rules, its ignored groups, and whether
# it is static while pairs of static bodies are exempt.
Kind = tuple[tuple[tuple[int, bool], ...], frozenset[str], bool]


class Rules:
    """bodies: those of the report, by id."""

    def __init__(
        self, exempt: Exempt, rules: Sequence[RuleReport], bodies: Mapping[str, Placed]
    ) -> None:
        self._rules = rules
        groups, static = {*exempt.groups}, exempt.static_pairs
        about = self._about(bodies)
        self._kinds: dict[str, Kind] = {
            id_: (tuple(about[id_]), body.groups & groups, static and body.static)
            for id_, body in bodies.items()
        }
        self._terms: dict[tuple[Kind, Kind], tuple[Terms, dict[str, str]]] = {}

    def _about(self, bodies: Mapping[str, Placed]) -> dict[str, list[tuple[int, bool]]]:
        """id -> the rules that are about the body, each with whether it is on the side a."""
        selected = _Selected(bodies)
        about: dict[str, list[tuple[int, bool]]] = {id_: [] for id_ in bodies}
        for number, rule in enumerate(self._rules):
            for selector, first in ((rule.a, True), (rule.b, False)):
                for id_ in selected.by(selector):
                    about[id_].append((number, first))
        return about

    def is_ignored(self, a: Placed, b: Placed) -> bool:
        """Whether the pair is neither checked nor counted."""
        return _ignored(self._kinds[a.id], self._kinds[b.id])

    def terms(self, a: Placed, b: Placed) -> Terms:
        """key -> value, of those that a rule sets for the pair."""
        return self._terms_of(self._kinds[a.id], self._kinds[b.id])[0]

    def names(self, a: Placed, b: Placed) -> dict[str, str]:
        """key -> the name of the rule that sets it for the pair."""
        return self._terms_of(self._kinds[a.id], self._kinds[b.id])[1]

    def is_exempt(self, a: Placed, b: Placed) -> bool:
        return self.is_ignored(a, b) or self.terms(a, b).get("allowed") is True

    def count(self) -> tuple[int, int]:
        """The number of counted pairs, and of allowed ones among them."""
        sizes = Counter(self._kinds.values())
        pairs = [(kind, kind, n * (n - 1) // 2) for kind, n in sizes.items()]
        pairs += [
            (first, second, sizes[first] * sizes[second])
            for first, second in combinations(sizes, 2)
        ]
        counted = [(first, second, n) for first, second, n in pairs if not _ignored(first, second)]
        allowed = sum(
            n for first, second, n in counted if self._terms_of(first, second)[0].get("allowed")
        )
        return sum(n for *_, n in counted), allowed

    def _terms_of(self, first: Kind, second: Kind) -> tuple[Terms, dict[str, str]]:
        if not first[0] or not second[0]:
            return {}, {}
        if (first, second) not in self._terms:
            others = set(second[0])
            terms: Terms = {}
            names: dict[str, str] = {}
            for number, is_a in first[0]:
                if (number, not is_a) in others:
                    rule = self._rules[number]
                    said = [key for key in KEYS if getattr(rule, key) is not None]
                    terms |= {key: getattr(rule, key) for key in said}
                    names |= dict.fromkeys(said, rule.name)
            self._terms[first, second] = terms, names
        return self._terms[first, second]


def _ignored(first: Kind, second: Kind) -> bool:
    return bool(first[1] & second[1]) or (first[2] and second[2])


def selected_by(bodies: Mapping[str, Placed]) -> Callable[[str], frozenset[str]]:
    """The function from a selector to the ids that it selects."""
    return _Selected(bodies).by


class _Selected:
    """The ids that a selector selects. A name that the selector spells out, with its special
    characters in brackets or as it is, comes before what matches the glob."""

    def __init__(self, bodies: Mapping[str, Placed]) -> None:
        self._ids = {id_: [id_] for id_ in bodies}
        self._groups: dict[str, list[str]] = {}
        for id_, body in bodies.items():
            for group in body.groups:
                self._groups.setdefault(group, []).append(id_)
        self._escaped = {
            True: {_escaped(name): name for name in self._groups},
            False: {_escaped(name): name for name in self._ids},
        }
        self._selected: dict[str, frozenset[str]] = {}

    def by(self, selector: str) -> frozenset[str]:
        if selector not in self._selected:
            is_group, glob = selector.startswith(GROUP), selector.removeprefix(GROUP)
            members = self._groups if is_group else self._ids
            spelt = self._escaped[is_group].get(glob, glob)
            names = [spelt] if spelt in members else [n for n in members if fnmatchcase(n, glob)]
            self._selected[selector] = frozenset(id_ for name in names for id_ in members[name])
        return self._selected[selector]


def _escaped(name: str) -> str:
    text = re.sub(r"[*?\[]", r"[\g<0>]", name)
    return f"[g]{text[1:]}" if text.startswith(GROUP) else text
