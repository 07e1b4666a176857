"""The result of `resolve`: the moves, the remaining overlaps, and the check that proves them."""

from __future__ import annotations

import math
from collections.abc import Iterator

from msgspec import Struct

from satcheck.audit.resolve.layout import Layout
from satcheck.audit.resolve.pair_state import is_objected
from satcheck.audit.resolve.walls import BodyPair
from satcheck.report.report import OVERLAPS, Finding, Report
from satcheck.report.resolution import (
    Left,
    Move,
    MovedCheck,
    ResolutionReport,
    ResolutionSummary,
    ResolutionVerdict,
)

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
    """moves: of the moved bodies, in the order of the scene. pinned: bodies that had to stay.
    overlaps, gaps: pairs of the unmoved scene that fail a check, because they overlap more than
    rules allow, or are closer than their clearance. open: pairs that may overlap because of a hole.
    rounds: how often bodies were pushed. left: unresolved pairs. report: of the check of the moved
    scene.
    """

    moves: tuple[Move, ...]
    pinned: tuple[str, ...]
    overlaps: int
    gaps: int
    open: int
    rounds: int
    left: tuple[Left, ...]
    report: Report

    @property
    def verdict(self) -> ResolutionVerdict:
        return _VERDICTS[self.report.summary.verdict]

    @property
    def conflicts(self) -> int:
        return self.overlaps + self.gaps + self.open

    @property
    def remaining(self) -> tuple[Finding, ...]:
        """What the check of the moved scene still objects to."""
        return objected(self.report)

    @property
    def flush(self) -> int:
        """Pairs that overlap by no more than the tolerance: to a check they touch."""
        return sum(
            finding.at_rest == "touching" and finding.exact_relation in OVERLAPS
            for finding in self.report.findings
        )

    @property
    def total_motion(self) -> float:
        return math.fsum(move.length for move in self.moves)

    @property
    def largest_motion(self) -> float:
        return max((move.length for move in self.moves), default=0.0)

    def document(self, output: str | None = None) -> ResolutionReport:
        """output: the file that the moved scene was written to."""
        report = self.report
        counts = sorted(report.summary.by_relation.items())
        return ResolutionReport(
            tool=report.tool,
            units=report.units,
            output=output,
            summary=self._summary(),
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

    def _summary(self) -> ResolutionSummary:
        return ResolutionSummary(
            verdict=self.verdict,
            conflicts=self.conflicts,
            gaps=self.gaps,
            open=self.open,
            remaining=len(self.remaining),
            flush=self.flush,
            moved=len(self.moves),
            pinned=len(self.pinned),
            total_motion=self.total_motion,
            largest_motion=self.largest_motion,
            rounds=self.rounds,
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
