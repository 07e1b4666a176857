"""The last line: what was checked, what was found, and the worst of it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from satcheck.audit.report.report import CROSS_CHECK, INTERNAL_ERROR, OVERLAPS, RELATIONS
from satcheck.cli.report.words import by_surfaces, counted, depth, is_hit, is_overlap, with_unit
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.audit.report.report import Report

_WORDS = {"contains": "containing"}


def summary_line(report: Report) -> str:
    """`3 bodies, 3 pairs: 2 separated, 1 penetrating. Depth 1 mm.`"""
    pairs = report.summary.pairs
    bodies = counted(len(report.bodies), "body", "bodies")
    if pairs.total == pairs.allowed:
        why = "all are allowed by the scene" if pairs.total else _why_none(report)
        line = f"{bodies}, {counted(pairs.total, 'pair')}. No pair was checked: {why}."
        return " ".join([line, *_errors(report)])
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
        ]
    )


def _why_none(report: Report) -> str:
    if report.exempt.groups:
        return "all are within ignored groups, or of static bodies"
    return "all bodies are static" if report.exempt.static_pairs else "there is none"


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
    moving = [finding for finding in report.findings if finding.motion is not None]
    hits = sum(is_hit(f) and f.relation not in OVERLAPS for f in moving)
    return (
        [f"{counted(hits, 'pair')} {'hits' if hits == 1 else 'hit'} while moving."] if hits else []
    )


def _worst(report: Report) -> list[str]:
    overlaps = [f for f in report.findings if f.relation in OVERLAPS]
    deep = [f for f in overlaps if f.depth is not None]
    if not deep:
        return ["Depth not asked: --depth."] if overlaps else []
    worst = max(deep, key=lambda f: f.depth_bounds or (0.0, f.depth or 0.0))
    figure = with_unit(depth(worst, bounded="at most "), unit_of(report.units))
    if len(deep) == 1:
        return [f"Depth {figure}."]
    sure = worst.depth_bounds is not None and all(
        f is worst or (f.depth or 0.0) <= worst.depth_bounds[0] for f in deep
    )
    return [f"{'The' if sure else 'Possibly the'} deepest: {worst.a} and {worst.b}, {figure}."]


def _left_open(report: Report) -> list[str]:
    """`No collision.` only where everything that was asked was checked."""
    limits = []
    if surfaces := sum(by_surfaces(finding) for finding in report.findings):
        verb = "was" if surfaces == 1 else "were"
        limits.append(f"{counted(surfaces, 'pair')} {verb} checked by surfaces only")
    unsure = Counter(is_overlap(f) for f in report.findings if f.undecided == "limit")
    for overlap, what in ((True, "exceed {} limits"), (False, "be closer than {} clearance")):
        if count := unsure[overlap]:
            whose = "its" if count == 1 else "their"
            limits.append(f"{counted(count, 'pair')} may {what.format(whose)}")
    if moving := report.summary.sweeps_undecided:
        limits.append(f"{counted(moving, 'pair')} may hit while moving")
    if report.summary.verdict == "fail":
        return [f"{limit}." for limit in limits] + _why_failed(report)
    if undecided := report.summary.pairs.indeterminate:
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
    close = sum(f.severity == "error" and not is_overlap(f) for f in report.findings)
    if close:
        verb = "does" if close == 1 else "do"
        return [f"{counted(close, 'pair')} {verb} not keep the clearance."]
    if any(is_overlap(finding) for finding in report.findings):
        return []
    return [f"Failed by --fail-on {report.settings['fail_on']}."]


def _cross_check(report: Report) -> list[str]:
    """`Cross-check: 5 answers agree, 1 disagrees.`, an answer being that of one library on a pair.

    Pairs that nobody could be asked about count as unanswered."""
    if not report.settings.get("cross_check"):
        return []
    standings = Counter(
        stage.result
        for finding in report.findings
        for stage in finding.plan
        if stage.stage == CROSS_CHECK
    )
    agree, disagree = standings["agrees"], standings["disagrees"]
    parts = [f"{counted(agree, 'answer')} {'agrees' if agree == 1 else 'agree'}"]
    if disagree:
        parts.append(f"{disagree:,} {'disagrees' if disagree == 1 else 'disagree'}")
    if missing := standings["no answer"]:
        parts.append(f"{missing:,} could not be compared")
    return [f"Cross-check: {', '.join(parts)}."]


def _errors(report: Report) -> list[str]:
    errors = [issue.code for issue in report.issues if issue.severity == "error"]
    faults = errors.count(INTERNAL_ERROR)
    said = []
    if inputs := len(errors) - faults:
        said.append(f"{counted(inputs, 'input')} could not be used.")
    if faults:
        said.append(f"{counted(faults, 'pair')} failed by an internal error.")
    return said
