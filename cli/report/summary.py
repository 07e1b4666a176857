"""The last line of a report: the number of bodies and pairs, the relations, the worst overlap."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

from satcheck.audit.summary import exempt_by
from satcheck.cli.report.beside_baseline import beside_baseline
from satcheck.cli.report.words import (
    counted,
    interval,
    is_hit,
    past_holes,
    with_unit,
)
from satcheck.report.report import (
    CROSS_CHECK,
    INTERNAL_ERROR,
    NOTHING_TO_CHECK,
    OVERLAPS,
    RELATIONS,
    SIZES_DIFFER,
    TOLERANCE_LARGE,
)
from satcheck.scene.bodies import UNITS_UNKNOWN
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.audit.samples import Samples
    from satcheck.report.report import Finding, Issue, Report
    from satcheck.report.values import Interval

_DOUBTS = (UNITS_UNKNOWN, TOLERANCE_LARGE, SIZES_DIFFER)
_WORDS = {"contains": "containing"}
# A figure of overlaps, the most and the more of it.
_THICKEST = ("thickness", "Thickest", "thicker")
_DEEPEST = ("depth", "Deepest", "deeper")


def summary_line(report: Report, *, offers_depth: bool = True) -> str:
    """`3 bodies, 3 pairs: 2 separated, 1 penetrating. Thickest overlap 0.6 mm (a, b), depth 1 mm.`
    offers_depth: the command has the option --depth."""
    pairs = report.summary.pairs
    bodies = counted(len(report.bodies), "body", "bodies")
    if not pairs.asked:
        line = f"{bodies}, {counted(pairs.total, 'pair')}."
        unchecked = nothing_checked(report.issues)
        return " ".join([line, *unchecked, *_errors(report), *doubts(report.issues)])
    counts = _counts(report)
    if pairs.allowed:
        counts.append(f"{pairs.allowed:,} allowed by the scene")
    exempt = _exempt(report)
    line = f"{bodies}, {counted(pairs.total, 'pair')}: {', '.join(counts)}{exempt}."
    return " ".join(
        [
            line,
            *_hits(report),
            *_worst(report, offers_depth=offers_depth),
            *_left_open(report),
            *beside_baseline([report]),
            *_cross_check(report),
            *_errors(report),
            *doubts(report.issues),
        ]
    )


def samples_line(result: Samples) -> str:
    """`300 random poses (seed 0), 7 bodies, 12 pairs: 190 pass, 110 fail. 9 pairs overlap.`"""
    kind = "pose" if result.seed is None else "random pose"
    seed = "" if result.seed is None else f" (seed {result.seed})"
    verdicts = Counter(sample.verdict for sample in result.samples)
    singular = {"pass": "passes", "fail": "fails", "incomplete": "is incomplete"}
    plural = {"pass": "pass", "fail": "fail", "incomplete": "are incomplete"}
    parts = [
        f"{count:,} {singular[verdict] if count == 1 else plural[verdict]}"
        for verdict in ("pass", "fail", "incomplete")
        if (count := verdicts[verdict])
    ]
    line = (
        f"{counted(len(result.samples), kind)}{seed}, "
        f"{counted(len(result.bodies), 'body', 'bodies')}, "
        f"{counted(result.counts.total, 'pair')}"
        f"{f', {result.counts.allowed:,} allowed' if result.counts.allowed else ''}"
        f"{f', {result.counts.exempt:,} more exempt' if result.counts.exempt else ''}"
        f": {', '.join(parts)}."
    )
    overlapping = sum(pair.overlaps > 0 for pair in result.pairs)
    if overlapping:
        verb = "overlaps" if overlapping == 1 else "overlap"
        line += f" {counted(overlapping, 'pair')} {verb}."
    elif result.verdict == "pass":
        line += " No collision."
    return " ".join([line, *nothing_checked(result.issues), *doubts(result.issues)])


def nothing_checked(issues: Iterable[Issue]) -> list[str]:
    """`No pair was checked: 1 within one link.`, where that is so."""
    said = [issue.message for issue in issues if issue.code == NOTHING_TO_CHECK]
    return [f"{text[0].upper()}{text[1:]}." for text in said]


def _exempt(report: Report) -> str:
    """`; 1 pair exempt (static)`: of pairs that no other count includes."""
    count = report.summary.pairs.exempt
    if not count:
        return ""
    still = sum(body.static for body in report.bodies) if report.exempt.static_pairs else 0
    static, in_group = exempt_by(report.summary.pairs, still)
    if static and in_group:
        why = f"{static:,} static, {in_group:,} within ignored groups"
    else:
        why = "static" if static else "within ignored groups"
    return f"; {counted(count, 'pair')} exempt ({why})"


def _counts(report: Report) -> list[str]:
    """`2 separated`, `1 possibly penetrating (not proven at --accuracy aabb)`."""
    accuracy = report.settings.accuracy
    why = "" if accuracy == "exact" else f" (not proven at --accuracy {accuracy})"
    guesses = [f for f in report.findings if f.quality == "estimate"]
    overlaps = Counter(f.relation for f in guesses if _surely_overlaps(f, report))
    estimates = Counter(f.relation for f in guesses) - overlaps
    counts = []
    for name in RELATIONS:
        word, unproven = _WORDS.get(name, name), estimates[name]
        proven = report.summary.by_relation.get(name, 0) - unproven - overlaps[name]
        if proven:
            counts.append(f"{proven:,} {word}")
        if unproven:
            counts.append(f"{unproven:,} possibly {word}{why}")
    if count := overlaps.total():
        counts.append(f"{count:,} overlapping in a way that is not proven")
    return counts


def _surely_overlaps(estimate: Finding, report: Report) -> bool:
    """Whether only open is how: one body may hold the other."""
    settings = report.settings
    is_strict = settings.accuracy == "exact" and not settings.allow_open
    return is_strict and estimate.at_rest in OVERLAPS and estimate.undecided != "relation"


def _hits(report: Report) -> list[str]:
    """Of pairs that do not overlap as they are placed."""
    hits = [f.motion for f in report.findings if is_hit(f) and f.at_rest not in OVERLAPS]
    proven = Counter(hit is not None and hit.proven for hit in hits)
    said = []
    for count, possibly in ((proven[True], ""), (proven[False], "possibly ")):
        if count:
            said.append(f"{counted(count, 'pair')} {possibly}{'hits' if count == 1 else 'hit'}")
    return [f"{' and '.join(said)} while moving."] if said else []


def _worst(report: Report, *, offers_depth: bool) -> list[str]:
    """The thickest overlap, or the deepest where no thickness is known."""
    overlaps = [f for f in report.findings if f.at_rest in OVERLAPS]
    thick = [f for f in overlaps if f.thickness_bounds is not None]
    deep = [f for f in overlaps if f.depth_bounds is not None]
    if not (thick or deep):
        return ["Depth not asked: --depth."] if overlaps and offers_depth else []
    figure, most, more = _THICKEST if thick else _DEEPEST
    known = [(_bounds(f, figure), f) for f in thick or deep]
    (low, high), worst = max(known, key=lambda one: one[0])
    unit = unit_of(report.units)
    said = f"{_interval((low, high), unit)} ({worst.a}, {worst.b})"
    if thick and worst.depth_bounds is not None:
        said += f", depth {_interval(worst.depth_bounds, unit)}"
    is_sure = all(other[1] <= low for other, f in known if f is not worst)
    if len(known) == len(overlaps):
        first = f"{most} overlap" if is_sure else f"No overlap is known to be {more} than"
        return [f"{first} {said}."]
    first = f"the {most.lower()}:" if is_sure else f"none of these known to be {more} than"
    some = f"{figure.capitalize()} known of {len(known):,} of {len(overlaps):,} overlaps"
    return [f"{some}, {first} {said}."]


def _bounds(finding: Finding, figure: str) -> Interval:
    proven: Interval = getattr(finding, f"{figure}_bounds")
    return proven


def _interval(proven: Interval, unit: str | None) -> str:
    return with_unit(interval(proven, bounded="at most "), unit)


def _left_open(report: Report) -> list[str]:
    """`No collision.` only where everything that was asked was checked."""
    limits = []
    if swept := sum(past_holes(finding) for finding in report.findings):
        verb = "moves" if swept == 1 else "move"
        limits.append(f"{counted(swept, 'pair')} {verb} past holes that may be filled")
    unsure = Counter(f.relation in OVERLAPS for f in report.findings if f.undecided == "limit")
    for overlap, what in ((True, "exceed {} limits"), (False, "be closer than {} clearance")):
        if count := unsure[overlap]:
            whose = "its" if count == 1 else "their"
            limits.append(f"{counted(count, 'pair')} may {what.format(whose)}")
    if moving := report.summary.sweeps_undecided:
        limits.append(f"{counted(moving, 'pair')} may hit while moving")
    if disputed := report.summary.disputed:
        limits.append(f"{counted(disputed, 'answer')} {'is' if disputed == 1 else 'are'} disputed")
    if report.summary.verdict == "fail":
        return [f"{limit}." for limit in limits] + _why_failed(report)
    if undecided := sum(f.undecided == "relation" for f in report.findings):
        limits.append(
            f"{counted(undecided, 'pair')} {'is' if undecided == 1 else 'are'} indeterminate"
        )
    ruled = any(map(_is_ruled, report.findings))
    none = "No collision beyond what rules allow" if ruled else "No collision"
    if report.summary.accepted:
        none = "No new or worse finding"
    was = " was" if ruled else ""
    return [f"{none}{was} found, but {' and '.join(limits)}." if limits else f"{none}."]


def _is_ruled(finding: Finding) -> bool:
    """Of a check that does not fail: whether a rule allows the pair what it has, or may."""
    if finding.relation in OVERLAPS:
        return finding.undecided != "relation"
    return finding.rule is not None and finding.undecided != "limit"


def _why_failed(report: Report) -> list[str]:
    """What no count of relations says: clearances that are not kept, and notes that are asked
    for."""
    close = sum(f.severity == "error" and f.relation not in OVERLAPS for f in report.findings)
    if close:
        verb = "does" if close == 1 else "do"
        return [f"{counted(close, 'pair')} {verb} not keep the clearance."]
    if any(finding.relation in OVERLAPS for finding in report.findings):
        return []
    return [f"Failed by --fail-on {report.settings.fail_on}."]


def _cross_check(report: Report) -> list[str]:
    """`Cross-check: 5 answers agree, 1 disagrees, 1 pair not asked.`, an answer being that of one
    library on a pair. A missing answer is counted apart, not as agreement."""
    if not report.settings.cross_check:
        return []
    standings: Counter[str] = Counter()
    asked = 0
    for finding in report.findings:
        results = [stage.result for stage in finding.plan if stage.stage == CROSS_CHECK]
        standings.update(results)
        asked += bool(results)
    agree, disagree = standings.pop("agrees", 0), standings.pop("disagrees", 0)
    parts = [f"{counted(agree, 'answer')} {'agrees' if agree == 1 else 'agree'}"]
    if disagree:
        parts.append(f"{disagree:,} {'disagrees' if disagree == 1 else 'disagree'}")
    if missing := standings.total():
        parts.append(f"{missing:,} could not be had")
    if unasked := report.summary.pairs.total - report.summary.pairs.allowed - asked:
        parts.append(f"{counted(unasked, 'pair')} not asked about")
    return [f"Cross-check: {', '.join(parts)}."]


def doubts(issues: Iterable[Issue]) -> list[str]:
    """Warnings under which the counts say little, once more."""
    said = [issue.message for issue in issues if issue.code in _DOUBTS]
    return [f"Warning: {text}{'' if text.endswith('?') else '.'}" for text in said]


def _errors(report: Report) -> list[str]:
    errors = [issue.code for issue in report.issues if issue.severity == "error"]
    faults = errors.count(INTERNAL_ERROR)
    said = []
    if inputs := len(errors) - faults:
        said.append(f"{counted(inputs, 'input')} could not be used.")
    if faults:
        said.append(f"{counted(faults, 'pair')} failed by an internal error.")
    return said
