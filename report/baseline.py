"""A baseline: the findings that a team knows and accepts for now. `satcheck.baseline/1`."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Length, Relation, Value

SCHEMA: Literal["satcheck.baseline/1"] = "satcheck.baseline/1"
# Of a finding beside a baseline. unchanged: known, and not worse. unmeasured: known with a figure
# that this check did not compute.
BaselineState = Literal["new", "unchanged", "worse", "unmeasured"]


class KnownFinding(Value, frozen=True, kw_only=True):
    """asset: of `satcheck each`, relative to the folder of the baseline; "" of other checks. a, b:
    ids of bodies. relation, depth, distance: as accepted, in the units of the scene; the depth is
    an upper bound. reason: why it is accepted, for people."""

    asset: str = ""
    a: str
    b: str
    relation: Relation
    depth: Length | None = None
    distance: Length | None = None
    reason: str = ""

    @property
    def key(self) -> tuple[str, frozenset[str]]:
        """The same in either order of the bodies."""
        return self.asset, frozenset((self.a, self.b))


class Baseline(Value, frozen=True, kw_only=True):
    schema: Literal["satcheck.baseline/1"] = SCHEMA
    findings: tuple[KnownFinding, ...] = ()


class StatedBaseline(Value, frozen=True):
    """What a report says of the baseline that it was held against. absent: known findings of pairs
    that were checked again and pass now."""

    file: str
    absent: tuple[KnownFinding, ...]
