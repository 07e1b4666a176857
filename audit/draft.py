"""What is known of a pair: each stage adds what it finds, and the finding is made of it."""

from __future__ import annotations

from time import perf_counter_ns
from typing import TYPE_CHECKING, Literal

from msgspec import Struct, field

from satcheck.audit.pair import Pair
from satcheck.report.judge import EXACT_WIDTH, Judgement, quality_of
from satcheck.report.report import (
    Ball,
    Finding,
    Issue,
    Relation,
    Stage,
    Vector,
    Witness,
    finding_id,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from satcheck import core
    from satcheck.core.curved.signed import Signed
    from satcheck.report.baseline import UndecidedBy
    from satcheck.report.contacts import Components, Contacts
    from satcheck.report.part_pairs import PartPairs
    from satcheck.report.values import Interval

NANOSECONDS_PER_MICROSECOND = 1000.0
Side = Literal["open", "within", "deeper", "hidden"]


class Band(Struct, frozen=True):
    """Whether an overlap is within the tolerance. side: as of core.Climb.band. move: a translation
    of A, at most the tolerance long, after which it is free; None: none was found. why: it is
    hidden. unexcused: why surfaces that may be off do not explain it; None: not known."""

    side: Side
    move: Vector | None = None
    why: str = "rounding hides whether the overlap is within the tolerance"
    unexcused: str | None = None


class Escape(Struct, frozen=True):
    """A translation of A, world units. normal: unit, from A to B, along which A retreats. verified:
    A's mesh, moved, has no common interior with B.

    bound: then an upper bound of the depth, its length plus the rounding of A's moved coordinates
    (0.0 where there is none); inf when not verified.
    """

    mtv: Vector
    normal: Vector
    verified: bool
    bound: float


class Depth(Struct, frozen=True):
    """World units: lower <= true depth <= upper.

    escape: the translation that was verified, which may be longer than the depth by what
    verification asked for. witness: with witness_b - witness_a = -upper * normal to rounding, known
    for convex pairs.
    """

    lower: float
    upper: float
    escape: Escape
    witness: Witness | None = None

    @property
    def normal(self) -> Vector:
        return self.escape.normal


class Gap(Struct, frozen=True):
    """The distance, world units: lower <= true distance <= upper (inf: unknown), rounding included.

    within: it is at most the tolerance; kept: it is at least the clearance. Where the bounds leave
    that open it is decided exactly; None: it cannot be. distance: the figure; None where none was
    measured. normal: unit, from A to B; None where the points coincide. witness: the closest
    points.
    """

    lower: float
    upper: float
    within: bool | None
    kept: bool | None
    distance: float | None = None
    normal: Vector | None = None
    witness: Witness | None = None

    @property
    def exact(self) -> bool:
        """Return whether only rounding is between the bounds."""
        return self.upper - self.lower <= EXACT_WIDTH * self.upper


class Thickness(Struct, frozen=True):
    """World units: lower <= true thickness <= upper. ball: proven to lie in both bodies, as thick
    as lower; None where that is 0. proof: of upper, where certificates are asked for."""

    lower: float
    upper: float
    ball: Ball | None = None
    proof: core.ThicknessProof | None = None


class Draft(Struct, eq=False):
    """A pair, and what its stages have found so far.

    stages: those that ran, in order, each with the time since the one before. issues: warnings
    about the pair.

    Of the stage `relation`, without a touch band. exact: how the bodies relate. exact_proven: False
    if --accuracy or a degenerate contact leaves it open. weak: why, unless --accuracy is the
    reason. overlaps: an overlap is proven, but it is open whether one body contains the other.
    gap_lower: a proven lower bound of the distance; 0.0: none is known. signed: the signed distance
    of two convex bodies, if it decides everything about them. crossing: indices of one triangle of
    each body that meet; point: a common point, rounded. climb: of the core, if it settled the pair.

    With the touch band. relation, and proven: whether it is. exact_relation: as `exact`; None: not
    shown. reason: why an answer is missing or weaker than a proof. gap: of bodies without a common
    interior. band: of an overlap. ahead: waits for the search for the thickness that runs beside
    that for the depth, and returns its nanoseconds, too. The figures are None if they were not
    requested. disputed: the answer of another library that contradicts the relation. work: steps of
    the searches for the depth and the thickness. reason_code: why the relation is open, where the
    input is the cause. steps: of the climb. wants_more: with more of them it may prove more.
    """

    pair: Pair
    stages: list[Stage] = field(default_factory=list)
    issues: list[Issue] = field(default_factory=list)
    since: int = field(default_factory=perf_counter_ns)
    exact: Relation = "indeterminate"
    exact_proven: bool = False
    weak: str | None = None
    overlaps: bool = False
    gap_lower: float = 0.0
    signed: core.PairResult | Signed | None = None
    crossing: tuple[int, int] | None = None
    point: Vector | None = None
    climb: core.Climb | None = None
    relation: Relation = "indeterminate"
    proven: bool = True
    exact_relation: Relation | None = None
    reason: str | None = None
    gap: Gap | None = None
    band: Band | None = None
    depth: Depth | None = None
    thickness: Thickness | None = None
    ahead: Callable[[], tuple[core.ThicknessInterval, int]] | None = None
    volume: float | None = None
    volume_error: float | None = None
    contacts: Contacts | None = None
    components: Components | None = None
    part_pairs: PartPairs | None = None
    disputed: str | None = None
    work: int = 0
    reason_code: UndecidedBy | None = None
    steps: int = 0
    wants_more: bool = False

    def record(self, stage: str, result: str, detail: str = "", earlier: int = 0) -> None:
        """Add a stage that has ended now. earlier: nanoseconds that it ran before the last one."""
        now = perf_counter_ns()
        elapsed = (now - self.since + earlier) / NANOSECONDS_PER_MICROSECOND
        self.stages.append(Stage(stage, result, elapsed, detail))
        self.since = now

    def add(self, stage: str, result: str, detail: str, nanoseconds: int) -> None:
        """Add a stage that ran elsewhere."""
        elapsed = nanoseconds / NANOSECONDS_PER_MICROSECOND
        self.stages.append(Stage(stage, result, elapsed, detail))

    def complain(self, code: str, body: str | None, message: str) -> None:
        """Add a warning about this pair; the same one from several pairs is reported once."""
        self.issues.append(Issue(code, "warning", body, None, message))

    def found(
        self,
        exact: Relation,
        proven: bool,
        gap_lower: float = 0.0,
        signed: core.PairResult | Signed | None = None,
        *,
        weak: str | None = None,
        overlaps: bool = False,
    ) -> None:
        """Set how the bodies relate, without a touch band."""
        self.exact, self.exact_proven, self.gap_lower = exact, proven, gap_lower
        self.signed, self.weak, self.overlaps = signed, weak, overlaps

    @property
    def depth_bounds(self) -> Interval | None:
        return None if self.depth is None else (self.depth.lower, self.depth.upper)

    @property
    def thickness_bounds(self) -> Interval | None:
        return None if self.thickness is None else (self.thickness.lower, self.thickness.upper)

    def finding(self, judgement: Judgement) -> Finding:
        """Return the finding, without a message."""
        pair, depth, thick = self.pair, self.depth, self.thickness
        gap = self.gap if pair.request.wants("distance") else None
        if gap is not None and gap.distance is None:
            gap = None
        figure = gap if depth is None else depth  # a pair has at most one of them
        depths = self.depth_bounds
        gaps = None
        if gap is not None and (pair.closer > 0 or not gap.exact):
            gaps = gap.lower, gap.upper
        return Finding(
            id=finding_id(pair.a.id, pair.b.id),
            a=pair.a.id,
            b=pair.b.id,
            rule=judgement.rule,
            severity=judgement.severity,
            undecided=judgement.undecided,
            relation=self.relation,
            exact_relation=self.exact_relation,
            tolerance=pair.tolerance,
            distance=None if gap is None else gap.distance,
            distance_bounds=gaps,
            depth=None if depth is None else depth.upper,
            depth_bounds=depths,
            quality=quality_of(depths, gaps) if self.proven else "estimate",
            normal=None if figure is None else figure.normal,
            mtv=None if depth is None else depth.escape.mtv,
            mtv_moves=None if depth is None else "a",
            mtv_verified=None if depth is None else depth.escape.verified,
            witness=None if figure is None else figure.witness,
            thickness=None if thick is None else thick.upper,
            thickness_bounds=self.thickness_bounds,
            ball=None if thick is None else thick.ball,
            volume=self.volume,
            volume_error=self.volume_error,
            contacts=self.contacts,
            components=self.components,
            part_pairs=self.part_pairs,
            reason=self.reason or judgement.reason,
            reason_code=self.reason_code if judgement.undecided == "relation" else None,
            plan=tuple(self.stages),
        )

    def indeterminate(self, reason: str) -> Finding:
        """Return the finding of a pair whose relation is not decided."""
        a, b = self.pair.a.id, self.pair.b.id
        # With a clearance it is open too whether the surfaces keep it.
        code = None if self.pair.request.clearance else self.reason_code
        return indeterminate(a, b, reason, self.stages, code)


def indeterminate(
    a: str,
    b: str,
    reason: str,
    stages: list[Stage] | None = None,
    reason_code: UndecidedBy | None = None,
) -> Finding:
    """Return the finding of two bodies whose relation is not decided."""
    return Finding(
        id=finding_id(a, b),
        a=a,
        b=b,
        severity="warning",
        undecided="relation",
        relation="indeterminate",
        reason=reason,
        reason_code=reason_code,
        plan=tuple(stages or ()),
    )
