"""Looks up and counts the rules of a report without visiting every pair.

Bodies are indices. If each selector of a rule chooses one body, the rule is stored under this pair.
All other rules sort the bodies into kinds, and their effect on a pair depends only on the two
kinds. So pairs are counted by the matrix of pairs, a row for each kind: an integer
whose bits are the pairs of one body.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Protocol

from msgspec import Struct

from satcheck.report.report import RuleReport

# The side of a rule that a body is on, as bits. A body may be on both.
A, B = 1, 2
# The members on either side of a rule.
Sides = tuple[frozenset[int], frozenset[int]]

# At most this many exempt pairs of kinds are listed.
_MOST_KINDS = 1_000_000


# For each key that rules set for a pair the last rule that sets it, which decides it.
Terms = Mapping[str, RuleReport]
_KEYS = (
    "allowed",
    "max_depth",
    "max_thickness",
    "max_volume",
    "clearance",
    "tolerance",
    "severity",
)


class Subject(Protocol):
    """The properties of a body that rules depend on, beside the sides that it is on."""

    @property
    def groups(self) -> Collection[str]: ...

    @property
    def static(self) -> bool: ...


class Kind(Struct, frozen=True):
    """A class of bodies that all rules treat alike. sides: (number of a rule, sides of the bodies)
    in the order of the rules. fixed: their pairs with each other are not checked."""

    sides: tuple[tuple[int, int], ...]
    ignored_groups: frozenset[str]
    fixed: bool


class RuleBook:
    """rules: later ones override earlier ones. sides: of each rule the bodies that its selectors
    `a` and `b` choose. Pairs within an ignored group are not checked, nor
    are pairs of static bodies unless check_static is set.

    kind_of: the number of the kind of each body.
    """

    def __init__(
        self,
        subjects: Sequence[Subject],
        rules: Sequence[RuleReport] = (),
        sides: Sequence[Sides] = (),
        ignored_groups: frozenset[str] = frozenset(),
        check_static: bool = True,
    ) -> None:
        self.rules = tuple(rules)
        self._count = len(subjects)
        self._sides = sides
        self._named: dict[tuple[int, int], list[int]] = {}
        self._kinds: list[Kind] = []
        self._bodies: list[list[int]] = []
        self.kind_of: list[int] = []
        self._terms: dict[tuple[int, int], Terms] = {}  # by kinds
        self._named_terms: dict[tuple[int, int], Terms] = {}
        chosen_by, about = self._sort_rules()
        numbers: dict[tuple[object, ...], int] = {}
        for index, body in enumerate(subjects):
            ignored = ignored_groups.intersection(body.groups)
            fixed = body.static and not check_static
            alike = (tuple(chosen_by[index]), ignored, fixed)
            number = numbers.setdefault(alike, len(self._kinds))
            if number == len(self._kinds):
                chosen = _sides_of(chosen_by[index], about)
                self._kinds.append(Kind(chosen, ignored, fixed))
                self._bodies.append([])
            self._bodies[number].append(index)
            self.kind_of.append(number)
        self._exempts = any(kind.fixed or kind.ignored_groups for kind in self._kinds)

    def _sort_rules(self) -> tuple[list[list[int]], list[list[tuple[int, int]]]]:
        """Stores rules for a single pair under this pair. Returns, for the other rules, the numbers
        of the selected sets that each body is in, and for each set its rules and their sides."""
        chosen_by: list[list[int]] = [[] for _ in range(self._count)]
        about: list[list[tuple[int, int]]] = []
        numbers: dict[frozenset[int], int] = {}
        for rule, (a, b) in enumerate(self._sides):
            if len(a) == len(b) == 1:
                i, j = sorted((*a, *b))
                if i != j:
                    self._named.setdefault((i, j), []).append(rule)
                continue
            for side, members in ((A, a), (B, b)):
                number = numbers.setdefault(members, len(about))
                if number == len(about):
                    about.append([])
                    for body in members:
                        chosen_by[body].append(number)
                about[number].append((rule, side))
        return chosen_by, about

    @property
    def _is_plain(self) -> bool:
        """Return whether there is no rule, and no pair is exempt."""
        return not self.rules and not self._exempts

    def key(self, i: int, j: int) -> tuple[int, ...]:
        """A cache key: pairs with equal keys have the same terms."""
        pair = (i, j) if i < j else (j, i)
        return (*pair, 1) if pair in self._named else (self.kind_of[i], self.kind_of[j])

    def is_ignored(self, i: int, j: int) -> bool:
        """Whether the pair is exempt: neither checked nor counted."""
        if not self._exempts:
            return False
        a, b = (self._kinds[self.kind_of[k]] for k in (i, j))
        return (a.fixed and b.fixed) or not a.ignored_groups.isdisjoint(b.ignored_groups)

    def is_checked(self, i: int, j: int) -> bool:
        return not self.is_ignored(i, j) and not _allows(self.terms(i, j))

    def checked_pairs(self) -> Iterator[tuple[int, int]]:
        """All checked pairs, i < j, in the order of j. Quadratic, so only for few bodies."""
        for j in range(self._count):
            for i in range(j):
                if self.is_checked(i, j):
                    yield i, j

    def terms(self, i: int, j: int) -> Terms:
        if not self.rules:
            return {}
        pair = (i, j) if i < j else (j, i)
        named = self._named.get(pair)
        if named is not None:
            if pair not in self._named_terms:
                self._named_terms[pair] = self._merged(sorted((*named, *self._about(i, j))))
            return self._named_terms[pair]
        key = self.kind_of[i], self.kind_of[j]
        if key not in self._terms:
            self._terms[key] = self._merged(self._about(i, j))
        return self._terms[key]

    def _about(self, i: int, j: int) -> list[int]:
        """Numbers of the rules that apply to the pair and to other pairs too, in their order."""
        a, b = (self._kinds[self.kind_of[k]].sides for k in (i, j))
        if not a or not b:
            return []
        others = dict(b)
        return [
            number
            for number, sides in a
            if (sides & A and others.get(number, 0) & B)
            or (sides & B and others.get(number, 0) & A)
        ]

    def _merged(self, numbers: Iterable[int]) -> Terms:
        deciding: dict[str, RuleReport] = {}
        for number in numbers:
            rule = self.rules[number]
            deciding |= {key: rule for key in _KEYS if getattr(rule, key) is not None}
        return deciding

    def sets(self, key: str) -> bool:
        """Whether any rule sets the key."""
        return any(getattr(rule, key) is not None for rule in self.rules)

    def longest(self, key: str) -> list[float]:
        """For each body the largest value of the key in any rule that selects it, even if another
        rule overrides it; 0.0: none."""
        values = [0.0] * self._count
        for rule, sides in zip(self.rules, self._sides, strict=True):
            value = getattr(rule, key) or 0.0
            for body in (*sides[0], *sides[1]) if value else ():
                values[body] = max(values[body], value)
        return values

    def unused(self) -> Iterator[int]:
        """The numbers of rules that apply to no pair of bodies."""
        for number, (a, b) in enumerate(self._sides):
            alone = len(a) <= 1 and len(b) <= 1 and a == b
            if not a or not b or alone:
                yield number

    def count(self, among: Collection[int] | None = None) -> tuple[int, int]:
        """The number of pairs that are not exempt, and the number of these that are allowed.
        among: of these bodies; None: of all."""
        if self._is_plain:
            number = self._count if among is None else len(among)
            return number * (number - 1) // 2, 0
        total = allowed = 0
        everyone = (1 << self._count) - 1 if among is None else row_of(among)
        for of_kind, (ignored, permitted) in zip(self._bodies, self._rows(), strict=True):
            bodies = of_kind if among is None else [k for k in of_kind if k in among]
            asked = everyone & ~ignored
            total += ones(asked, bodies)
            allowed += ones(asked & permitted, bodies)
        total, allowed = total // 2, allowed // 2
        for i, j in self._named:
            if (among is None or (i in among and j in among)) and not self.is_ignored(i, j):
                allowed += _allows(self.terms(i, j)) - _allows(self._merged(self._about(i, j)))
        return total, allowed

    def exempt_named(self) -> list[tuple[int, int]]:
        """The pairs (i, j), i < j, that are not checked and have a rule of their own."""
        return [(i, j) for i, j in self._named if not self.is_checked(i, j)]

    def exempt_kinds(self) -> list[tuple[int, int]]:
        """Pairs of kinds, the lower first, without a checked pair of bodies. The list is cut off at
        _MOST_KINDS."""
        if self._is_plain:
            return []
        taken_back = {
            tuple(sorted((self.kind_of[i], self.kind_of[j])))
            for i, j in self._named
            if self.is_checked(i, j)
        }
        exempt: list[tuple[int, int]] = []
        first = row_of(bodies[0] for bodies in self._bodies)
        for number, (ignored, permitted) in enumerate(self._rows()):
            row = (ignored | permitted) & first
            while row and len(exempt) < _MOST_KINDS:
                lowest = row & -row
                row ^= lowest
                pair = (number, self.kind_of[lowest.bit_length() - 1])
                if number <= pair[1] and pair not in taken_back:
                    exempt.append(pair)
        return exempt

    def _rows(self) -> Iterator[tuple[int, int]]:
        """Yield two rows for each kind: its pairs that are ignored, and those that rules about
        several pairs allow."""
        fixed = row_of(k for k, kind in enumerate(self.kind_of) if self._kinds[kind].fixed)
        within: dict[str, list[int]] = {}
        for kind, bodies in zip(self._kinds, self._bodies, strict=True):
            for group in kind.ignored_groups:
                within.setdefault(group, []).extend(bodies)
        groups = {group: row_of(bodies) for group, bodies in within.items()}
        known: dict[frozenset[int], int] = {}  # of one body they would fill the memory

        def row(members: frozenset[int]) -> int:
            if len(members) > 1 and members not in known:
                known[members] = row_of(members)
            return known[members] if members in known else row_of(members)

        for kind in self._kinds:
            ignored, allowed = fixed if kind.fixed else 0, 0
            for group in kind.ignored_groups:
                ignored |= groups[group]
            for number, sides in kind.sides:
                a, b = self._sides[number]
                if (allows := self.rules[number].allowed) is not None:
                    others = (row(b) if sides & A else 0) | (row(a) if sides & B else 0)
                    allowed = allowed | others if allows else allowed & ~others
            yield ignored, allowed


def row_of(members: Iterable[int]) -> int:
    """Return the integer with these bits set."""
    members = tuple(members)
    if len(members) == 1:
        return 1 << members[0]
    octets = bytearray(max(members, default=0) // 8 + 1)
    for k in members:
        octets[k >> 3] |= 1 << (k & 7)
    return int.from_bytes(octets, "little")


def ones(row: int, bodies: Sequence[int]) -> int:
    """Return the number of ones in the row, summed over these bodies; for each body without its own
    bit."""
    return len(bodies) * row.bit_count() - (row & row_of(bodies)).bit_count()


def _allows(terms: Terms) -> bool:
    return "allowed" in terms and terms["allowed"].allowed is True


def _sides_of(
    sets: Iterable[int], about: Sequence[Sequence[tuple[int, int]]]
) -> tuple[tuple[int, int], ...]:
    """For a body in these sets: (number of a rule, its sides), in the order of the rules."""
    sides: dict[int, int] = {}
    for number in sets:
        for rule, side in about[number]:
            sides[rule] = sides.get(rule, 0) | side
    return tuple(sorted(sides.items()))
