"""Why a pair is left as it is."""

from __future__ import annotations

from collections.abc import Iterator

from satcheck.audit.report.report import Report
from satcheck.audit.resolve.crowd import Crowd
from satcheck.audit.resolve.resolution import Left, objected
from satcheck.audit.resolve.wall import BodyPair

BOTH_STAY = "both bodies stay"
LINKS_STAY = "links of a robot stay where its joints put them"
NO_WAY = "no way out was found"
ONLY_MOVING = "only while they move, and motions are not resolved"


def reasons(
    crowd: Crowd, staying: frozenset[str], links: frozenset[str], given_up: dict[BodyPair, str]
) -> dict[frozenset[str], str]:
    """Why pairs are left, including those that no check fails on as they are placed."""
    found = {}
    for pair, said in crowd.opinions(crowd.close_pairs()).items():
        ids = frozenset(crowd.home[i].id for i in pair)
        if said.kind == "free":
            found[ids] = ONLY_MOVING
        elif ids <= links:
            found[ids] = LINKS_STAY
        elif ids <= staying:
            found[ids] = BOTH_STAY
        else:
            found[ids] = given_up.get(pair, NO_WAY)
    return found


def left_pairs(report: Report, known: dict[frozenset[str], str]) -> Iterator[Left]:
    for finding in objected(report):
        motion = finding.motion
        far = NO_WAY if motion is None else ONLY_MOVING
        why, relation = known.get(frozenset((finding.a, finding.b)), far), finding.at_rest
        if why == ONLY_MOVING and motion is not None:
            relation = motion.relation
        yield Left(finding.a, finding.b, relation, why)
