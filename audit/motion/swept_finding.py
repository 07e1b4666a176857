"""The verdict on a moving pair: the worse of its relation as placed and that of its sweep."""

from __future__ import annotations

import math

from msgspec.structs import replace

from satcheck.audit.bodies.pair import Pair, Paths
from satcheck.audit.finding import Examined
from satcheck.audit.motion.sweep import sweep
from satcheck.audit.request.trace import Trace
from satcheck.report.judge import EXACT_WIDTH, Judgement, by_rule, clearance_judgement
from satcheck.report.report import OVERLAPS, SEVERITIES, Finding, Quality, Relation
from satcheck.report.request import LIMITS, Request
from satcheck.report.sweep import Sweep

CLEAR = "clear"  # the rule of a touch on a way that must be free


def with_sweep(examined: Examined, pair: Pair, paths: Paths, trace: Trace) -> Examined:
    """The finding with the sweep of the pair, its stage in the trace, and a severity that counts
    both."""
    finding = examined.finding
    motion = paths.known or sweep(pair, paths.a, paths.b)
    trace.record("sweep", motion.relation, _detail(motion))
    judged = by_rule(_judged(motion, pair), pair.request)
    if paths.clear and finding.relation in ("separated", "near") and motion.relation == "touching":
        judged = by_rule(Judgement("error", CLEAR), pair.request)
    graver = SEVERITIES.index(judged.severity) < SEVERITIES.index(finding.severity)
    relation = _worse(finding.relation, motion.relation)
    undecided = relation == "indeterminate"
    swept = replace(
        finding,
        relation=relation,
        placed_relation=finding.relation,
        quality=_quality(finding, motion, undecided=undecided),
        motion=motion,
        severity=judged.severity if graver else finding.severity,
        rule=judged.rule if graver else finding.rule,
        undecided=finding.undecided or judged.undecided,
        reason=finding.reason or judged.reason or (motion.reason if undecided else None),
        plan=tuple(trace.stages),
    )
    return replace(examined, finding=swept)


def _quality(finding: Finding, swept: Sweep, *, undecided: bool) -> Quality | None:
    if undecided:
        return None
    return finding.quality if swept.proven else "estimate"


def _worse(placed: Relation, on_the_way: Relation) -> Relation:
    """The worse relation: an overlap, else an undecided one, else the closest."""
    if placed in OVERLAPS:
        return placed
    order: tuple[Relation, ...] = ("penetrating", "indeterminate", "touching", "near", "separated")
    return min(placed, on_the_way, key=order.index)


def _judged(swept: Sweep, pair: Pair) -> Judgement:
    request = pair.request
    if swept.relation == "indeterminate":
        return Judgement("warning", undecided="motion")
    if swept.relation == "penetrating":
        return _limited(swept, pair) if request.limited else Judgement("error")
    clearance = _clearance(swept, request)
    if clearance is not None and clearance.severity == "error":
        return clearance
    if swept.reason is not None:
        return Judgement("warning", undecided="inside")
    if clearance is not None:
        return clearance
    return Judgement("note" if swept.relation == "touching" else "none")


def _clearance(swept: Sweep, request: Request) -> Judgement | None:
    """The judgement of the clearance; None: the motion keeps it, or there is no clearance."""
    worst = swept.worst
    least = (swept.distance_at_least or 0.0, math.inf)
    gap = least if worst is None else worst.distance or (0.0, 0.0)
    return clearance_judgement(request, *gap)


def _limited(swept: Sweep, pair: Pair) -> Judgement:
    """The judgement of a pair that may overlap within limits. Volumes and thicknesses in motion are
    not measured; no overlap is thicker than it is deep."""
    request = pair.request
    depth = None if swept.worst is None else swept.worst.depth
    rule = next(filter(None, map(request.rule, LIMITS)))
    lengths = [most for most in (request.max_depth, request.max_thickness) if most is not None]
    if lengths and depth is not None:
        if request.max_depth is not None and depth[0] > request.max_depth:
            return Judgement("error", rule)
        if depth[1] <= min(lengths) * (1 + EXACT_WIDTH) and request.max_volume is None:
            return Judgement("note", rule)
    reason = "undecided: whether the overlap on the way is within its limits"
    return Judgement("warning", rule, "limit", reason)


def _detail(swept: Sweep) -> str:
    steps = f"{swept.steps} steps"
    if swept.relation == "touching" and swept.contact is not None:
        return f"contact from t = {swept.contact:.6g}, {steps}"
    if swept.time_of_impact is not None:
        return f"first overlap at t = {swept.time_of_impact[1]:.6g}, {steps}"
    if swept.reason is not None:
        return f"{swept.reason}, {steps}"
    if swept.worst is not None and swept.worst.distance is not None:
        return f"at least {swept.worst.distance[0]:.6g} apart, {steps}"
    if swept.distance_at_least is not None:
        return f"at least {swept.distance_at_least:.6g} apart; the rest is not asked, {steps}"
    return steps
