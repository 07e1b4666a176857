"""`resolve`: translations after which no pair of a scene fails a check."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack

from msgspec.structs import replace

from satcheck.audit.check import check, volume_meter
from satcheck.audit.resolve.layout import ORIGIN, BodyPair, Layout, translated
from satcheck.audit.resolve.pair_state import is_objected
from satcheck.audit.resolve.pushing import Progress, Pushing
from satcheck.audit.settings import Settings
from satcheck.core.conventions import Vector
from satcheck.core.errors import SatcheckError
from satcheck.report.report import OVERLAPS, Finding, Report
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

BOTH_STAY = "both bodies stay"
LINKS_STAY = "links of a robot stay where its joints put them"
NO_WAY = "no way out was found"
ONLY_MOVING = "only while they move, and motions are not resolved"
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
    # Figures of overlaps are not needed where none is left.
    proof = replace(
        settings or Settings(),
        depth=False,
        contacts=False,
        components=False,
        volume=False,
        cross_check=False,
        certificate=False,
    )
    scene.require_in_space("resolve moves bodies in space only")
    scene.require_one_unit()
    robots = (robot for robot in scene.robots if not robot.loose)
    links = frozenset(part.id for robot in robots for part in robot.bodies)
    staying = links | _staying(scene, pins)
    with ExitStack() as stack:
        limits_volume = any(rule.max_volume is not None for rule in scene.rules)
        meter = stack.enter_context(volume_meter(proof)) if limits_volume else None
        layout = Layout(scene, replace(proof, depth=True, thickness=False), staying, meter)
        before = layout.states(layout.close_pairs())
        pushing = Pushing(layout, max_motion or math.inf)
        pushing.run(iterations, progress)
        why = reasons(layout, staying, links, pushing.left)
    offsets = zip(layout.home, layout.offsets, strict=True)
    moved = {body.id: offset for body, offset in offsets if offset != ORIGIN}
    report = checked(moved, proof) if checked else check(moved_scene(scene, moved), proof)
    moves = tuple(
        Move(body.id, moved[body.id], math.hypot(*moved[body.id]))
        for body in scene.bodies
        if body.id in moved
    )
    pinned = tuple(body.id for body in scene.bodies if body.id in staying)
    kinds: Counter[str] = Counter(state.kind for state in before.values())
    counts = sorted(report.summary.by_relation.items())
    relations = {relation: count for relation, count in counts if count}
    document = ResolutionReport(
        tool=report.tool,
        units=report.units,
        output=output,
        summary=_summary(report, kinds, moves, len(pinned), pushing.rounds),
        moves=moves,
        pinned=pinned,
        left=tuple(left_pairs(report, why)),
        check=MovedCheck(report.summary.verdict, report.summary.pairs, relations),
        issues=report.issues,
    )
    return document, report


def _summary(
    report: Report, before: Counter[str], moves: Sequence[Move], pinned: int, rounds: int
) -> ResolutionSummary:
    """before: pairs of the unmoved scene by the kind of their state."""
    lengths = [move.length for move in moves]
    return ResolutionSummary(
        verdict=_VERDICTS[report.summary.verdict],
        conflicts=before["overlap"] + before["near"] + before["open"],
        gaps=before["near"],
        open=before["open"],
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
    """The bodies that are static, pinned by the scene, or chosen by these selectors."""
    pinned = {body.id for body in scene.bodies if body.static or body.pinned}
    for selector in map(Selector, pins):
        chosen = selector.select(scene.in_order())
        if not chosen:
            raise SatcheckError("unknown-pin", f"no body is called {selector.text!r}")
        pinned.update(body.id for body in chosen)
    return frozenset(pinned)


def moved_scene(scene: Scene, translations: Mapping[str, Vector]) -> Scene:
    """The scene with these bodies, by id, moved in the world."""
    return replace(
        scene,
        bodies=tuple(
            translated(body, translations[body.id]) if body.id in translations else body
            for body in scene.bodies
        ),
    )


def objected(report: Report) -> tuple[Finding, ...]:
    """The findings that this check fails on, or whose limits it cannot decide."""
    fail_on = report.settings.fail_on
    return tuple(finding for finding in report.findings if is_objected(finding, fail_on))


def reasons(
    layout: Layout,
    staying: frozenset[str],
    links: frozenset[str],
    given_up: dict[BodyPair, str],
) -> dict[frozenset[str], str]:
    """Why pairs are left, for all close pairs, even if no check fails on them at rest."""
    why = {}
    for pair, state in layout.states(layout.close_pairs()).items():
        ids = frozenset(layout.home[i].id for i in pair)
        if state.kind == "free":
            why[ids] = ONLY_MOVING
        elif ids <= links:
            why[ids] = LINKS_STAY
        elif ids <= staying:
            why[ids] = BOTH_STAY
        else:
            why[ids] = given_up.get(pair, NO_WAY)
    return why


def left_pairs(report: Report, why_left: dict[frozenset[str], str]) -> Iterator[Left]:
    for finding in objected(report):
        motion = finding.motion
        far = NO_WAY if motion is None else ONLY_MOVING
        why, relation = why_left.get(frozenset((finding.a, finding.b)), far), finding.at_rest
        if why == ONLY_MOVING and motion is not None:
            relation = motion.relation
        yield Left(finding.a, finding.b, relation, why)
