"""The rules of a scene, looked up and counted without visiting every pair.

Bodies are indices. A rule whose selectors each choose one body is kept under that pair. By all the
others bodies are of one kind: what is said of a pair depends on the two kinds alone. Counts are
those of bits in rows of the matrix of pairs, one row a kind.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.request.pair_rows import A, B, Kind, PairRows, ones
from satcheck.scene.rules import KEYS, Rule, Selector

# More pairs of kinds than this are not listed.
_MOST_KINDS = 1_000_000


class Terms(Struct, frozen=True):
    """Of each key the rule that decides it for a pair, the last that sets it; None: none does."""

    allowed: Rule | None = None
    max_depth: Rule | None = None
    max_thickness: Rule | None = None
    max_volume: Rule | None = None
    clearance: Rule | None = None
    tolerance: Rule | None = None
    severity: Rule | None = None

    @property
    def allows(self) -> bool:
        return self.allowed is not None and self.allowed.allowed is True


NO_TERMS = Terms()


class Subject(Struct, frozen=True):
    """A body, as rules see it."""

    id: str
    groups: tuple[str, ...] = ()
    static: bool = False


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
        self._kinds: list[Kind] = []
        self._bodies: list[list[int]] = []
        self.kind_of: list[int] = []
        self._terms: dict[tuple[int, int], Terms] = {}  # of kinds
        self._named_terms: dict[tuple[int, int], Terms] = {}
        chosen_by, about = self._sort_rules()
        numbers: dict[tuple[object, ...], int] = {}
        for index, body in enumerate(subjects):
            ignored = ignored_groups.intersection(body.groups)
            fixed = body.static and not check_static
            alike = (tuple(chosen_by[index]), ignored, fixed)
            number = numbers.setdefault(alike, len(self._kinds))
            if number == len(self._kinds):
                sides = _sides_of(chosen_by[index], about)
                self._kinds.append(Kind(sides, ignored, fixed))
                self._bodies.append([])
            self._bodies[number].append(index)
            self.kind_of.append(number)

    def _sort_rules(self) -> tuple[list[list[int]], list[list[tuple[int, int]]]]:
        """Names the pairs of some rules. Of the others: for each body the numbers of the sets that
        it is in, and for each of these sets the rules and the sides of which it is the members."""
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
            if (sides & A and others.get(number, 0) & B)
            or (sides & B and others.get(number, 0) & A)
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
        values = [0.0] * self._count
        for rule, sides in zip(self.rules, self._sides, strict=True):
            value = getattr(rule, key) or 0.0
            for body in (*sides[0], *sides[1]) if value else ():
                values[body] = max(values[body], value)
        return values

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
        rows = PairRows(self._kinds, self.rules, self._sides, self._bodies)
        for kind, bodies in zip(self._kinds, self._bodies, strict=True):
            asked = everyone & ~rows.ignored(kind)
            total += ones(asked, bodies)
            allowed += ones(asked & rows.allowed(kind), bodies)
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
        kinds_in = dict.fromkeys(members for pair in self._sides for members in pair)
        kind_sets = {
            members: frozenset(map(self.kind_of.__getitem__, members)) for members in kinds_in
        }
        sides = [(kind_sets[a], kind_sets[b]) for a, b in self._sides]
        rows = PairRows(self._kinds, self.rules, sides, alone)
        taken_back = {
            tuple(sorted((self.kind_of[i], self.kind_of[j])))
            for i, j in self._named
            if self.is_asked(i, j)
        }
        exempt: list[tuple[int, int]] = []
        for number, kind in enumerate(self._kinds):
            row = (rows.ignored(kind) | rows.allowed(kind)) >> number
            while row and len(exempt) < _MOST_KINDS:
                lowest = row & -row
                pair = (number, number + lowest.bit_length() - 1)
                row ^= lowest
                if pair not in taken_back:
                    exempt.append(pair)
        return exempt


def _sides_of(
    sets: Iterable[int], about: Sequence[Sequence[tuple[int, int]]]
) -> tuple[tuple[int, int], ...]:
    """Of a body that is in these sets: number of a rule -> its sides, in the order of the rules."""
    sides: dict[int, int] = {}
    for number in sets:
        for rule, side in about[number]:
            sides[rule] = sides.get(rule, 0) | side
    return tuple(sorted(sides.items()))


class _Members:
    """Bodies by selector."""

    def __init__(self, subjects: Sequence[Subject]) -> None:
        self._found: dict[Selector, frozenset[int]] = {}
        self._by_id: dict[str, list[int]] = {body.id: [k] for k, body in enumerate(subjects)}
        self._by_group: dict[str, list[int]] = {}
        for k, body in enumerate(subjects):
            for group in dict.fromkeys(body.groups):
                self._by_group.setdefault(group, []).append(k)

    def of(self, selector: Selector) -> frozenset[int]:
        if selector not in self._found:
            self._found[selector] = frozenset(self._choose(selector))
        return self._found[selector]

    def _choose(self, selector: Selector) -> Iterable[int]:
        known = self._by_group if selector.of_groups else self._by_id
        return (k for name in selector.choose(known) for k in known[name])
