"""The pairs that `resolve` leaves, and why."""

from __future__ import annotations

from collections.abc import Iterator

from satcheck.audit.resolve.layout import BodyPair, Layout
from satcheck.audit.resolve.pair_state import is_objected
from satcheck.report.report import Finding, Report
from satcheck.report.resolution import Left

BOTH_STAY = "both bodies stay"
LINKS_STAY = "links of a robot stay where its joints put them"
NO_WAY = "no way out was found"
ONLY_MOVING = "only while they move, and motions are not resolved"


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
