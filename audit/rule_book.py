"""What a scene says about its pairs of bodies, looked up and counted without visiting them all.

Bodies are indices. A rule whose selectors each choose one body is kept under that pair. By all the
others bodies are of one kind: what is said of a pair depends on the two kinds alone. Counts are
those of bits in rows of the matrix of pairs, one row a kind.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from satcheck.scene.rules import KEYS, Rule, Selector

# Which side of a rule a body is on; it may be on both.
_A, _B = 1, 2
# More pairs of kinds than this are not listed.
_MOST_KINDS = 1_000_000


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
    """sides: number of a rule -> on which sides of it the bodies are, in the order of the rules."""

    sides: tuple[tuple[int, int], ...]
    ignored_groups: frozenset[str]
    fixed: bool


class RuleBook:
    """rules: in the order in which they count. Pairs within an ignored group are not asked about,
    nor are pairs of static bodies unless check_static.

    kind_of: the kind of each body, a number.
    """

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
        self._named: dict[tuple[int, int], list[int]] = {}
        self._kinds: list[_Kind] = []
        self._bodies: list[list[int]] = []
        self.kind_of: list[int] = []
        self._terms: dict[tuple[int, int], Terms] = {}  # of kinds
        self._named_terms: dict[tuple[int, int], Terms] = {}
        numbers: dict[_Kind, int] = {}
        for index, (body, sides) in enumerate(zip(subjects, self._sort_rules(), strict=True)):
            kind = _Kind(
                tuple(sides.items()),
                ignored_groups.intersection(body.groups),
                body.static and not check_static,
            )
            number = numbers.setdefault(kind, len(self._kinds))
            if number == len(self._kinds):
                self._kinds.append(kind)
                self._bodies.append([])
            self._bodies[number].append(index)
            self.kind_of.append(number)

    def _sort_rules(self) -> list[dict[int, int]]:
        """Names the pairs of some rules; of the others, for each body, the sides it is on."""
        found: list[dict[int, int]] = [{} for _ in range(self._count)]
        for number, (a, b) in enumerate(self._sides):
            if len(a) == len(b) == 1:
                i, j = sorted((*a, *b))
                if i != j:
                    self._named.setdefault((i, j), []).append(number)
                continue
            for side, members in ((_A, a), (_B, b)):
                for body in members:
                    found[body][number] = found[body].get(number, 0) | side
        return found

    def key(self, i: int, j: int) -> tuple[int, ...]:
        """The same for pairs of which the book says the same, as far as it knows at once."""
        pair = (i, j) if i < j else (j, i)
        return (*pair, 1) if pair in self._named else (self.kind_of[i], self.kind_of[j])

    def is_ignored(self, i: int, j: int) -> bool:
        """Not asked about and not counted."""
        a, b = (self._kinds[self.kind_of[k]] for k in (i, j))
        return (a.fixed and b.fixed) or not a.ignored_groups.isdisjoint(b.ignored_groups)

    def is_asked(self, i: int, j: int) -> bool:
        return not self.is_ignored(i, j) and not self.terms(i, j).allows

    def asked_pairs(self) -> Iterator[tuple[int, int]]:
        """All of them, i < j, in the order of the second: quadratic, for few bodies."""
        for j in range(self._count):
            for i in range(j):
                if self.is_asked(i, j):
                    yield i, j

    def terms(self, i: int, j: int) -> Terms:
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
        """Numbers of the rules that are about the pair and name it not alone, in their order."""
        a, b = (self._kinds[self.kind_of[k]].sides for k in (i, j))
        if not a or not b:
            return []
        others = dict(b)
        return [
            number
            for number, sides in a
            if (sides & _A and others.get(number, 0) & _B)
            or (sides & _B and others.get(number, 0) & _A)
        ]

    def _merged(self, numbers: Iterable[int]) -> Terms:
        deciding: dict[str, Rule] = {}
        for number in numbers:
            rule = self.rules[number]
            deciding |= {key: rule for key in KEYS if getattr(rule, key) is not None}
        return replace(NO_TERMS, **deciding) if deciding else NO_TERMS

    def sets(self, key: str) -> bool:
        """Whether any rule sets the key."""
        return any(getattr(rule, key) is not None for rule in self.rules)

    def longest(self, key: str) -> list[float]:
        """Of each body the largest value that a rule about it gives the key, overruled or not; 0.0:
        none."""
        found = [0.0] * self._count
        for rule, sides in zip(self.rules, self._sides, strict=True):
            value = getattr(rule, key) or 0.0
            for body in (*sides[0], *sides[1]) if value else ():
                found[body] = max(found[body], value)
        return found

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
        rows = _Rows(self._kinds, self.rules, self._sides, self._bodies)
        for kind, bodies in zip(self._kinds, self._bodies, strict=True):
            asked = everyone & ~rows.ignored(kind)
            total += _ones(asked, bodies)
            allowed += _ones(asked & rows.allowed(kind), bodies)
        total, allowed = total // 2, allowed // 2
        for i, j in self._named:
            if not self.is_ignored(i, j):
                allowed += self.terms(i, j).allows - self._merged(self._about(i, j)).allows
        return total, allowed

    def exempt_named(self) -> list[tuple[int, int]]:
        """The pairs (i, j), i < j, that rules of their own take out."""
        return [(i, j) for i, j in self._named if not self.is_asked(i, j)]

    def exempt_kinds(self) -> list[tuple[int, int]]:
        """Pairs of kinds, the lower first, of which no pair of bodies is asked about. Where there
        are very many, some of them."""
        alone = [frozenset((k,)) for k in range(len(self._kinds))]
        sides = [
            tuple(frozenset(self.kind_of[k] for k in members) for members in pair)
            for pair in self._sides
        ]
        rows = _Rows(self._kinds, self.rules, sides, alone)
        taken_back = {
            tuple(sorted((self.kind_of[i], self.kind_of[j])))
            for i, j in self._named
            if self.is_asked(i, j)
        }
        found: list[tuple[int, int]] = []
        for number, kind in enumerate(self._kinds):
            row = (rows.ignored(kind) | rows.allowed(kind)) >> number
            while row and len(found) < _MOST_KINDS:
                lowest = row & -row
                pair = (number, number + lowest.bit_length() - 1)
                row ^= lowest
                if pair not in taken_back:
                    found.append(pair)
        return found


class _Rows:
    """Rows of the matrix of pairs of members, bodies or kinds, as the bits of a number each.

    sides: the members on either side of each rule. of_kinds: those of each kind.
    """

    def __init__(
        self,
        kinds: Sequence[_Kind],
        rules: Sequence[Rule],
        sides: Sequence[tuple[frozenset[int], ...]],
        of_kinds: Sequence[Iterable[int]],
    ) -> None:
        self._rules, self._sides = rules, sides
        self._known: dict[tuple[int, int], int] = {}
        together: dict[str | None, list[int]] = {}
        for kind, members in zip(kinds, of_kinds, strict=True):
            for one in (*kind.ignored_groups, *([None] if kind.fixed else [])):
                together.setdefault(one, []).extend(members)
        self._together = {one: _row(members) for one, members in together.items()}

    def ignored(self, kind: _Kind) -> int:
        row = self._together[None] if kind.fixed else 0
        for group in kind.ignored_groups:
            row |= self._together[group]
        return row

    def allowed(self, kind: _Kind) -> int:
        row = 0
        for number, sides in kind.sides:
            allowed = self._rules[number].allowed
            if allowed is None:
                continue
            others = (self._side(number, 1) if sides & _A else 0) | (
                self._side(number, 0) if sides & _B else 0
            )
            row = row | others if allowed else row & ~others
        return row

    def _side(self, number: int, side: int) -> int:
        """Remembered where it is long to make; those of single members would fill the memory."""
        members = self._sides[number][side]
        if len(members) == 1:
            return _row(members)
        if (number, side) not in self._known:
            self._known[number, side] = _row(members)
        return self._known[number, side]


def _row(members: Iterable[int]) -> int:
    """The number with these bits."""
    members = tuple(members)
    if len(members) == 1:
        return 1 << members[0]
    octets = bytearray(max(members, default=0) // 8 + 1)
    for k in members:
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
