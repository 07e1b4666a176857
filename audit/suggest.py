"""Suggests pairs that a scene may allow, with the evidence for each. A person must decide, because
an intended contact and a fault look the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.bodies import BodyCache
from satcheck.audit.check import DEFAULT_SETTINGS, check
from satcheck.report.report import OVERLAPS, Finding, Issue, Relation, Report, Tool
from satcheck.report.suggestions import (
    Names,
    Suggestion,
    SuggestionsReport,
    Unchecked,
    Why,
)

if TYPE_CHECKING:
    from satcheck.audit.settings import Settings
    from satcheck.report.samples import SampledPair, SamplesReport
    from satcheck.scene import Scene
    from satcheck.scene.robot import Pose


class Undecided(Struct, frozen=True):
    """A pair, and the first reason why it is undecided."""

    a: str
    b: str
    reason: str


class Suggestions(Struct, frozen=True):
    """poses: the number of poses checked besides the placement. seed: of random poses. held: joints
    that did not move. undecided: undecided pairs, with the reason. may_meet: pairs of links with
    bodies that met in a pose, or may have met.

    "never" is about the checked poses only. It proves nothing about others.
    """

    tool: Tool
    units: str | None
    poses: int
    seed: int | None
    pairs: tuple[Suggestion, ...]
    undecided: tuple[Undecided, ...]
    may_meet: frozenset[frozenset[str]]
    issues: tuple[Issue, ...]
    unchecked: tuple[Unchecked, ...] = ()
    held: tuple[str, ...] = ()

    def document(self) -> SuggestionsReport:
        return SuggestionsReport(
            tool=self.tool,
            units=self.units,
            poses=self.poses,
            seed=self.seed,
            held=self.held,
            suggestions=self.pairs,
            undecided=len(self.undecided),
            unchecked=self.unchecked,
        )


def suggest(
    scene: Scene,
    settings: Settings = DEFAULT_SETTINGS,
    poses: Sequence[Pose] = (),
    seed: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    held: Sequence[str] = (),
) -> Suggestions:
    """Suggests pairs in contact as placed, with their depth; links with a joint between them; and
    pairs that always or never meet in these poses. seed: of random poses; None: not random. held:
    the joints that stand still. A pair that could not be checked as placed is not suggested.

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
    asked = [(ids[i], ids[j]) for i, j in cache.book.checked_pairs()]
    unchecked = _unchecked(scene, report, asked)
    left_out = {(pair.a, pair.b) for pair in unchecked}
    pairs, may_meet = _suggestions(scene, report, samples, asked, left_out)
    return Suggestions(
        tool=report.tool,
        units=report.units,
        poses=len(poses),
        seed=seed if poses else None,
        pairs=tuple(pairs),
        undecided=undecided,
        may_meet=may_meet,
        issues=issues,
        unchecked=unchecked,
        held=tuple(held) if poses else (),
    )


def _undecided(report: Report, samples: SamplesReport | None) -> tuple[Undecided, ...]:
    """As placed, then in the poses."""
    first: dict[Names, Undecided] = {}
    for finding in report.findings:
        if finding.undecided is not None:
            swept = finding.motion and finding.motion.reason
            reason = finding.reason or swept or "undecided"
            first.setdefault((finding.a, finding.b), Undecided(finding.a, finding.b, reason))
    undecided = [pair for pair in samples.pairs if pair.undecided] if samples else []
    for pair in sorted(undecided, key=lambda pair: pair.first_undecided or 0):
        first.setdefault((pair.a, pair.b), Undecided(pair.a, pair.b, pair.reason or "undecided"))
    return tuple(first.values())


def _unchecked(scene: Scene, report: Report, asked: list[Names]) -> tuple[Unchecked, ...]:
    findings = {(f.a, f.b): f for f in report.findings if f.at_rest == "indeterminate"}
    links, adjacent = _links(scene), _adjacent(scene)
    return tuple(
        Unchecked(
            a,
            b,
            adjacent=frozenset((a, b)) in adjacent,
            links=_carriers(links, a, b),
            reason=findings[a, b].reason or "indeterminate",
        )
        for a, b in asked
        if (a, b) in findings
    )


def _suggestions(
    scene: Scene,
    report: Report,
    samples: SamplesReport | None,
    asked: list[Names],
    left_out: set[Names],
) -> tuple[list[Suggestion], frozenset[frozenset[str]]]:
    """The suggested pairs, and the pairs of links that met or may have met."""
    suggested: list[Suggestion] = []
    may_meet = set()
    findings = {(f.a, f.b): f for f in report.findings}
    tallies = {(tally.a, tally.b): tally for tally in samples.pairs} if samples else {}
    poses = samples.summary.samples if samples else 0
    links, adjacent = _links(scene), _adjacent(scene)
    for a, b in asked:
        finding, tally = findings.get((a, b)), tallies.get((a, b))
        why = None
        if (a, b) not in left_out:
            why = _why(finding, tally, poses, frozenset((a, b)) in adjacent)
        carriers = _carriers(links, a, b)
        if carriers is not None and why != "never":
            may_meet.add(frozenset(carriers))
        if why is not None:
            suggested.append(
                Suggestion(
                    a,
                    b,
                    why,
                    links=carriers,
                    relation=None if why == "never" else _relation(finding),
                    depth_bounds=None if finding is None else finding.depth_bounds,
                    contacts=None if tally is None else tally.contacts,
                )
            )
    return suggested, frozenset(may_meet)


def _why(
    finding: Finding | None, tally: SampledPair | None, poses: int, adjacent: bool
) -> Why | None:
    if adjacent:
        return "adjacent"
    if tally and tally.contacts == poses:
        return "always"
    if finding is not None and _in_contact(finding):
        return "contact"
    if finding is not None and (finding.undecided is not None or _meets(finding)):
        return None
    return "never" if tally and tally.settled else None


def _meets(finding: Finding) -> bool:
    """Whether the bodies meet, as placed or in motion. Rules do not matter."""
    swept = finding.motion
    on_the_way = swept is not None and swept.relation in ("penetrating", "touching")
    return finding.at_rest in OVERLAPS or on_the_way


def _in_contact(finding: Finding) -> bool:
    """Whether the pair touches, or overlaps and no rule limits or allows the overlap."""
    if finding.at_rest in OVERLAPS:
        return finding.severity == "error"
    return finding.at_rest == "touching"


def _relation(finding: Finding | None) -> Relation:
    return "separated" if finding is None else finding.at_rest


def _carriers(links: dict[str, str], a: str, b: str) -> Names | None:
    return (links[a], links[b]) if a in links and b in links else None


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
