"""The parts of certificates that all pairs of bodies have: axes and translations."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import chain
from typing import Any, TypeVar

from msgspec import UNSET, UnsetType

from satcheck.audit.pair import Pair
from satcheck.report.certificate import (
    AxisProof,
    Band,
    Certificate,
    Ends,
    Exact,
    ExactVector,
    Proof,
    SurfacesProof,
)
from satcheck.report.report import OVERLAPS, Finding
from satcheck.verify.exact import Rejected
from satcheck.verify.pairs import AnyPair, any_pair_of, vector

T = TypeVar("T")
# The candidates to try first, along and against each coordinate.
AXES: tuple[ExactVector, ...] = (
    (1.0, 0.0, 0.0),
    (-1.0, 0.0, 0.0),
    (0.0, 1.0, 0.0),
    (0.0, -1.0, 0.0),
    (0.0, 0.0, 1.0),
    (0.0, 0.0, -1.0),
)


def exact_number(value: Fraction) -> Exact:
    """A float where that is exact, else text."""
    rounded = float(value)
    exact = Fraction(rounded) == value
    return rounded if exact else f"{value.numerator}/{value.denominator}"


def exact_point(p: Iterable[Fraction]) -> ExactVector:
    x, y, z = map(exact_number, p)
    return x, y, z


def axis_of(n: Iterable[Any]) -> ExactVector:
    """A direction of floats, or of integers of any length, as text."""
    x, y, z = (str(c) if isinstance(c, int) else c for c in n)
    return x, y, z


def or_unset(value: T | None) -> T | UnsetType:
    return UNSET if value is None else value


def leading_axes(
    leads: Iterable[tuple[ExactVector, float | Fraction]],
) -> tuple[ExactVector, ExactVector] | None:
    """An axis along which A reaches at least as far as B, and one along which B does; along one of
    them farther. leads: axes, each with the sign of what A reaches beyond B."""
    found: dict[int, ExactVector] = {}
    for axis, lead in leads:
        found.setdefault((lead > 0) - (lead < 0), axis)
    a, b = found.get(1, found.get(0)), found.get(-1, found.get(0))
    return None if a is None or b is None or found.keys() == {0} else (a, b)


class Maker:
    """Makes a certificate for a finding. Meshes and curved shapes have their own ways to find axes
    and points."""

    def __init__(self, pair: Pair, finding: Finding) -> None:
        self.pair, self.finding = pair, finding
        self.bodies = pair.a.checked(), pair.b.checked()
        self.placed = any_pair_of(*self.bodies)
        self.closer = self.placed.closer

    def relation(self) -> Proof | None:
        raise NotImplementedError

    def hints(self) -> Iterator[Iterable[Any]]:
        """Yield directions along which the bodies may be apart, or overlap least."""
        raise NotImplementedError

    def freed(self, placed: AnyPair, move: tuple[float, float, float]) -> Proof | None:
        """Prove that A, moved and placed so, has no common interior with B."""
        raise NotImplementedError

    def gap(self) -> Ends | None:
        """Return points of convex bodies next to each other."""
        raise NotImplementedError

    def otherwise_in_band(self) -> Band | None:
        """Say why an overlap is within the touch band that is wider along all axes."""
        return None

    def certificate(self) -> Certificate:
        """Raises Rejected: no evidence was found."""
        finding = self.finding
        relation = self.relation()
        if relation is None:
            raise Rejected(f"no evidence was found for {finding.exact_relation!r}")
        mtv = gap = band = None
        if finding.mtv_verified and finding.mtv is not None:
            mtv = self.free(finding.mtv)
            if mtv is None:
                raise Rejected("no axis was found that shows that the translation ends the overlap")
        if finding.relation != finding.exact_relation:
            if finding.exact_relation == "separated":
                gap = self.gap()
            elif finding.exact_relation in OVERLAPS:
                band = self._band()
        shown = None if self.closer and isinstance(mtv, SurfacesProof) else mtv
        return Certificate(relation, or_unset(shown), gap=or_unset(gap), band=or_unset(band))

    def apart(self) -> AxisProof | None:
        """Find an axis that separates the bodies by as much as the finding says."""
        beyond = least = self.closer
        if self.finding.relation == "separated":
            beyond = max(Fraction(self.pair.tolerance), beyond)
            least += Fraction(self.pair.request.clearance or 0.0)
        for axis in self._axes():
            if at_least(self.placed, axis, beyond, 1) and at_least(self.placed, axis, least):
                return AxisProof(axis)
        return None

    def free(self, move: tuple[float, float, float]) -> Proof | None:
        """Prove that A, moved, has no common interior with B."""
        placed = any_pair_of(self.bodies[0].moved(list(move)), self.bodies[1])
        for axis in self._axes([-c for c in move]):
            if at_least(placed, axis, self.closer, int(self.closer > 0)):
                return AxisProof(axis)
        return self.freed(placed, move)

    def _axes(self, *first: Iterable[Any]) -> Iterator[ExactVector]:
        """The simplest first."""
        across, normal = self.pair.request.across, self.finding.normal
        for direction in chain(first, AXES, () if normal is None else (normal,), self.hints()):
            axis = axis_of(direction)
            if any(vector(axis)) and (across is None or not vector(axis)[across]):
                yield axis

    def _band(self) -> Band | None:
        """Say why an overlap is within the touch band; None: its way out does."""
        finding, band = self.finding, Fraction(self.pair.tolerance)
        if finding.mtv_verified and (finding.depth or 0.0) <= self.pair.tolerance:
            return None
        if self.placed.convex:
            for axis in self._axes():
                if at_least(self.placed, axis, -band):
                    return Band(axis)
        return self.otherwise_in_band()


def at_least(placed: AnyPair, axis: ExactVector, length: Fraction, sign: int = 0) -> bool:
    """Return whether the gap along an axis is at least a length; sign 1: and more than that."""
    try:
        return placed.gap(vector(axis), length) >= sign
    except Rejected:
        return False
