"""Suggests rules about pairs in contact, with the evidence for each. A person must decide, because
an intended contact and a fault look the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import product
from math import ceil, floor, log10
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.bodies import BodyCache
from satcheck.audit.check import DEFAULT_SETTINGS, check
from satcheck.audit.summary import tool
from satcheck.core.conventions import LARGEST_LENGTH
from satcheck.report.report import OVERLAPS, Finding, Issue, Report
from satcheck.report.suggestions import Names, Suggestion, SuggestionsReport, Unchecked, Why
from satcheck.scene.units import MICROMETRES, ratio, unit_of

if TYPE_CHECKING:
    from satcheck.audit.settings import Settings
    from satcheck.report.rule_book import RuleBook
    from satcheck.report.samples import SampledPair, SamplesReport
    from satcheck.report.values import Interval
    from satcheck.scene import Scene
    from satcheck.scene.robot import Pose

# A limit is the upper end of a figure times this, rounded up to three digits.
MARGIN = 1.1
# What is asked of a check that measures every overlap.
MEASURED = {"depth": True, "thickness": True, "list_pruned": False}
LOOSER = "a rule goes by names: it would loosen"
NO_FIGURE = "they overlap, and neither their thickness nor their depth has a proven upper end"


class Suggestions(Struct, frozen=True):
    """A report, and what its other forms say beside it. ids: of the bodies, by asset. undecided:
    undecided pairs, with the first reason. may_meet: pairs of links with bodies that met in a pose,
    or may have met. without_unit: assets with overlaps that state no unit, where others do: their
    lengths count in the unit of the rules, as in a check with these rules."""

    report: SuggestionsReport
    ids: Mapping[str | None, Sequence[str]]
    undecided: Mapping[str, str]
    may_meet: frozenset[frozenset[str]]
    issues: tuple[Issue, ...]
    without_unit: tuple[str, ...] = ()


class Robots(Struct, frozen=True):
    """bodies: of all robots. links: body -> link, if there is one robot: two may use the same
    names. adjacent: checked pairs of bodies, in their order, with a joint between the links."""

    bodies: frozenset[str] = frozenset()
    links: Mapping[str, str] = {}
    adjacent: frozenset[Names] = frozenset()

    def links_of(self, a: str, b: str) -> Names | None:
        return (self.links[a], self.links[b]) if {a, b} <= self.links.keys() else None


NO_ROBOTS = Robots()


def suggest(
    scene: Scene,
    settings: Settings = DEFAULT_SETTINGS,
    poses: Sequence[Pose] = (),
    seed: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    held: Sequence[str] = (),
) -> Suggestions:
    """Suggest limits for the pairs that overlap as placed: what was measured, and a margin. Suggest
    to allow links with a joint between them, links that meet in all of these poses, and pairs that
    meet in none, which proves nothing about others. A touch passes without a rule. seed: of random
    poses; None: not random. held: the joints that stand still.

    Raises what `check` and `check_poses` raise.
    """
    cache = BodyCache()
    report = check(scene, replace(settings, **MEASURED), cache=cache)
    samples = None
    if poses:
        from satcheck.audit.samples import check_poses

        samples = check_poses(scene, poses, replace(settings, depth=False), progress)
    assert cache.book is not None
    robots = _robots(scene, [body.id for body in report.bodies], cache.book)
    found = suggestions_of({None: report}, robots, samples)
    return replace(found, report=replace(found.report, seed=seed, held=tuple(held)))


def _robots(scene: Scene, ids: Sequence[str], book: RuleBook) -> Robots:
    place = {id_: number for number, id_ in enumerate(ids)}
    adjacent = {
        tuple(sorted((place[a], place[b])))
        for robot in scene.robots
        for parent, child in robot.neighbours()
        for a, b in product(robot.bodies_of(parent), robot.bodies_of(child))
    }
    carried = {body.id: body.link for robot in scene.robots for body in robot.bodies}
    return Robots(
        frozenset(carried),
        carried if len(scene.robots) == 1 else {},
        frozenset((ids[i], ids[j]) for i, j in adjacent if book.is_checked(i, j)),
    )


def suggestions_of(
    reports: Mapping[str | None, Report],
    robots: Robots = NO_ROBOTS,
    samples: SamplesReport | None = None,
) -> Suggestions:
    """reports: of checks with MEASURED, by asset; None: of the only scene, with these robots, in
    these samples. At least one."""
    suggested: list[Suggestion] = []
    unchecked: list[Unchecked] = []
    undecided: dict[str, str] = {}
    may_meet = set()
    issues = dict.fromkeys(samples.issues if samples else ())
    tallies = {(tally.a, tally.b): tally for tally in samples.pairs} if samples else {}
    poses = samples.summary.samples if samples else 0
    units = _common_units(reports)
    for asset, report in reports.items():
        place = {body.id: number for number, body in enumerate(report.bodies)}
        findings = {(finding.a, finding.b): finding for finding in report.findings}
        own, common = unit_of(report.units), unit_of(units)
        scale = ratio(own, common) if own and common else 1.0
        issues |= dict.fromkeys(report.issues)
        pairs = {*findings, *tallies, *robots.adjacent}
        for a, b in sorted(pairs, key=lambda pair: (place[pair[1]], place[pair[0]])):
            finding, tally = findings.get((a, b)), tallies.get((a, b))
            made = _suggestion(a, b, finding, tally, robots, poses, scale)
            reason = _open_question(finding, tally)
            if isinstance(made, Unchecked):
                unchecked.append(replace(made, asset=asset))
                reason = made.reason
            elif made is not None:
                suggested.append(replace(made, asset=asset))
            if reason is not None:
                undecided[f"{asset}: {a} and {b}" if asset else f"{a} and {b}"] = reason
            links = robots.links_of(a, b)
            if links and not (isinstance(made, Suggestion) and made.why == "never"):
                may_meet.add(frozenset(links))
    looser = _looser(suggested, reports)
    for each in suggested:
        if other := looser.get(frozenset((each.a, each.b))):
            reason = f"{LOOSER} {other}, which has rules of its own"
            unchecked.append(Unchecked(each.a, each.b, False, None, reason, each.asset))
            undecided[f"{each.asset}: {each.a} and {each.b}"] = reason
    suggested = [each for each in suggested if frozenset((each.a, each.b)) not in looser]
    document = SuggestionsReport(
        tool=tool(),
        units=units,
        poses=poses,
        suggestions=tuple(suggested),
        undecided=len(undecided),
        unchecked=tuple(unchecked),
    )
    ids = {asset: [body.id for body in report.bodies] for asset, report in reports.items()}
    without_unit = tuple(
        str(asset)
        for asset, report in reports.items()
        if units and not unit_of(report.units) and any(map(_fails, report.findings))
    )
    return Suggestions(document, ids, undecided, frozenset(may_meet), tuple(issues), without_unit)


def _looser(
    suggested: Iterable[Suggestion], reports: Mapping[str | None, Report]
) -> dict[frozenset[str], str]:
    """Return the names whose rule would loosen an asset that has rules of its own, with that asset.
    Others may be loosened: the suggestion says so."""
    named: dict[frozenset[str], dict[str | None, Suggestion]] = {}
    for each in suggested:
        named.setdefault(frozenset((each.a, each.b)), {})[each.asset] = each
    ids = {asset: {body.id for body in report.bodies} for asset, report in reports.items()}
    return {
        names: str(asset)
        for names, own in named.items()
        for asset, report in reports.items()
        if report.rules
        and names <= ids[asset]
        and any(_allows_more(rule, own.get(asset)) for rule in own.values() if rule.asset != asset)
    }


def _allows_more(rule: Suggestion, own: Suggestion | None) -> bool:
    """Return whether a rule allows a pair of its names more than what is suggested for it. own:
    that; None: the pair needs no rule, and may not overlap at all."""
    if own is None:
        return True
    pairs = ((rule.max_thickness, own.max_thickness), (rule.max_depth, own.max_depth))
    return any(a is not b if a is None or b is None else a > b * MARGIN for a, b in pairs)


def _fails(finding: Finding) -> bool:
    return finding.at_rest in OVERLAPS and finding.severity == "error"


def _common_units(reports: Mapping[str | None, Report]) -> str | None:
    """Return the unit of all assets, or the smallest one that those with overlaps state."""
    stated = {report.units for report in reports.values() if report.bodies}
    if len(stated) == 1:
        return stated.pop()
    failing = (report for report in reports.values() if any(map(_fails, report.findings)))
    known = filter(None, (unit_of(report.units) for report in failing))
    return min(known, key=MICROMETRES.__getitem__, default=None)


def _suggestion(
    a: str,
    b: str,
    finding: Finding | None,
    tally: SampledPair | None,
    robots: Robots,
    poses: int,
    scale: float,
) -> Suggestion | Unchecked | None:
    """None: the pair needs no rule, or nothing speaks for one. finding: None: apart as placed.
    tally: None: there are no poses. scale: from units of the finding to those of the suggestion."""
    links, adjacent = robots.links_of(a, b), (a, b) in robots.adjacent
    placed = finding.at_rest if finding else "separated"
    if finding and placed == "indeterminate":
        return Unchecked(a, b, adjacent, links, finding.reason or placed)
    thickness, depth = (
        bounds and (scale * bounds[0], scale * bounds[1])
        for bounds in ((finding.thickness_bounds, finding.depth_bounds) if finding else (None,) * 2)
    )
    swept = finding.motion.relation if finding and finding.motion else "separated"
    meets = any(each in ("touching", *OVERLAPS) for each in (placed, swept))
    why: Why
    if adjacent:
        why = "adjacent"
    elif tally and tally.contacts == poses and {a, b} <= robots.bodies:
        why = "always"
    elif finding and _fails(finding):
        if thickness is None and depth is None:
            return Unchecked(a, b, adjacent, links, NO_FIGURE)
        why = "contact"
    elif tally and tally.settled and not (finding and finding.undecided) and not meets:
        why = "never"
    else:
        return None
    return Suggestion(
        a,
        b,
        why,
        links=links,
        relation=None if why == "never" else placed,
        thickness_bounds=thickness,
        depth_bounds=depth,
        max_thickness=limit(thickness) if why == "contact" else None,
        max_depth=limit(depth) if why == "contact" else None,
        contacts=tally.contacts if tally else None,
    )


def limit(bounds: Interval | None) -> float | None:
    """Return the upper end and the margin, rounded up to three digits; None: no end is proven."""
    if bounds is None or not bounds[1]:
        return bounds and 0.0
    most = bounds[1] * MARGIN
    step = 10.0 ** (floor(log10(most)) - 2)
    return min(float(f"{ceil(most / step) * step:.4g}"), LARGEST_LENGTH)


def _open_question(finding: Finding | None, tally: SampledPair | None) -> str | None:
    """Return what is undecided, as placed or else in the poses."""
    if finding and finding.undecided is not None:
        swept = finding.motion and finding.motion.reason
        return finding.reason or swept or "undecided"
    return (tally.reason or "undecided") if tally and tally.undecided else None
