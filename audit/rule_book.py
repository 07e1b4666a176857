"""What a scene says about its pairs of bodies, looked up and counted without visiting them all.

Bodies are indices. Those that the same selectors choose, in the same ignored groups, are of one
kind: what the rules say of a pair depends on the two kinds alone. Counts are those of bits in rows
of the matrix of pairs, one row a kind.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from satcheck.scene.rules import KEYS, Rule, Selector

# Which side of a rule a body is on; it may be on both.
_A, _B = 1, 2


@dataclass(frozen=True, slots=True)
class Terms:
    """Of each key the rule that decides it for a pair, the last that sets it; None: none does."""

    allowed: Rule | None = None
    max_depth: Rule | None = None
    max_volume: Rule | None = None
    clearance: Rule | None = None
    tolerance: Rule | None = None
    severity: Rule | None = None

    @property
    def allows(self) -> bool:
        return self.allowed is not None and self.allowed.allowed is True


NO_TERMS = Terms()


@dataclass(frozen=True, slots=True)
class Subject:
    """A body, as rules see it."""

    id: str
    groups: tuple[str, ...] = ()
    static: bool = False


@dataclass(frozen=True, slots=True)
class _Kind:
    """rules: number of a rule -> sides on which the bodies are, in the order of the rules."""

    rules: tuple[tuple[int, int], ...]
    ignored_groups: frozenset[str]
    fixed: bool


class RuleBook:
    """rules: in the order in which they count. Pairs within an ignored group are not asked about,
    nor are pairs of static bodies unless check_static."""

    def __init__(
        self,
        subjects: Sequence[Subject],
        rules: Sequence[Rule] = (),
        ignored_groups: frozenset[str] = frozenset(),
        check_static: bool = True,
    ) -> None:
        self.rules = tuple(rules)
        self._count = len(subjects)
        members = _Members(subjects)
        self._sides = [(members.of(rule.a), members.of(rule.b)) for rule in self.rules]
        self._kinds: list[_Kind] = []
        self._bodies: list[list[int]] = []
        self._kind_of: list[int] = []
        self._terms: dict[tuple[int, int], Terms] = {}
        self._rows: dict[frozenset[int], int] = {}
        numbers: dict[_Kind, int] = {}
        for index, (body, about) in enumerate(zip(subjects, self._about(), strict=True)):
            kind = _Kind(
                tuple(about.items()),
                ignored_groups.intersection(body.groups),
                body.static and not check_static,
            )
            number = numbers.setdefault(kind, len(self._kinds))
            if number == len(self._kinds):
                self._kinds.append(kind)
                self._bodies.append([])
            self._bodies[number].append(index)
            self._kind_of.append(number)

    def _about(self) -> list[dict[int, int]]:
        about: list[dict[int, int]] = [{} for _ in range(self._count)]
        for number, sides in enumerate(self._sides):
            for side, members in zip((_A, _B), sides, strict=True):
                for body in members:
                    about[body][number] = about[body].get(number, 0) | side
        return about

    def kinds(self, i: int, j: int) -> tuple[int, int]:
        """A key for everything that the book says about this pair."""
        return self._kind_of[i], self._kind_of[j]

    def is_ignored(self, i: int, j: int) -> bool:
        """Not asked about and not counted."""
        a, b = (self._kinds[self._kind_of[k]] for k in (i, j))
        return (a.fixed and b.fixed) or not a.ignored_groups.isdisjoint(b.ignored_groups)

    def terms(self, i: int, j: int) -> Terms:
        key = self.kinds(i, j)
        found = self._terms.get(key)
        if found is None:
            a, b = (self._kinds[k].rules for k in key)
            found = self._terms[key] = self._merged(a, dict(b)) if a and b else NO_TERMS
        return found

    def _merged(self, a: Iterable[tuple[int, int]], b: dict[int, int]) -> Terms:
        deciding: dict[str, Rule] = {}
        for number, sides in a:
            others = b.get(number, 0)
            if (sides & _A and others & _B) or (sides & _B and others & _A):
                rule = self.rules[number]
                deciding |= {key: rule for key in KEYS if getattr(rule, key) is not None}
        return replace(NO_TERMS, **deciding) if deciding else NO_TERMS

    def longest(self, key: str, body: int) -> float:
        """The largest that a rule about this body sets the key to, overruled or not; 0.0: none."""
        rules = (self.rules[number] for number, _ in self._kinds[self._kind_of[body]].rules)
        return max((getattr(rule, key) or 0.0 for rule in rules), default=0.0)

    def unused(self) -> Iterator[Rule]:
        """Rules about no pair of bodies."""
        for rule, (a, b) in zip(self.rules, self._sides, strict=True):
            alone = len(a) <= 1 and len(b) <= 1 and a == b
            if not a or not b or alone:
                yield rule

    def count(self) -> tuple[int, int]:
        """How many pairs are not ignored, and how many of these are allowed."""
        total = allowed = 0
        everyone = (1 << self._count) - 1
        ignoring = self._ignoring()
        for kind, bodies in zip(self._kinds, self._bodies, strict=True):
            ignored = 0
            for one, row in ignoring:
                if (one is None and kind.fixed) or one in kind.ignored_groups:
                    ignored |= row
            asked = everyone & ~ignored
            total += _ones(asked, bodies)
            allowed += _ones(asked & self._allowed_row(kind), bodies)
        return total // 2, allowed // 2

    def _ignoring(self) -> list[tuple[str | None, int]]:
        """For each ignored group, and for what is fixed (None), the row of its members."""
        members: dict[str | None, list[int]] = {}
        for kind, bodies in zip(self._kinds, self._bodies, strict=True):
            for one in (*kind.ignored_groups, *([None] if kind.fixed else [])):
                members.setdefault(one, []).extend(bodies)
        return [(one, _row(bodies)) for one, bodies in members.items()]

    def _allowed_row(self, kind: _Kind) -> int:
        row = 0
        for number, sides in kind.rules:
            allowed = self.rules[number].allowed
            if allowed is None:
                continue
            a, b = self._sides[number]
            others = (self._row(b) if sides & _A else 0) | (self._row(a) if sides & _B else 0)
            row = row | others if allowed else row & ~others
        return row

    def _row(self, members: frozenset[int]) -> int:
        """Remembered where it is long to make; those of single bodies would fill the memory."""
        if len(members) <= 1:
            return _row(members)
        if members not in self._rows:
            self._rows[members] = _row(members)
        return self._rows[members]


def _row(bodies: Iterable[int]) -> int:
    """The number with these bits."""
    bodies = tuple(bodies)
    if len(bodies) == 1:
        return 1 << bodies[0]
    octets = bytearray(max(bodies, default=0) // 8 + 1)
    for k in bodies:
        octets[k >> 3] |= 1 << (k & 7)
    return int.from_bytes(octets, "little")


def _ones(row: int, bodies: Sequence[int]) -> int:
    """Over all these bodies, the ones in the row but for the body itself."""
    return len(bodies) * row.bit_count() - (row & _row(bodies)).bit_count()


class _Members:
    """Bodies by selector; a selector that names one id or group is looked up, not matched."""

    def __init__(self, subjects: Sequence[Subject]) -> None:
        self._subjects = subjects
        self._found: dict[Selector, frozenset[int]] = {}
        self._by_id = {body.id: k for k, body in enumerate(subjects)}
        self._by_group: dict[str, list[int]] = {}
        for k, body in enumerate(subjects):
            for group in dict.fromkeys(body.groups):
                self._by_group.setdefault(group, []).append(k)

    def of(self, selector: Selector) -> frozenset[int]:
        if selector not in self._found:
            self._found[selector] = frozenset(self._choose(selector))
        return self._found[selector]

    def _choose(self, selector: Selector) -> Iterable[int]:
        only = selector.only
        if only is None:
            everyone = enumerate(self._subjects)
            return (k for k, body in everyone if selector.matches(body.id, body.groups))
        if selector.of_groups:
            return self._by_group.get(only, ())
        return (self._by_id[only],) if only in self._by_id else ()
