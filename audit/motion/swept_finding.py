"""The verdict on a moving pair: the worse of its relation as placed and that of its sweep."""

from __future__ import annotations

import math

from msgspec.structs import replace

from satcheck.audit.draft import Draft
from satcheck.audit.pair import Moves
from satcheck.report.judge import Judgement, by_rule, judged
from satcheck.report.report import OVERLAPS, SEVERITIES, Finding, Relation
from satcheck.report.request import Request
from satcheck.report.sweep import Sweep

CLEAR = "clear"  # the rule of a touch on a way that must be free


def with_sweep(finding: Finding, draft: Draft, moves: Moves) -> Finding:
    """The finding with the sweep of the pair, its stage in the draft, and a severity that counts
    both."""
    pair = draft.pair
    pair.sweep_steps = 0
    motion = moves.sweep(pair)
    draft.steps += pair.sweep_steps
    spent = motion.relation == "indeterminate" and pair.sweep_wants_more
    draft.wants_more = draft.wants_more or spent
    draft.record("sweep", motion.relation, _detail(motion))
    judgement = _judged_sweep(finding, motion, pair.request)
    if moves.clear and finding.relation in ("separated", "near") and motion.relation == "touching":
        judgement = Judgement("error", CLEAR)
    judgement = by_rule(judgement, pair.request)
    graver = SEVERITIES.index(judgement.severity) < SEVERITIES.index(finding.severity)
    relation = _worse(finding.relation, motion.relation)
    undecided = relation == "indeterminate"
    quality = finding.quality if motion.proven else "estimate"
    return replace(
        finding,
        relation=relation,
        placed_relation=finding.relation,
        quality=None if undecided else quality,
        motion=motion,
        severity=judgement.severity if graver else finding.severity,
        rule=judgement.rule if graver else finding.rule,
        undecided=finding.undecided or judgement.undecided,
        reason=finding.reason or judgement.reason or (motion.reason if undecided else None),
        # What may be hit on the way is another question than what is open as placed.
        reason_code=None if motion.relation == "indeterminate" else finding.reason_code,
        plan=tuple(draft.stages),
    )


def _worse(placed: Relation, on_the_way: Relation) -> Relation:
    """The worse relation: an overlap, else an undecided one, else the closest."""
    if placed in OVERLAPS:
        return placed
    order: tuple[Relation, ...] = ("penetrating", "indeterminate", "touching", "near", "separated")
    return min(placed, on_the_way, key=order.index)


def _judged_sweep(finding: Finding, swept: Sweep, request: Request) -> Judgement:
    """Judge the motion as a finding with its figures, without the severity that a rule sets.
    Volumes and thicknesses in motion are not measured; no overlap is thicker than it is deep."""
    if swept.relation == "indeterminate":
        return Judgement("warning", undecided="motion")
    worst = swept.worst
    depth = None if worst is None else worst.depth
    of_motion = replace(
        finding,
        relation=swept.relation,
        depth_bounds=depth,
        thickness_bounds=None if depth is None else (0.0, depth[1]),
        volume=None,
    )
    least = (swept.distance_at_least or 0.0, math.inf)
    gap = least if worst is None else worst.distance or (0.0, 0.0)
    judgement = judged(of_motion, replace(request, severity=None), gap)
    if swept.reason is None or judgement.severity == "error":
        return judgement
    return Judgement("warning", undecided="inside")


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
