"""The report: plain frozen data, `satcheck.report/1`.

World frame, right-handed, lengths in the units of the files. `normal` is a unit vector from A to B.
`distance` is a gap >= 0. `depth` is the length of the shortest translation of A after which A and B
have no common interior. `mtv` is the translation to add to A. A figure that was not computed is
None, never 0.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args

from msgspec import UNSET, Meta, UnsetType, to_builtins

from satcheck.report.baseline import BaselineState, StatedBaseline, UndecidedBy
from satcheck.report.bodies import BodyReport as BodyReport
from satcheck.report.bodies import PartError as PartError
from satcheck.report.certificate import Certificate
from satcheck.report.contacts import Components, Contacts
from satcheck.report.part_pairs import PartPairs
from satcheck.report.regions import InsideFinding, Regions
from satcheck.report.settings import StatedConfig, StatedReading, StatedSettings
from satcheck.report.statics import Statics, SupportFinding
from satcheck.report.sweep import StatedMotion, Sweep
from satcheck.report.values import Code, Count, Interval, Length, Value
from satcheck.report.values import Quality as Quality
from satcheck.report.values import Relation as Relation
from satcheck.report.values import Tool as Tool
from satcheck.report.values import Vector as Vector
from satcheck.report.values import Verdict as Verdict

if TYPE_CHECKING:
    import pandas

# The answer to a question of a rule about a single body.
BodyAnswer = SupportFinding | InsideFinding

_ID_DIGITS = 12
SCHEMA: Literal["satcheck.report/1"] = "satcheck.report/1"

# The severity of a finding, worst first. silenced: an error whose severity a rule sets to `none`.
# none: no problem.
Severity = Literal["error", "warning", "note", "silenced", "none"]
SEVERITIES: tuple[Severity, ...] = get_args(Severity)
# The undecided question about a pair. relation: how the bodies relate. inside: whether one lies in
# the other. limit: whether an overlap is within its limits, or a gap keeps its clearance. motion:
# whether the bodies hit while they move. cross-check: another library contradicts the answer.
Undecided = Literal["relation", "inside", "limit", "motion", "cross-check"]
Effect = Literal[
    "overlap",
    "depth",
    "thickness",
    "distance",
    "volume",
    "contacts",
    "components",
    "part-pairs",
    "cross-check",
    "certificate",
    "sweep",
]
EFFECTS: tuple[Effect, ...] = get_args(Effect)
RELATIONS: tuple[Relation, ...] = get_args(Relation)
# The stage of a trace with the result of other libraries: "agrees", "disagrees" or "no answer".
CROSS_CHECK = "cross-check"
NO_ANSWER = "no answer"
# The result of an effect that needs triangles, for a pair with a curved shape.
NOT_AVAILABLE = "not available"
ON_TRIANGLES: tuple[Effect, ...] = ("volume", "contacts", "components", "cross-check")
# Why an effect did not run on a pair that fails: other pairs of the scene have spent the steps.
BEYOND_BUDGET = "beyond the budget of the scene"
# The code of an issue about a pair that failed because of a bug in satcheck.
INTERNAL_ERROR = "internal-error"
# No pair is checked: all are within one link, allowed, or exempt.
NOTHING_TO_CHECK = "nothing-to-check"
# After so many findings that fail, or that the steps of the scene leave undecided, the other close
# pairs are not examined: a kilobyte of instances at one place has millions of them. The same after
# so many that are not separated, and 13 for each body: in a lattice of boxes one meets 26 others.
# An issue with this code says so.
ENOUGH_FAILURES = 20_000
MEETINGS_OF_BODY = 13
STOPPED_EARLY = "stopped-early"
# The scene has no body that can collide.
NOTHING_TO_COMPARE = "nothing-to-compare"
# The codes of issues about bodies that nothing holds, and of which that is open.
UNSUPPORTED = "unsupported"
GRAVITY_ASSUMED = "gravity-assumed"
SUPPORT_OPEN = "support-open"
OUTSIDE_REGION = "outside-region"
REGION_OPEN = "region-open"
# Codes of issues that repeat the answers about single bodies, for formats without these.
OF_ANSWERS = (UNSUPPORTED, SUPPORT_OPEN, OUTSIDE_REGION, REGION_OPEN)
# Codes of warnings about sizes that make an answer doubtful.
TOLERANCE_LARGE = "tolerance-large"
SIZES_DIFFER = "sizes-differ"
# Relations with a common interior, the ones that have a depth.
OVERLAPS: frozenset[str] = frozenset({"penetrating", "contains", "inside", "coincident"})


class PairCounts(Value, frozen=True):
    """total = pruned + decided + allowed + indeterminate.

    Pruned: the world boxes are so far apart that no figure is needed. Allowed: the scene permits
    contact, and nothing was computed. Exempt: pairs within an ignored group, and pairs of static
    bodies; they are not part of the total.
    """

    total: Count
    pruned: Count
    decided: Count
    allowed: Count
    indeterminate: Count
    exempt: Count = 0

    @property
    def asked(self) -> int:
        """The number of pairs that are checked."""
        return self.total - self.allowed


class Summary(Value, frozen=True):
    """by_relation counts every pair that is not allowed; pruned pairs count as separated.

    surfaces_only: the number of pairs of which one body may enter the other during the motion,
    because the fills of holes are not swept (0 with Settings.allow_open). limits_undecided: the
    number of pairs for which it is undecided whether an overlap is within the limits of its rules,
    or a gap keeps its clearance, at rest or in motion. sweeps_undecided: the number of pairs for
    which it is undecided whether they hit while they move. disputed: the number of pairs for which
    another library contradicts the answer (Settings.cross_check). accepted: the number of findings
    that the baseline holds. They do not make the check fail.
    """

    verdict: Verdict
    pairs: PairCounts
    by_relation: Mapping[Relation, Count]
    surfaces_only: Count = 0
    limits_undecided: Count = 0
    sweeps_undecided: Count = 0
    disputed: Count = 0
    accepted: Count = 0


class Truncated(Value, frozen=True):
    """The number of pairs that `findings` leaves out, and the reason."""

    pairs: Annotated[int, Meta(ge=1)]
    reason: str


class Stage(Value, frozen=True):
    """One step of the trace of a pair: its name, its result, its cost, and why it settled nothing.

    microseconds: left out of a document without timings.
    """

    stage: str
    result: str
    microseconds: Length = 0.0
    detail: str = ""


class Witness(Value, frozen=True):
    """World points, one for each body: the nearest points, or a common point."""

    a: Vector
    b: Vector


class Ball(Value, frozen=True):
    """A ball in the world that is proven to lie in both bodies."""

    centre: Vector
    radius: Length


class Finding(Value, frozen=True, kw_only=True):
    """The result for one pair.

    relation: with the touch band, as the bodies are placed; for moving bodies, the worst relation
    of the motion. placed_relation: for moving bodies, the relation as placed. exact_relation: as
    placed, without the band; None: --accuracy left it open, or it is unknown for curves that
    polygons replace. tolerance: half width of the touch band of this pair.
    quality: the weakest quality of relation, depth and gap. exact: proven, numbers up to rounding.
    bounded: the relation is proven, and the depth or the gap is a proven interval. estimate: not
    proven.
    message: a sentence that says all this of the bodies, by the names that people know.
    rule: what decided the severity, if it is not the default: "clearance", or the name of a rule.
    undecided: the question that could not be decided; the severity is then at least a warning.
    distance: the gap of bodies without a common interior; also None if it was not requested, or if
    it is known to exceed the clearance without being measured. distance_bounds: contain the true
    gap where the distance is not exact: polygons replace curves in a check in a plane, and distance
    is the gap of the polygons; the fill of a hole may be nearer; the gap of curved shapes is tiny.
    thickness: of an overlap, the diameter of the largest ball that lies in both bodies, stated as
    the upper end of thickness_bounds, which contain it. ball: a ball of their lower end; None if
    that is 0. Both are also None if they were not requested, or if a body is not closed. volume: of
    the overlap. volume_error: the approximate error of the volume, not proven (0.0: the volume is
    exactly 0.0).
    None of these weakens the quality.
    depth_bounds: contain the true depth. depth: their upper end. mtv: about -depth * normal; it may
    be a little longer, so that the moved mesh is verified free. motion: the sweep; None: the bodies
    do not move relative to each other, or their boxes stay apart. relation, severity and undecided
    include it; figures are as placed. certificate: what `satcheck verify` checks; None: not
    requested, or nothing is proven, and the last stage of the plan says why. reason: why the
    result is not exact; of a finding that is worse than the baseline, first what the baseline has.
    reason_code: of an undecided relation, where the input is the cause. baseline_state: for a
    failing finding, if the check has a baseline, and for an undecided one that the baseline
    accepts.
    """

    id: str
    a: str
    b: str
    rule: str | None = None
    severity: Severity
    message: str = ""
    undecided: Undecided | None = None
    relation: Relation
    placed_relation: Relation | None = None
    exact_relation: Relation | None = None
    tolerance: Length | None = None
    distance: Length | None = None
    distance_bounds: Interval | None = None
    depth: Length | None = None
    depth_bounds: Interval | None = None
    quality: Quality | None = None
    normal: Vector | None = None
    mtv: Vector | None = None
    mtv_moves: Literal["a"] | None = None
    mtv_verified: bool | None = None
    witness: Witness | None = None
    thickness: Length | None = None
    thickness_bounds: Interval | None = None
    ball: Ball | None = None
    volume: Length | None = None
    volume_error: Length | None = None
    contacts: Contacts | None = None
    components: Components | None = None
    part_pairs: PartPairs | None = None
    motion: Sweep | None = None
    certificate: Certificate | None = None
    reason: str | None = None
    reason_code: UndecidedBy | None = None
    plan: tuple[Stage, ...]
    baseline_state: BaselineState | None = None

    def __post_init__(self) -> None:
        figures = (
            *(self.tolerance, self.distance, self.depth, self.volume, self.volume_error),
            *(self.depth_bounds or ()),
            *(self.distance_bounds or ()),
            *(self.thickness_bounds or ()),
            *(self.normal or ()),
            *(self.mtv or ()),
        )
        if not all(map(math.isfinite, filter(None, figures))):
            raise ValueError(f"the figures of a pair are finite numbers: {figures}")

    @property
    def at_rest(self) -> Relation:
        """The relation of the bodies as placed."""
        return self.placed_relation or self.relation

    def to_dict(self, timings: bool = True) -> dict[str, Any]:
        """JSON values, as a report has them; no `microseconds` without timings. In a table of
        these, as `pandas.json_normalize` makes it, a vector is a list in one cell: the columns of
        `Report.to_dataframe` are the right ones for tables."""
        values: dict[str, Any] = plain(self)
        return values if timings else without_timings(values)


def finding_id(a: str, b: str) -> str:
    """Return an id that depends on the two bodies only, and not on their order, poses or result."""
    key = f"{a}\0{b}" if a < b else f"{b}\0{a}"
    return hashlib.sha256(key.encode(errors="surrogatepass")).hexdigest()[:_ID_DIGITS]


class EffectReport(Value, frozen=True):
    """An effect (a kind of computation) of a check, over all pairs.

    asked_by: the flags and rules that request it; empty: none does. pairs: the number of pairs on
    which it ran. not_run: reason -> number of pairs on which it did not run; with `pairs` the sum
    is all pairs. microseconds: of its stages.
    """

    effect: Effect
    asked_by: tuple[str, ...]
    pairs: Count
    not_run: Mapping[str, Count]
    microseconds: Length = 0.0


class Issue(Value, frozen=True):
    """A message about the input or the run, with a stable code. line: of the file, from 1. state:
    whether it blocks a pass, or would if nobody had accepted it; None: it blocks nothing."""

    code: Code
    severity: Literal["error", "warning", "note"]
    body: str | None
    file: str | None
    message: str
    line: Annotated[int, Meta(ge=1)] | None = None
    state: Literal["blocking", "accepted"] | None = None


class Exempt(Value, frozen=True):
    """The pairs that the scene neither checks nor counts: pairs within these groups, and pairs of
    static bodies."""

    groups: tuple[str, ...] = ()
    static_pairs: bool = False


# The value of a planar or a floating joint.
JointValues = Annotated[list[float], Meta(min_length=3, max_length=7)]


# A glob of ids, or "group:" and a glob of groups.
SelectorText = Annotated[str, Meta(min_length=1, pattern="^(?!group:$)")]


class RuleReport(Value, frozen=True):
    """A rule of the scene for the pairs with one body in each selector. None: the rule does not set
    the key.

    a, b: a glob of ids, or "group:" and a glob of groups. An id or group that is exactly the text
    overrides the glob. allowed: True: nothing is computed. max_depth, max_thickness, max_volume:
    limits of an overlap. clearance, tolerance: override the global ones. severity: of the errors of
    these pairs. where: the place of the rule.
    """

    a: SelectorText
    b: SelectorText
    allowed: bool | None
    max_depth: Length | None
    max_thickness: Length | None
    max_volume: Length | None
    clearance: Length | None
    tolerance: Length | None
    severity: Literal["error", "warning", "note", "none"] | None
    reason: str
    where: str

    @property
    def name(self) -> str:
        return self.where or f"{self.a} and {self.b}"


def all_allowed(counts: PairCounts, rules: Iterable[RuleReport], pose: object | None) -> bool:
    """Return whether rules, of a scene or of the files themselves, allow all pairs, so that nothing
    has to be compared. Robots do not count: shapes of one link are allowed without any rule. Nor
    does --between, which allows all that it leaves out. pose: of robots; None: there are none."""
    by_choice = any(rule.where.startswith("--between") for rule in rules)
    every = 0 < counts.total == counts.allowed and not counts.exempt
    return every and pose is None and not by_choice


class Report(Value, frozen=True, kw_only=True):
    """World frame, right-handed; lengths in the units of the files. A figure that was not computed
    is None, never 0. Numbers are finite.

    units: of all lengths; None: the unit of a body is unknown. message: PASS, FAIL, INCOMPLETE or
    ERROR, and why. pose: of the robots: joint ->
    radians, metres for a prismatic joint, [x, y, angle] for a planar one, [x, y, z, roll, pitch,
    yaw] for a floating one, [w, x, y, z] for a ball joint, [x, y, z, w, x, y, z] for a free one,
    without joints that mimic others; None without robots. rules: if several rules for a pair set
    the same key, the last one counts. findings: one for every checked pair, except those that
    `truncated` counts, in the order of the bodies. truncated: the pairs with separate boxes that
    are not listed, if there are more than 60 pairs; None: all pairs are listed. statics: the
    support of bodies; absent if no rule asks. regions: which bodies lie in which region; absent if
    no rule asks. reading: options with which the files were read;
    None: their formats leave no choice, or the defaults apply. baseline: that the check was
    compared with; None: none. config: the options that a config file set; None: no config file took
    effect.
    """

    schema: Literal["satcheck.report/1"] = SCHEMA
    tool: Tool
    units: str | None
    settings: StatedSettings
    summary: Summary
    message: str = ""
    reading: StatedReading | None = None
    pose: Mapping[str, float | JointValues] | None = None
    motions: tuple[StatedMotion, ...] = ()
    bodies: tuple[BodyReport, ...]
    exempt: Exempt = Exempt()
    rules: tuple[RuleReport, ...] = ()
    effects: tuple[EffectReport, ...] = ()
    findings: tuple[Finding, ...]
    issues: tuple[Issue, ...]
    truncated: Truncated | None = None
    statics: Statics | UnsetType = UNSET
    regions: Regions | UnsetType = UNSET
    baseline: StatedBaseline | None = None
    config: StatedConfig | None = None

    @property
    def support(self) -> Statics | None:
        """None: no rule asks."""
        return self.statics or None

    @property
    def answers(self) -> tuple[BodyAnswer, ...]:
        """To all questions of rules about single bodies."""
        held = () if self.support is None else self.support.findings
        return held + (self.regions.findings if self.regions else ())

    @property
    def alone(self) -> bool:
        """Return whether no pair has to be compared: the scene is one usable body, or none, or
        rules ask for regions only, or allow all pairs."""
        usable = all(body.triangles is not None for body in self.bodies)
        lone = len(self.bodies) < 2 and usable
        return lone or bool(self.regions) or all_allowed(self.summary.pairs, self.rules, self.pose)

    def to_dict(self, timings: bool = True) -> dict[str, Any]:
        """JSON values in the order of the schema; no `microseconds` without timings."""
        values: dict[str, Any] = plain(self)
        return values if timings else without_timings(values)

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame with a row for each finding, in their order, and a single value
        in each cell; a number that is None is NaN. Its columns are those of `report.rows.COLUMNS`:
        the fields of a finding by name; the lower ends of intervals (depth_lower), components
        (mtv_x, witness_a_x); fails: the check fails by the finding; baseline: baseline_state.

        Raises SatcheckError `missing-extra` without pandas.
        """
        from satcheck.report.rows import dataframe_of

        return dataframe_of(self)


def plain(value: object) -> Any:
    """JSON values of a report, or of a part of it."""
    return json.loads(json.dumps(to_builtins(value)))


def without_timings(values: Any) -> Any:
    """JSON values of a report, or of a part of it, without the times of stages."""
    if isinstance(values, list | tuple):
        return [without_timings(value) for value in values]
    if isinstance(values, dict):
        kept = ((key, value) for key, value in values.items() if key != "microseconds")
        return {key: without_timings(value) for key, value in kept}
    return values
