"""The matrix of pairs by rows. A row is an integer; its bits are the pairs of one body.

Bit operations on such rows evaluate the rules for fifty million pairs.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from msgspec import Struct

from satcheck.report.report import RuleReport

# The side of a rule that a body is on, as bits. A body may be on both.
A, B = 1, 2
# The members on either side of a rule.
Sides = tuple[frozenset[int], frozenset[int]]


class Kind(Struct, frozen=True):
    """A class of bodies that all rules treat alike. sides: (number of a rule, sides of the bodies)
    in the order of the rules. fixed: their pairs with each other are not checked."""

    sides: tuple[tuple[int, int], ...]
    ignored_groups: frozenset[str]
    fixed: bool


class PairRows:
    """Rows of the matrix of pairs of members.

    Members are bodies or kinds. Each row is an integer. sides: the members on either side of each
    rule. of_kinds: the members of each kind.
    """

    def __init__(
        self,
        kinds: Sequence[Kind],
        rules: Sequence[RuleReport],
        sides: Sequence[Sides],
        of_kinds: Sequence[Iterable[int]],
    ) -> None:
        self._rules, self._sides = rules, sides
        self._known: dict[tuple[int, int], int] = {}
        together: dict[str | None, list[int]] = {}
        for kind, members in zip(kinds, of_kinds, strict=True):
            for one in (*kind.ignored_groups, *([None] if kind.fixed else [])):
                together.setdefault(one, []).extend(members)
        self._together = {one: row_of(members) for one, members in together.items()}

    def ignored(self, kind: Kind) -> int:
        row = self._together[None] if kind.fixed else 0
        for group in kind.ignored_groups:
            row |= self._together[group]
        return row

    def allowed(self, kind: Kind) -> int:
        row = 0
        for number, sides in kind.sides:
            allowed = self._rules[number].allowed
            if allowed is None:
                continue
            others = (self._side(number, 1) if sides & A else 0) | (
                self._side(number, 0) if sides & B else 0
            )
            row = row | others if allowed else row & ~others
        return row

    def _side(self, number: int, side: int) -> int:
        """Rows are cached, except those of single members, which would fill the memory."""
        members = self._sides[number][side]
        if len(members) == 1:
            return row_of(members)
        if (number, side) not in self._known:
            self._known[number, side] = row_of(members)
        return self._known[number, side]


def row_of(members: Iterable[int]) -> int:
    """The integer with these bits set."""
    members = tuple(members)
    if len(members) == 1:
        return 1 << members[0]
    octets = bytearray(max(members, default=0) // 8 + 1)
    for k in members:
        octets[k >> 3] |= 1 << (k & 7)
    return int.from_bytes(octets, "little")


def ones(row: int, bodies: Sequence[int]) -> int:
    """The number of ones in the row, summed over these bodies; for each body without its own
    bit."""
    return len(bodies) * row.bit_count() - (row & row_of(bodies)).bit_count()
