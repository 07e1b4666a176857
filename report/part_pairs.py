"""The convex parts of two bodies in a report, and which of them overlap."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from satcheck.report.values import Count, Length, Value, Vector

PartRelation = Literal["penetrating", "touching", "indeterminate"]
PartMethod = Literal["none", "sat", "gjk", "gjk+epa", "portal", "exact"]


class PartPair(Value, frozen=True):
    """A part of A and one of B that are not separated.

    a, b: their names, `kettle#3` is the third part of the body `kettle`; `satcheck decompose` names
    it `kettle-3`. relation: with the touch band of the bodies; indeterminate: it is undecided.
    depth: the length of the shortest translation that ends their overlap; None: not known. axis:
    the unit vector from A to B along which A retreats; None: there is none. method: what decided.
    axes_tested: by sat. iterations: of gjk and epa.
    """

    a: str
    b: str
    relation: PartRelation
    depth: Length | None
    axis: Vector | None
    method: PartMethod
    axes_tested: Count
    iterations: Count


class PartPairs(Value, frozen=True):
    """The convex parts of a pair of bodies. They judge nothing: the verdict is that of the bodies.

    parts: the number of parts of A and of B. A convex body is its own part; 0: it was not split.
    pairs: the deepest first, then the undecided ones, then those that touch. overlapping,
    undecided, touching: their numbers, including those that are not listed. untested: the number of
    pairs of parts that were not tested, because the boxes of too many meet. remark: why there are
    no parts, or how parts and bodies disagree, with the measured error that explains it
    (`part_error` of a body); None: they agree.
    """

    parts: tuple[Count, Count] = (0, 0)
    pairs: tuple[PartPair, ...] = ()
    overlapping: Count = 0
    undecided: Count = 0
    touching: Count = 0
    untested: Count = 0
    remark: str | None = None

    def overlapping_parts(self) -> tuple[list[int], list[int]]:
        """Return the numbers of the parts of A, and of B, in listed pairs that overlap."""
        deep = [pair for pair in self.pairs if pair.relation == "penetrating"]
        return _numbers(pair.a for pair in deep), _numbers(pair.b for pair in deep)

    @property
    def known(self) -> bool:
        """Return whether both bodies have parts."""
        return all(self.parts)


def number_of(name: str) -> int:
    """Return the 3 of `kettle#3`."""
    return int(name.rpartition("#")[2])


def _numbers(names: Iterable[str]) -> list[int]:
    return sorted(set(map(number_of, names)))
