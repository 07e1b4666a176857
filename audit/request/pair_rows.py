"""The matrix of pairs by rows: a row is a number, its bits are those of the pairs of one body.

Bit operations on such rows count what rules say about fifty million pairs.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from msgspec import Struct

from satcheck.scene.rules import Rule

# Which side of a rule a body is on; it may be on both.
A, B = 1, 2


class Kind(Struct, frozen=True):
    """sides: number of a rule -> on which sides of it the bodies are, in the order of the rules."""

    sides: tuple[tuple[int, int], ...]
    ignored_groups: frozenset[str]
    fixed: bool


class PairRows:
    """Rows of the matrix of pairs of members, bodies or kinds, as the bits of a number each.

    sides: the members on either side of each rule. of_kinds: those of each kind.
    """

    def __init__(
        self,
        kinds: Sequence[Kind],
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


def ones(row: int, bodies: Sequence[int]) -> int:
    """Over all these bodies, the ones in the row but for the body itself."""
    return len(bodies) * row.bit_count() - (row & _row(bodies)).bit_count()
