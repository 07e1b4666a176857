"""The rules of a report: which pairs are exempt, and which limits the others have.

Of several rules about a pair the last one that sets a key decides it. Written apart from the
solver's, which compiles the same rules to sets of bodies.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from itertools import combinations
from typing import Any

from satcheck.verify.bodies import Placed

GROUP = "group:"
NUMBERS = ("max_depth", "max_volume", "clearance", "tolerance")
# Of findings, from the least; `silenced` is an error of a pair whose rule says `none`.
SEVERITIES = ("none", "silenced", "note", "warning", "error")

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
        self._rules = document["rules"]
        groups, static = {*document["exempt"]["groups"]}, document["exempt"]["static_pairs"]
        about = self._about(bodies)
        self._kinds: dict[str, Kind] = {
            id_: (tuple(about[id_]), body.groups & groups, static and body.static)
            for id_, body in bodies.items()
        }
        self._terms: dict[tuple[Kind, Kind], tuple[Json, dict[str, str]]] = {}

    def _about(self, bodies: Mapping[str, Placed]) -> dict[str, list[tuple[int, bool]]]:
        """id -> the rules that are about the body, each with whether it is on the side a."""
        selected = _Selected(bodies)
        about: dict[str, list[tuple[int, bool]]] = {id_: [] for id_ in bodies}
        for number, rule in enumerate(self._rules):
            for side in "ab":
                for id_ in selected.by(rule[side]):
                    about[id_].append((number, side == "a"))
        return about

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
        self._found: dict[str, frozenset[str]] = {}

    def by(self, selector: str) -> frozenset[str]:
        if selector not in self._found:
            of_groups, glob = selector.startswith(GROUP), selector.removeprefix(GROUP)
            members = self._groups if of_groups else self._ids
            spelt = self._escaped[of_groups].get(glob, glob)
            names = [spelt] if spelt in members else [n for n in members if fnmatchcase(n, glob)]
            self._found[selector] = frozenset(id_ for name in names for id_ in members[name])
        return self._found[selector]


def _escaped(name: str) -> str:
    text = re.sub(r"[*?\[]", r"[\g<0>]", name)
    return f"[g]{text[1:]}" if text.startswith(GROUP) else text


def _name(rule: Json) -> str:
    """Where it is written, or else which pairs it is about."""
    return rule.get("where") or f"{rule['a']} and {rule['b']}"
