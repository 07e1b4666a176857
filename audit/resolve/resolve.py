"""`resolve`: translations after which no pair of a scene fails a check."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence

from msgspec.structs import replace

from satcheck.audit.bodies import BodyCache
from satcheck.audit.check import check
from satcheck.audit.resolve.conflicts import (
    Checked,
    at_rest,
    check_at_rest,
    is_objected,
    moved_scene,
    strict,
)
from satcheck.audit.resolve.pushing import ORIGIN, Progress, Pushing
from satcheck.audit.settings import Settings
from satcheck.core.conventions import Vector
from satcheck.core.errors import SatcheckError
from satcheck.report.report import OVERLAPS, Finding, Report
from satcheck.report.request import ON_REQUEST
from satcheck.report.resolution import (
    Left,
    Move,
    MovedCheck,
    ResolutionReport,
    ResolutionSummary,
    ResolutionVerdict,
)
from satcheck.scene import Scene
from satcheck.scene.rules import Selector

# Seconds of a slow machine that all ways out of a round may take together, and the least for one.
ROUND_BUDGET, LEAST_BUDGET = 4.0, 0.006
BOTH_STAY = "both bodies stay"
LINKS_STAY = "links of a robot stay where its joints put them"
NO_WAY = "no way out was found"
ONLY_MOVING = "only while they move, and motions are not resolved"
# Figures of overlaps are not needed where none is left.
NO_FIGURES = {"depth": False, **{extra.setting: False for extra in ON_REQUEST.values()}}
_VERDICTS: dict[str, ResolutionVerdict] = {
    "pass": "resolved",
    "fail": "unresolved",
    "incomplete": "incomplete",
}


def resolve(
    scene: Scene,
    settings: Settings | None = None,
    *,
    pins: Sequence[str] = (),
    max_motion: float | None = None,
    iterations: int = 50,
    progress: Progress | None = None,
    checked: Callable[[Mapping[str, Vector], Settings], Report] | None = None,
    output: str | None = None,
) -> tuple[ResolutionReport, Report]:
    """Find translations, without rotation, that end every overlap of a scene that can be ended.
    Return them, and the check of the moved scene.

    `check` with these settings decides what an overlap is: a pair that the scene allows or ignores
    stays, and an overlap within the touch band is a touch. A pair closer than its clearance is
    pushed apart. A body that is moved ends free of all others, without any touch band. The
    translations are short, not the shortest.

    pins: selectors of bodies that stay, as in rules. Static and pinned bodies of the scene and
    links of robots stay too. max_motion: no body is moved farther. iterations: rounds of pushing,
    after which bodies go to free places. progress(done, total) counts pairs. checked: checks the
    scene with these bodies moved, as the file `output`; None: in memory.

    Raises SatcheckError: `bad-setting`, `unknown-pin`, and what `check` raises.
    """
    if max_motion is not None and not (math.isfinite(max_motion) and max_motion > 0):
        raise SatcheckError("bad-setting", f"max_motion must be positive, not {max_motion!r}")
    if iterations < 0:
        raise SatcheckError("bad-setting", f"iterations must be 0 or more, not {iterations!r}")
    proof = replace(settings or Settings(), **NO_FIGURES)
    scene.require_in_space("resolve moves bodies in space only")
    scene.require_one_unit()
    robots = (robot for robot in scene.robots if not robot.loose)
    links = frozenset(part.id for robot in robots for part in robot.bodies)
    staying = links | _staying(scene, pins)
    rest = at_rest(scene)
    before = check_at_rest(rest, replace(proof, list_pruned=False), BodyCache())
    free = strict(rest, before.findings, proof.fail_on)
    measuring = _measuring(proof, len(before.conflicts))
    pushing = Pushing(free, measuring, staying, max_motion or math.inf)
    if before.conflicts:
        pushing.run(iterations, progress)
    moved = {id_: offset for id_, offset in pushing.offsets.items() if offset != ORIGIN}
    report = checked(moved, proof) if checked else check(moved_scene(scene, moved), proof)
    moves = _moves(scene, moved)
    pinned = tuple(body.id for body in scene.bodies if body.id in staying)
    relations = {name: n for name, n in sorted(report.summary.by_relation.items()) if n}
    document = ResolutionReport(
        tool=report.tool,
        units=report.units,
        output=output,
        summary=_summary(report, before, moves, len(pinned), pushing.rounds),
        moves=moves,
        pinned=pinned,
        left=tuple(_left(finding, pushing, staying, links) for finding in objected(report)),
        check=MovedCheck(report.summary.verdict, report.summary.pairs, relations),
        issues=report.issues,
    )
    return document, report


def _measuring(proof: Settings, conflicts: int) -> Settings:
    """Return the settings that measure the overlaps of a round."""
    budget = min(proof.budget, max(LEAST_BUDGET, ROUND_BUDGET / max(conflicts, 1)))
    return replace(
        proof, depth=True, thickness=False, tolerance=0.0, budget=budget, list_pruned=False
    )


def _moves(scene: Scene, moved: Mapping[str, Vector]) -> tuple[Move, ...]:
    return tuple(
        Move(body.id, moved[body.id], math.hypot(*moved[body.id]))
        for body in scene.bodies
        if body.id in moved
    )


def _summary(
    report: Report, before: Checked, moves: Sequence[Move], pinned: int, rounds: int
) -> ResolutionSummary:
    """before: the check of the unmoved scene."""
    lengths = [move.length for move in moves]
    kinds = Counter(conflict.kind for conflict in before.conflicts.values())
    return ResolutionSummary(
        verdict=_VERDICTS[report.summary.verdict],
        conflicts=kinds.total(),
        gaps=kinds["near"],
        open=kinds["open"],
        remaining=len(objected(report)),
        flush=sum(
            finding.at_rest == "touching" and finding.exact_relation in OVERLAPS
            for finding in report.findings
        ),
        moved=len(moves),
        pinned=pinned,
        total_motion=math.fsum(lengths),
        largest_motion=max(lengths, default=0.0),
        rounds=rounds,
    )


def _staying(scene: Scene, pins: Sequence[str]) -> frozenset[str]:
    """Return the bodies that are static, pinned by the scene, or chosen by these selectors."""
    pinned = {body.id for body in scene.bodies if body.static or body.pinned}
    for selector in map(Selector, pins):
        chosen = selector.select(scene.in_order())
        if not chosen:
            raise SatcheckError("unknown-pin", selector.unmatched(scene.in_order()))
        pinned.update(body.id for body in chosen)
    return frozenset(pinned)


def objected(report: Report) -> tuple[Finding, ...]:
    """Return the findings that this check fails on, or whose limits it cannot decide."""
    fail_on = report.settings.fail_on
    return tuple(finding for finding in report.findings if is_objected(finding, fail_on))


def _left(
    finding: Finding, pushing: Pushing, staying: frozenset[str], links: frozenset[str]
) -> Left:
    a, b = sorted((finding.a, finding.b))
    if finding.motion is not None and (a, b) not in pushing.failing:
        return Left(finding.a, finding.b, finding.motion.relation, ONLY_MOVING)
    why = pushing.left.get((a, b), NO_WAY)
    if {a, b} <= staying:
        why = LINKS_STAY if {a, b} <= links else BOTH_STAY
    return Left(finding.a, finding.b, finding.at_rest, why)
