"""What the stages have found about a pair, and the finding before it is judged."""

from __future__ import annotations

from time import perf_counter_ns
from typing import TYPE_CHECKING, Literal

from msgspec import Struct

from satcheck.audit.pair import Pair
from satcheck.core.conventions import Vector
from satcheck.report.judge import EXACT_WIDTH, quality_of
from satcheck.report.report import Ball, Finding, Issue, Relation, Stage, Witness, finding_id

if TYPE_CHECKING:
    from satcheck import core
    from satcheck.core import Climb
    from satcheck.core.curved.signed import Signed
    from satcheck.report.components import Components
    from satcheck.report.contacts import Contacts


NANOSECONDS_PER_MICROSECOND = 1000.0


class Trace:
    """Stages in the order they ran, each with the time since the one before."""

    __slots__ = ("_since", "issues", "stages")

    def __init__(self) -> None:
        self.stages: list[Stage] = []
        self.issues: list[Issue] = []
        self._since = perf_counter_ns()

    def record(self, stage: str, result: str, detail: str = "") -> None:
        now = perf_counter_ns()
        elapsed = (now - self._since) / NANOSECONDS_PER_MICROSECOND
        self.stages.append(Stage(stage, result, elapsed, detail))
        self._since = now

    def add_since(self, stage: str, result: str, detail: str, nanoseconds: int) -> None:
        """Records a stage of which this much time ran earlier, elsewhere."""
        self._since -= nanoseconds
        self.record(stage, result, detail)

    def climbed(self, climb: Climb) -> None:
        """Records the rungs of the core, with its texts."""
        self.stages += climb.stages(Stage)

    def add(self, stage: str, result: str, detail: str, nanoseconds: int) -> None:
        """Records a stage that ran elsewhere."""
        elapsed = nanoseconds / NANOSECONDS_PER_MICROSECOND
        self.stages.append(Stage(stage, result, elapsed, detail))

    def complain(self, code: str, body: str | None, message: str) -> None:
        """A warning about this pair; the same one from several pairs is reported once."""
        self.issues.append(Issue(code, "warning", body, None, message))


class Verdict(Struct, frozen=True):
    """How two bodies relate, without a touch band.

    proven: False if --accuracy or a degenerate contact leaves the relation open. overlaps: an
    overlap is proven, but it is open whether one body contains the other. gap_lower: a proven lower
    bound of the distance; 0.0: none is known. signed_distance: of two convex bodies, if it decides
    everything about them. crossing: indices of one triangle of each body that meet; point: a common
    point, rounded. reason: why the relation is not proven, unless --accuracy is the reason. climb:
    of the core, if the core settled the pair.
    """

    relation: Relation
    proven: bool
    gap_lower: float = 0.0
    signed_distance: core.PairResult | Signed | None = None
    crossing: tuple[int, int] | None = None
    point: Vector | None = None
    reason: str | None = None
    climb: core.Climb | None = None
    overlaps: bool = False


Side = Literal["open", "within", "deeper", "hidden"]


class Band(Struct, frozen=True):
    """Whether an overlap is within the tolerance. side: as of core.Climb.band. move: a translation
    of A, at most the tolerance long, after which it is free; None: none was found. why: it is
    hidden. unexcused: why surfaces that may be off do not explain it; None: not known."""

    side: Side
    move: Vector | None = None
    why: str = "rounding hides whether the overlap is within the tolerance"
    unexcused: str | None = None


class Depth(Struct, frozen=True):
    """World units: lower <= true depth <= upper.

    normal: unit, from A to B, along which A retreats; escape: the translation that was verified,
    which may be longer than the depth by what verification asked for. witness: with
    witness_b - witness_a = -upper * normal to rounding, known for convex pairs.
    """

    lower: float
    upper: float
    normal: Vector
    escape: Escape
    witness: Witness | None = None


class Escape(Struct, frozen=True):
    """A translation of A, world units. verified: A's mesh, moved, has no common interior with B.

    bound: then an upper bound of the depth, its length plus the rounding of A's moved coordinates
    (0.0 where there is none); inf when not verified.
    """

    mtv: Vector
    verified: bool
    bound: float


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
        """Whether only rounding is between the bounds."""
        return self.upper - self.lower <= EXACT_WIDTH * self.upper


class Thickness(Struct, frozen=True):
    """World units: lower <= true thickness <= upper. ball: proven to lie in both bodies, as thick
    as lower; None where that is 0. proof: of upper, where certificates are asked for."""

    lower: float
    upper: float
    ball: Ball | None = None
    proof: core.ThicknessProof | None = None


class CommonVolume(Struct, frozen=True):
    """volume and error: None where refused; refusal: why."""

    volume: float | None = None
    error: float | None = None
    refusal: str | None = None

    @property
    def bounds(self) -> tuple[float, float] | tuple[None, None]:
        """As far as the error tells; None: not known."""
        if self.volume is None or self.error is None:
            return None, None
        return self.volume - self.error, self.volume + self.error


class Draft(Struct):
    """Each stage fills in what it finds. verdict: of the ladder.

    relation: with the touch band. exact_relation: without it; None: not proven. proven: the
    relation, with the touch band. gap: of bodies without a common interior. band: of an overlap.
    depth, thickness, volume, contacts and components are None if they were not requested.
    """

    pair: Pair
    trace: Trace
    verdict: Verdict
    relation: Relation = "indeterminate"
    exact_relation: Relation | None = None
    proven: bool = True
    reason: str | None = None
    gap: Gap | None = None
    band: Band | None = None
    depth: Depth | None = None
    thickness: Thickness | None = None
    volume: CommonVolume | None = None
    contacts: Contacts | None = None
    components: Components | None = None

    def finding(self) -> Finding:
        """Return the finding, not yet judged."""
        pair, depth, thick, volume = self.pair, self.depth, self.thickness, self.volume
        gap = self.gap if pair.request.clearance is not None else None
        if gap is not None and gap.distance is None:
            gap = None
        figure = gap if depth is None else depth  # a pair has at most one of them
        depths = None if depth is None else (depth.lower, depth.upper)
        gaps = None
        if gap is not None and (pair.closer > 0 or not gap.exact):
            gaps = gap.lower, gap.upper
        return Finding(
            id=finding_id(pair.a.id, pair.b.id),
            a=pair.a.id,
            b=pair.b.id,
            severity="none",
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
            thickness_bounds=None if thick is None else (thick.lower, thick.upper),
            ball=None if thick is None else thick.ball,
            volume=None if volume is None else volume.volume,
            volume_error=None if volume is None else volume.error,
            contacts=self.contacts,
            components=self.components,
            reason=self.reason,
            plan=tuple(self.trace.stages),
        )
