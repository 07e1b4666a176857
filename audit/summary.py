"""The summary of a report, and its other parts that are not about one pair: its effects say what
required each, on how many pairs it ran, and why not on others."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from math import inf
from typing import TYPE_CHECKING

from satcheck._version import __version__
from satcheck.audit.acceptance import with_states
from satcheck.audit.bodies import PlacedBodies
from satcheck.audit.body import Box, PlacedBody
from satcheck.audit.planner import FOR_FAILURES, Planner
from satcheck.core.conventions import Plane, axes_of
from satcheck.core.errors import SatcheckError
from satcheck.report.bodies import Outline
from satcheck.report.report import (
    BEYOND_BUDGET,
    EFFECTS,
    ENOUGH_FAILURES,
    MEETINGS_OF_BODY,
    NO_ANSWER,
    NOTHING_TO_CHECK,
    NOTHING_TO_COMPARE,
    OVERLAPS,
    RELATIONS,
    SIZES_DIFFER,
    STOPPED_EARLY,
    TOLERANCE_LARGE,
    BodyReport,
    Effect,
    EffectReport,
    Finding,
    Issue,
    PairCounts,
    PartError,
    Report,
    Summary,
    Tool,
)
from satcheck.report.request import ON_REQUEST, Request
from satcheck.report.settings import StatedSettings
from satcheck.report.verdict import exempt_by, fails, unlisted_indeterminate
from satcheck.scene import Body, Unreadable
from satcheck.scene.bodies import Accepted
from satcheck.scene.planar.outline import Outline as FlatOutline
from satcheck.scene.words import listed

if TYPE_CHECKING:
    from satcheck.decompose import Decomposition
    from satcheck.scene import Scene

# Stages that are part of an effect of another name. All that no effect is named after decide the
# overlap.
_PART_OF = {"search": "depth", "verify": "depth"}
_ANSWERS: dict[Effect, Callable[[Finding], object]] = {
    "thickness": lambda finding: finding.thickness,
    **{effect: extra.answer for effect, extra in ON_REQUEST.items() if extra.answer},
}
NOT_ASKED = "not asked"
PRUNED = "boxes apart"
ALLOWED = "allowed"
UNREADABLE = "unreadable"
UNITS_UNKNOWN = "units unknown"
NO_OVERLAP = "no overlap"
OVERLAP = "overlap"
FAR = "further apart than asked about"
FAILED = "not decided"


def tool() -> Tool:
    return Tool("satcheck", __version__)


def empty_report(settings: StatedSettings, issues: Iterable[Issue] = ()) -> Report:
    """Return a report without bodies and pairs, of which nothing is known."""
    none = PairCounts(total=0, pruned=0, decided=0, allowed=0, indeterminate=0)
    return Report(
        tool=tool(),
        units=None,
        settings=settings,
        summary=Summary("incomplete", none, dict.fromkeys(RELATIONS, 0)),
        bodies=(),
        findings=(),
        issues=tuple(issues),
    )


def count(
    bodies: PlacedBodies, close: Sequence[Finding], findings: Sequence[Finding], unexamined: int = 0
) -> PairCounts:
    """close: of the pairs that the broad phase kept and that were examined. unexamined: the number
    of those that were not. Raises RuntimeError if a pair is missing."""
    undecidable = bodies.undecidable_count + unexamined
    left_open = sum(finding.relation == "indeterminate" for finding in close)
    total, allowed = bodies.book.count()
    number = len(bodies.ids)
    counts = PairCounts(
        total=total,
        pruned=total - allowed - undecidable - len(close),
        decided=len(close) - left_open,
        allowed=allowed,
        indeterminate=undecidable + left_open,
        exempt=number * (number - 1) // 2 - total,
    )
    unlisted_open = unlisted_indeterminate(counts, findings)
    unlisted_apart = counts.asked - len(findings) - unlisted_open
    if min(counts.pruned, unlisted_open) < 0 or unlisted_apart not in (0, counts.pruned):
        raise RuntimeError(f"pairs do not add up: {counts}, {len(findings)} findings")
    return counts


def body_reports(bodies: PlacedBodies) -> tuple[BodyReport, ...]:
    return tuple(
        _unusable_report(bodies.unusable[k].body)
        if k in bodies.unusable
        else _body_report(bodies.placed[k])
        for k in range(len(bodies.ids))
    )


def _unusable_report(body: Body | Unreadable) -> BodyReport:
    return BodyReport(
        id=body.id,
        name=body.id,
        file=body.file if isinstance(body, Unreadable) else body.file.path,
        path=body.path,
        groups=body.groups,
        static=body.static,
    )


def _body_report(body: PlacedBody) -> BodyReport:
    own, shared = body.body, body.shared
    file, given = own.file, own.as_given or own
    known = shared.decomposition.known
    parts = None if isinstance(known, SatcheckError) else known
    shape = given.shape
    return BodyReport(
        id=body.id,
        name=own.name,
        file=file.path,
        sha256=file.sha256,
        path=own.path,
        transform=None if given.transform is None else tuple(map(float, given.transform)),
        units=own.units,
        unit_scale=own.unit_scale,
        groups=own.groups,
        static=own.static,
        open=own.open,
        triangles=shared.triangles,
        health=file.health,
        resolution=body.resolution,
        surface_tolerance=body.surface_tolerance or None,
        convex=shared.geometry.known_convex,
        parts=None if parts is None else len(parts.parts),
        part_error=None if parts is None else _part_error(body, parts),
        shape=Outline(shape.points) if isinstance(shape, FlatOutline) else shape,
    )


def _part_error(body: PlacedBody, parts: Decomposition) -> PartError:
    """Return the error of parts in file coordinates, world units."""
    stretch = body.largest_stretch
    return PartError(parts.outside * stretch, parts.missing * stretch)


def issues_of(
    scene: Scene,
    bodies: PlacedBodies,
    counts: PairCounts,
    allowed: bool,
    of_pairs: Iterable[Issue],
    accept: Sequence[str],
) -> tuple[Issue, ...]:
    """The issues of the input, then those of the run; each once. allowed: rules allow all pairs.
    accept: those that block nothing, beside those that the scene accepts."""
    asks = counts.asked or scene.asks_for_regions or scene.asks_for_support
    lone = len(bodies.ids) == 1
    empty = [] if asks or lone else [_nothing_to_check(scene, bodies, counts, allowed)]
    return issues_of_input(scene, accept, (*bodies.issues, *empty, *of_pairs))


def issues_of_input(
    scene: Scene, accept: Sequence[str], others: Iterable[Issue] = ()
) -> tuple[Issue, ...]:
    """The issues of the input, and others, each once. accept: as above."""
    own = (Issue(i.code, i.severity, i.body, i.file, i.message) for i in scene.issues)
    once = dict.fromkeys((*own, *others))
    return tuple(with_states(once, (*scene.accept, *map(Accepted, accept))))


def _nothing_to_check(
    scene: Scene, bodies: PlacedBodies, counts: PairCounts, allowed: bool
) -> Issue:
    """Return why no pair was checked."""
    if not bodies.ids:
        message = "nothing to compare: no body can collide"
        return Issue(NOTHING_TO_COMPARE, "note", None, None, message)
    in_link = sum(robot.pairs_within_links for robot in scene.robots)
    static_bodies = 0 if scene.check_static else sum(body.static for body in scene.in_order())
    static, in_group = exempt_by(counts, static_bodies)
    why = {
        "within one link": in_link,
        "allowed by rules": counts.allowed - in_link,
        "of static bodies": static,
        "within ignored groups": in_group,
    }
    said = ", ".join(f"{count:,} {what}" for what, count in why.items() if count)
    message = f"no pair was checked: {said}"
    return Issue(NOTHING_TO_CHECK, "note" if allowed else "warning", None, None, message)


def stopped_early(unexamined: int) -> Iterator[Issue]:
    """Say how many close pairs were not examined."""
    if unexamined:
        message = (
            f"{unexamined:,} close pairs were not examined and count as indeterminate: "
            f"more than {ENOUGH_FAILURES:,} others fail, or take more steps than the scene leaves, "
            f"or that many, and {MEETINGS_OF_BODY} for each body, touch or overlap"
        )
        yield Issue(STOPPED_EARLY, "note", None, None, message)


# Two bodies of about one size, one in millimetres and one in metres, are about 1000-fold apart.
UNLIKE = 500.0


def doubtful_sizes(
    bodies: PlacedBodies, findings: Sequence[Finding], plane: Plane | None
) -> Iterator[Issue]:
    """Bodies smaller than the tolerance of one of their pairs, and bodies of very different
    sizes."""
    shared = {body.shared for body in bodies.placed.values()}
    longest = {each: _longest_side(each.file.mesh.bounds, plane) for each in shared}
    sizes = {body.id: body.stretch * longest[body.shared] for body in bodies.placed.values()}
    yield from _tolerances(sizes, findings)
    alike: dict[str | None, dict[str, float]] = {}
    for k, body in bodies.placed.items():
        if not body.endless:
            alike.setdefault(bodies.units[k], {})[body.id] = sizes[body.id]
    for of_unit in alike.values():
        yield from _unlike(of_unit)


def size_of(body: PlacedBody) -> float:
    """The longest side of its own box, world units: the same in every pose."""
    return body.stretch * _longest_side(body.body.file.mesh.bounds, None)


def _longest_side(box: Box, plane: Plane | None) -> float:
    low, high = box
    return max(high[axis] - low[axis] for axis in (range(3) if plane is None else axes_of(plane)))


def _tolerances(sizes: dict[str, float], findings: Sequence[Finding]) -> Iterator[Issue]:
    most = max((finding.tolerance or 0.0 for finding in findings), default=0.0)
    if most <= min(sizes.values(), default=inf):
        return
    larger: dict[str, list[float]] = {}  # of each body the tolerances that are larger than it
    for finding in findings:
        tolerance = finding.tolerance or 0.0
        for id_ in (finding.a, finding.b):
            if tolerance > sizes.get(id_, inf):
                larger.setdefault(id_, []).append(tolerance)
    if not larger:
        return
    small = [id_ for id_ in sizes if id_ in larger]
    tolerance = max(map(max, larger.values()))
    verb = "is" if len(small) == 1 else "are"
    message = (
        f"{listed(small)} {verb} smaller than the tolerance {tolerance:.3g}, "
        "within which an overlap counts as touching"
    )
    yield Issue(TOLERANCE_LARGE, "warning", small[0] if len(small) == 1 else None, None, message)


def _unlike(sizes: dict[str, float]) -> Iterator[Issue]:
    if len(sizes) < 2:
        return
    smallest, largest = (pick(sizes, key=sizes.__getitem__) for pick in (min, max))
    low, high = sizes[smallest], sizes[largest]
    if low * UNLIKE > high:
        return
    message = (
        f"{smallest} is {low:.3g} in size and {largest} {high:.3g}: is one of them in another unit?"
    )
    yield Issue(SIZES_DIFFER, "warning", None, None, message)


def effects_of(
    planner: Planner,
    close: Iterable[tuple[Request, Finding]],
    counts: PairCounts,
    units_unknown: int = 0,
) -> tuple[EffectReport, ...]:
    """Return a report for each effect. close: the pairs that the broad phase kept. For each effect,
    the pairs on which it ran and those on which it did not add up to all pairs. Without motions
    there is no sweep. units_unknown: the number of pairs without a common unit."""
    time: dict[str, float] = dict.fromkeys(EFFECTS, 0.0)
    spared: dict[Effect, defaultdict[str | None, int]] = {
        effect: defaultdict(int) for effect in EFFECTS if effect != "sweep" or planner.moving
    }
    called_for: set[Effect] = set()  # effects that nobody requests, and a failing pair calls for
    fail_on, examined = planner.settings.fail_on, 0
    for request, finding in close:
        examined += 1
        by: AbstractSet[str] = request.by.keys()
        if request.if_failing and finding.at_rest in OVERLAPS and fails(finding, fail_on):
            called_for.update(request.if_failing)
            by |= {*request.if_failing}
        if finding.motion is not None:
            by |= {"sweep"}
        done = _done(finding, by, time)
        for effect in by | done:
            if effect in spared:
                spared[effect][_why_not(effect, finding, by, done)] += 1
    unreadable = counts.asked - counts.pruned - examined - units_unknown
    before = (PRUNED, counts.pruned), (UNREADABLE, unreadable), (UNITS_UNKNOWN, units_unknown)
    reports = []
    for effect, why_not in spared.items():
        asked_by = planner.requested_by(effect)
        if effect in called_for:
            asked_by += (FOR_FAILURES,)
        why_not[NOT_ASKED] += examined - sum(why_not.values())
        ran = why_not.pop(None, 0)
        why_not[ALLOWED] += counts.allowed
        for reason, count in before:
            why_not[reason if asked_by else NOT_ASKED] += count
        not_run = {reason: count for reason, count in sorted(why_not.items()) if reason and count}
        reports.append(EffectReport(effect, asked_by, ran, not_run, time[effect]))
    return tuple(reports)


def _done(finding: Finding, by: Collection[str], time: dict[str, float]) -> set[str]:
    """Return the effects whose stages ran, of those that were asked for. Add the time of each stage
    to that of its effect."""
    done = {"overlap"}
    for stage in finding.plan:
        effect = _PART_OF.get(stage.stage, stage.stage)
        if effect not in by:  # a step that only the overlap needed
            effect = "overlap"
        time[effect] += stage.microseconds
        done.add(effect)
    if finding.depth is not None:  # also if the touch band computed it
        done.add("depth")
    return done


def _why_not(
    effect: Effect, finding: Finding, by: Collection[str], done: Collection[str]
) -> str | None:
    """Return why an effect has no result, for example because it was refused; None: it has one."""
    if effect in done:
        answer = _ANSWERS.get(effect)
        return NO_ANSWER if answer is not None and answer(finding) is None else None
    if effect not in by:
        return NOT_ASKED
    if finding.at_rest == "indeterminate":
        return FAILED
    if effect == "distance":
        return OVERLAP if (finding.exact_relation or finding.at_rest) in OVERLAPS else FAR
    if effect in ("depth", "thickness") and finding.at_rest in OVERLAPS:
        return NO_ANSWER if "depth" in done else BEYOND_BUDGET
    return NO_OVERLAP
