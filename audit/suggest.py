"""Suggests pairs that a scene may allow, with the evidence for each. A person must decide, because
an intended contact and a fault look the same.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.bodies import BodyCache
from satcheck.audit.check import DEFAULT_SETTINGS, check
from satcheck.report.report import OVERLAPS, Finding, Issue, Report
from satcheck.report.suggestions import Names, Suggestion, SuggestionsReport, Unchecked, Why

if TYPE_CHECKING:
    from satcheck.audit.settings import Settings
    from satcheck.report.samples import SampledPair, SamplesReport
    from satcheck.scene import Scene
    from satcheck.scene.robot import Pose


class Suggestions(Struct, frozen=True):
    """A report, and what its other forms say beside it. undecided: undecided pairs, with the first
    reason. may_meet: pairs of links with bodies that met in a pose, or may have met."""

    report: SuggestionsReport
    undecided: Mapping[Names, str]
    may_meet: frozenset[frozenset[str]]
    issues: tuple[Issue, ...]


def suggest(
    scene: Scene,
    settings: Settings = DEFAULT_SETTINGS,
    poses: Sequence[Pose] = (),
    seed: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    held: Sequence[str] = (),
) -> Suggestions:
    """Suggest pairs in contact as placed, with their depth; links with a joint between them; and
    pairs that always or never meet in these poses, which proves nothing about others. seed: of
    random poses; None: not random. held: the joints that stand still. A pair that could not be
    checked as placed is not suggested.

    Raises what `check` and `check_poses` raise.
    """
    cache = BodyCache()
    measured = replace(settings, depth=True, thickness=False, list_pruned=False)
    report = check(scene, measured, cache=cache)
    samples, issues = None, report.issues
    if poses:
        from satcheck.audit.samples import check_poses

        samples = check_poses(scene, poses, replace(settings, depth=False), progress)
        issues = tuple(dict.fromkeys((*report.issues, *samples.issues)))
    undecided = _undecided(report, samples)
    assert cache.book is not None
    ids = [body.id for body in report.bodies]
    findings = {(finding.a, finding.b): finding for finding in report.findings}
    tallies = {(tally.a, tally.b): tally for tally in samples.pairs} if samples else {}
    links, adjacent = _links(scene), _adjacent(scene)
    suggested, unchecked, may_meet = [], [], set()
    for a, b in ((ids[i], ids[j]) for i, j in cache.book.checked_pairs()):
        finding, tally = findings.get((a, b)), tallies.get((a, b))
        carriers = (links[a], links[b]) if a in links and b in links else None
        is_adjacent = frozenset((a, b)) in adjacent
        why = None
        if finding is not None and finding.at_rest == "indeterminate":
            reason = finding.reason or "indeterminate"
            unchecked.append(Unchecked(a, b, is_adjacent, carriers, reason))
        else:
            why = "adjacent" if is_adjacent else _why(finding, tally, len(poses))
        if carriers is not None and why != "never":
            may_meet.add(frozenset(carriers))
        if why is not None:
            placed = "separated" if finding is None else finding.at_rest
            pair = Suggestion(
                a,
                b,
                why,
                links=carriers,
                relation=None if why == "never" else placed,
                depth_bounds=None if finding is None else finding.depth_bounds,
                contacts=None if tally is None else tally.contacts,
            )
            suggested.append(pair)
    document = SuggestionsReport(
        tool=report.tool,
        units=report.units,
        poses=len(poses),
        seed=seed if poses else None,
        held=tuple(held) if poses else (),
        suggestions=tuple(suggested),
        undecided=len(undecided),
        unchecked=tuple(unchecked),
    )
    return Suggestions(document, undecided, frozenset(may_meet), issues)


def _undecided(report: Report, samples: SamplesReport | None) -> dict[Names, str]:
    """As placed, then in the poses."""
    first: dict[Names, str] = {}
    for finding in report.findings:
        if finding.undecided is not None:
            swept = finding.motion and finding.motion.reason
            first.setdefault((finding.a, finding.b), finding.reason or swept or "undecided")
    undecided = [pair for pair in samples.pairs if pair.undecided] if samples else []
    for pair in sorted(undecided, key=lambda pair: pair.first_undecided or 0):
        first.setdefault((pair.a, pair.b), pair.reason or "undecided")
    return first


def _why(finding: Finding | None, tally: SampledPair | None, poses: int) -> Why | None:
    """Rules that allow or limit an overlap do not make the bodies apart."""
    if tally and tally.contacts == poses:
        return "always"
    if finding is not None:
        overlaps, swept = finding.at_rest in OVERLAPS, finding.motion
        if finding.at_rest == "touching" or (overlaps and finding.severity == "error"):
            return "contact"
        meets = swept is not None and swept.relation in ("penetrating", "touching")
        if overlaps or meets or finding.undecided is not None:
            return None
    return "never" if tally and tally.settled else None


def _links(scene: Scene) -> dict[str, str]:
    """body -> link, if the scene has one robot. Two robots may use the same names."""
    if len(scene.robots) != 1:
        return {}
    return {body.id: body.link for body in scene.robots[0].bodies}


def _adjacent(scene: Scene) -> set[frozenset[str]]:
    return {
        frozenset(pair)
        for robot in scene.robots
        for parent, child in robot.neighbours()
        for pair in product(robot.bodies_of(parent), robot.bodies_of(child))
    }
