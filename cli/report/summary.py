"""The last line: what was checked, what was found, and the worst of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

from satcheck.audit.report.report import (
    CROSS_CHECK,
    INTERNAL_ERROR,
    OVERLAPS,
    RELATIONS,
    SIZES_DIFFER,
    TOLERANCE_LARGE,
)
from satcheck.cli.report.words import by_surfaces, counted, depth, is_hit, with_unit
from satcheck.scene.bodies import UNITS_UNKNOWN
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.audit.report.report import Issue, Report

_DOUBTS = (UNITS_UNKNOWN, TOLERANCE_LARGE, SIZES_DIFFER)
_WORDS = {"contains": "containing"}


def summary_line(report: Report) -> str:
    """`3 bodies, 3 pairs: 2 separated, 1 penetrating. Depth 1 mm.`"""
    pairs = report.summary.pairs
    bodies = counted(len(report.bodies), "body", "bodies")
    if pairs.total == pairs.allowed:
        exempts = f"the scene exempts all {counted(pairs.exempt, 'pair')}"
        why = "all are allowed by the scene" if pairs.total else exempts
        line = f"{bodies}, {counted(pairs.total, 'pair')}. No pair was checked: {why}."
        return " ".join([line, *_errors(report), *doubts(report.issues)])
    found = _found(report)
    if pairs.allowed:
        found.append(f"{pairs.allowed:,} allowed by the scene")
    line = f"{bodies}, {counted(pairs.total, 'pair')}: {', '.join(found)}."
    return " ".join(
        [
            line,
            *_hits(report),
            *_worst(report),
            *_left_open(report),
            *_cross_check(report),
            *_errors(report),
            *doubts(report.issues),
        ]
    )


def _found(report: Report) -> list[str]:
    """`2 separated`, `1 possibly penetrating (not proven at --accuracy aabb)`."""
    estimates = Counter(f.relation for f in report.findings if f.quality == "estimate")
    accuracy = report.settings["accuracy"]
    why = "" if accuracy == "exact" else f" (not proven at --accuracy {accuracy})"
    found = []
    for name in RELATIONS:
        word, unproven = _WORDS.get(name, name), estimates[name]
        proven = report.summary.by_relation.get(name, 0) - unproven
        if proven:
            found.append(f"{proven:,} {word}")
        if unproven:
            found.append(f"{unproven:,} possibly {word}{why}")
    return found


def _hits(report: Report) -> list[str]:
    """Of pairs that do not overlap as they are placed."""
    hits = [f.motion for f in report.findings if is_hit(f) and f.at_rest not in OVERLAPS]
    proven = Counter(hit is not None and hit.proven for hit in hits)
    said = []
    for count, possibly in ((proven[True], ""), (proven[False], "possibly ")):
        if count:
            said.append(f"{counted(count, 'pair')} {possibly}{'hits' if count == 1 else 'hit'}")
    return [f"{' and '.join(said)} while moving."] if said else []


def _worst(report: Report) -> list[str]:
    """The deepest overlap; where only some have a depth, of how many it is the deepest."""
    overlaps = [f for f in report.findings if f.at_rest in OVERLAPS]
    deep = [f for f in overlaps if f.depth is not None]
    if not deep:
        return ["Depth not asked: --depth."] if overlaps else []
    worst = max(deep, key=lambda f: f.depth_bounds or (0.0, f.depth or 0.0))
    figure = with_unit(depth(worst, bounded="at most "), unit_of(report.units))
    if len(overlaps) == 1:
        return [f"Depth {figure}."]
    pair = f"{worst.a} and {worst.b}, {figure}"
    sure = worst.depth_bounds is not None and all(
        f is worst or (f.depth or 0.0) <= worst.depth_bounds[0] for f in deep
    )
    if len(deep) == len(overlaps):
        return [f"{'The' if sure else 'Possibly the'} deepest: {pair}."]
    known = f"Depth known of {len(deep):,} of {len(overlaps):,} overlaps"
    if len(deep) == 1:
        return [f"{known}: {pair}."]
    return [f"{known}, {'' if sure else 'possibly '}the deepest of these: {pair}."]


def _left_open(report: Report) -> list[str]:
    """`No collision.` only where everything that was asked was checked."""
    limits = []
    if surfaces := sum(by_surfaces(finding) for finding in report.findings):
        verb = "was" if surfaces == 1 else "were"
        limits.append(f"{counted(surfaces, 'pair')} {verb} checked by surfaces only")
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
    if limits:
        return [f"No collision found, but {' and '.join(limits)}."]
    ruled = any(finding.rule is not None for finding in report.findings)
    return ["No collision beyond what rules allow." if ruled else "No collision."]


def _why_failed(report: Report) -> list[str]:
    """What no count of relations says: clearances that are not kept, and notes that are asked
    for."""
    close = sum(f.severity == "error" and f.relation not in OVERLAPS for f in report.findings)
    if close:
        verb = "does" if close == 1 else "do"
        return [f"{counted(close, 'pair')} {verb} not keep the clearance."]
    if any(finding.relation in OVERLAPS for finding in report.findings):
        return []
    return [f"Failed by --fail-on {report.settings['fail_on']}."]


def _cross_check(report: Report) -> list[str]:
    """`Cross-check: 5 answers agree, 1 disagrees, 1 pair not asked.`, an answer being that of one
    library on a pair. An opinion that could not be had is said, and is no agreement."""
    if not report.settings.get("cross_check"):
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
