"""`resolve`: translations after which no pair of a scene fails a check."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack

from msgspec import Struct
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


class Resolution(Struct, frozen=True):
    """moves, pinned, left: as in the document. before: pairs of the unmoved scene by the kind of
    their state. rounds: how often bodies were pushed. report: of the check of the moved scene.
    """

    moves: tuple[Move, ...]
    pinned: tuple[str, ...]
    before: Mapping[str, int]
    rounds: int
    left: tuple[Left, ...]
    report: Report

    @property
    def summary(self) -> ResolutionSummary:
        overlaps, gaps, holes = (self.before.get(kind, 0) for kind in ("overlap", "near", "open"))
        lengths = [move.length for move in self.moves]
        return ResolutionSummary(
            verdict=_VERDICTS[self.report.summary.verdict],
            conflicts=overlaps + gaps + holes,
            gaps=gaps,
            open=holes,
            remaining=len(objected(self.report)),
            flush=sum(
                finding.at_rest == "touching" and finding.exact_relation in OVERLAPS
                for finding in self.report.findings
            ),
            moved=len(self.moves),
            pinned=len(self.pinned),
            total_motion=math.fsum(lengths),
            largest_motion=max(lengths, default=0.0),
            rounds=self.rounds,
        )

    def document(self, output: str | None = None) -> ResolutionReport:
        """output: the file that the moved scene was written to."""
        report = self.report
        counts = sorted(report.summary.by_relation.items())
        return ResolutionReport(
            tool=report.tool,
            units=report.units,
            output=output,
            summary=self.summary,
            moves=self.moves,
            pinned=self.pinned,
            left=self.left,
            check=MovedCheck(
                report.summary.verdict,
                report.summary.pairs,
                {relation: count for relation, count in counts if count},
            ),
            issues=report.issues,
        )


def resolve(
    scene: Scene,
    settings: Settings | None = None,
    *,
    pins: Sequence[str] = (),
    max_motion: float | None = None,
    iterations: int = 50,
    progress: Progress | None = None,
) -> Resolution:
    """Translations, without rotation, that end every overlap of a scene that can be ended.

    `check` with these settings decides what an overlap is: a pair that the scene allows or ignores
    stays, and an overlap within the touch band is a touch. A pair closer than its clearance is
    pushed apart. A body that is moved ends free of all others, without any touch band. The
    translations are short, not the shortest.

    pins: selectors of bodies that stay, as in rules. Static and pinned bodies of the scene and
    links of robots stay too. max_motion: no body is moved farther. iterations: rounds of pushing,
    after which bodies go to free places. progress(done, total) counts pairs.

    Raises SatcheckError: `bad-setting`, `unknown-pin`, and what `check` raises.
    """
    if max_motion is not None and not (math.isfinite(max_motion) and max_motion > 0):
        raise SatcheckError("bad-setting", f"max_motion must be positive, not {max_motion!r}")
    if iterations < 0:
        raise SatcheckError("bad-setting", f"iterations must be 0 or more, not {iterations!r}")
    proof = proof_of(settings or Settings())
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
    report = check(moved_scene(scene, moved), proof)
    return Resolution(
        moves=tuple(
            Move(body.id, moved[body.id], math.hypot(*moved[body.id]))
            for body in scene.bodies
            if body.id in moved
        ),
        pinned=tuple(body.id for body in scene.bodies if body.id in staying),
        before=Counter(state.kind for state in before.values()),
        rounds=pushing.rounds,
        left=tuple(left_pairs(report, why)),
        report=report,
    )


def proof_of(settings: Settings) -> Settings:
    """The settings for the check of the moved scene: the same, without figures for overlaps."""
    return replace(
        settings,
        depth=False,
        contacts=False,
        components=False,
        volume=False,
        cross_check=False,
        certificate=False,
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


def moved_scene(scene: Scene, translations: dict[str, Vector]) -> Scene:
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
