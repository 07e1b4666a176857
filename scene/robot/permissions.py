"""The pairs of bodies of a robot that may touch, as rules: within a link, and those that its SRDF
or its format names."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations, product

from msgspec.structs import replace

from satcheck.scene.issue import Issue, issue
from satcheck.scene.robot.assembly import SceneRobot
from satcheck.scene.robot.srdf import Srdf
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.words import listed, meant

SAME_LINK = "one rigid link"


def permissions(robot: SceneRobot) -> tuple[list[Rule], list[Issue]]:
    """(rules for the pairs of its bodies that may touch, issues about them)."""
    allowed: list[Rule] = []
    bodies = robot.by_link()
    for of_link in bodies.values():
        for pair in combinations(of_link, 2):
            allowed.append(_allowed(pair, SAME_LINK, robot.robot.file))
    allowed += _exempted(robot, bodies)
    if robot.srdf is not None:
        for a, b in combinations(bodies, 2):
            reason = robot.srdf.permission(a, b)
            if reason is not None:
                for pair in product(bodies[a], bodies[b]):
                    allowed.append(_allowed(pair, reason, robot.srdf.file))
    issues = [] if robot.srdf is None else [*robot.srdf.issues, *_unknown_links(robot, robot.srdf)]
    return allowed, [*_other_name(robot), *issues, *_checked_neighbours(robot)]


def _exempted(robot: SceneRobot, bodies: Mapping[str, Sequence[str]]) -> list[Rule]:
    """Rules for the pairs that the format does not check: of groups, then of links. bodies: of
    each link."""
    exempt, file = robot.robot.exempt, robot.robot.file
    if exempt is None:
        return []
    members = Counter(group for body in robot.bodies for group in body.groups)
    rules = [
        _allowed((robot.groups[e.a], robot.groups[e.b]), e.reason, file, Selector.exactly_group)
        for e in exempt.groups
        if (members[e.a] > 1 if e.a == e.b else members[e.a] and members[e.b])
    ]
    for e in exempt.links:
        for pair in product(bodies.get(e.a, ()), bodies.get(e.b, ())):
            rules.append(_allowed(pair, e.reason, file))
    for e in exempt.checked:
        if not (members[e.a] and members[e.b]):
            continue
        pair = robot.groups[e.a], robot.groups[e.b]
        rules.append(replace(_allowed(pair, e.reason, file, Selector.exactly_group), allowed=False))
    return rules


def _allowed(
    pair: tuple[str, str],
    reason: str,
    file: str,
    select: Callable[[str], Selector] = Selector.exactly,
) -> Rule:
    a, b = map(select, pair)
    return Rule(a=a, b=b, allowed=True, reason=reason, where=file, file=file)


def _other_name(robot: SceneRobot) -> list[Issue]:
    srdf, name = robot.srdf, robot.robot.name
    if srdf is None or srdf.robot == name:
        return []
    message = f"it names robot {srdf.robot!r} and is applied to {name!r}"
    return [issue("other-robot", message, file=srdf.file)]


def _unknown_links(robot: SceneRobot, srdf: Srdf) -> Iterator[Issue]:
    """Yield issues about links that the robot lacks. A pair that should be checked all the same
    blocks a pass."""
    links = robot.robot.links
    for link in sorted(srdf.links() - links.keys()):
        message = f"{srdf.file}: link {link!r} is not in the URDF: its entries are ignored"
        yield issue("unknown-body", message, file=srdf.file)
    for pair in sorted(map(sorted, srdf.enabled)):
        for link in sorted({*pair} - links.keys()):
            message = (
                f"enable_collisions names link {link!r}, which the robot lacks"
                f"{meant(link, links)}: the pair of {' and '.join(pair)} is not enabled"
            )
            yield issue("unread", message, file=srdf.file)


def _checked_neighbours(robot: SceneRobot) -> list[Issue]:
    if robot.robot.exempt is not None:
        return []
    permitted = robot.srdf.permission if robot.srdf else lambda *_: None
    checked = [f"{a} and {b}" for a, b in robot.neighbours() if permitted(a, b) is None]
    if not checked:
        return []
    pairs = "pair" if len(checked) == 1 else "pairs"
    message = (
        f"{len(checked)} {pairs} of links with a joint between them are checked like any other, "
        f"as no SRDF allows them to touch: {listed(checked)}"
    )
    return [issue("neighbours-checked", message, file=robot.robot.file)]
