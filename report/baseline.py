"""A baseline: the known findings that a team accepts for now. `satcheck.baseline/1`."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Length, Value

SCHEMA: Literal["satcheck.baseline/1"] = "satcheck.baseline/1"
# The state of a finding compared with a baseline. unchanged: known, and proven to be no worse.
# accepted: known, and accepted without that proof. undecided: known, but it is open whether it is
# worse.
BaselineState = Literal["new", "unchanged", "accepted", "worse", "undecided"]
# The states of findings that do not make a check fail.
HELD: tuple[BaselineState, ...] = ("unchanged", "accepted")
KnownRelation = Literal[
    "separated", "near", "touching", "penetrating", "contains", "inside", "coincident"
]
# Why the relation of a pair is undecided, where the input is the cause. open-hole: what fills a
# hole decides it. open-pieces: open pieces surround a body. units-unknown: no unit is common.
UndecidedBy = Literal["open-hole", "open-pieces", "units-unknown"]
Figure = Literal["depth", "thickness", "volume", "distance", "motion_depth", "motion_distance"]


class KnownFinding(Value, frozen=True, kw_only=True):
    """asset: for `satcheck batch`, the asset relative to the folder of the baseline; "" for other
    checks. a, b: ids of bodies. severity, relation and figures: as accepted. units: of the figures;
    None: unknown. depth, thickness, volume: upper ends. distance: the lower end. motion_depth,
    motion_distance: of the worst pose of a motion. unmeasured: an overlap that is accepted without
    figures, however deep it gets. reason: a text that says why the finding is accepted."""

    asset: str = ""
    a: str
    b: str
    severity: Literal["error", "warning", "note"]
    relation: KnownRelation
    units: str | None = None
    depth: Length | None = None
    thickness: Length | None = None
    volume: Length | None = None
    distance: Length | None = None
    motion_depth: Length | None = None
    motion_distance: Length | None = None
    unmeasured: bool = False
    reason: str = ""

    @property
    def key(self) -> tuple[str, frozenset[str]]:
        """The same in either order of the bodies."""
        return self.asset, frozenset((self.a, self.b))

    @property
    def moves(self) -> bool:
        return self.motion_depth is not None or self.motion_distance is not None

    def figure(self, name: Figure) -> float | None:
        figure: float | None = getattr(self, name)
        return figure


class KnownUndecided(Value, frozen=True, kw_only=True):
    """A pair that may stay undecided for the same reason. asset, a, b: as above. reason_code: of
    the finding. reason: a text that says why this is accepted."""

    asset: str = ""
    a: str
    b: str
    reason_code: UndecidedBy
    reason: str = ""

    @property
    def key(self) -> tuple[str, frozenset[str]]:
        """The same in either order of the bodies."""
        return self.asset, frozenset((self.a, self.b))


class Baseline(Value, frozen=True, kw_only=True):
    schema: Literal["satcheck.baseline/1"] = SCHEMA
    findings: tuple[KnownFinding, ...] = ()
    undecided: tuple[KnownUndecided, ...] = ()

    @property
    def assets(self) -> list[str]:
        """That of each entry."""
        return [*(each.asset for each in self.findings), *(each.asset for each in self.undecided)]


class StatedBaseline(Value, frozen=True):
    """The baseline that a report was compared with. absent: known findings of pairs that were
    checked again and pass now."""

    file: str
    absent: tuple[KnownFinding, ...]
