"""The pairs that a check of bodies at rest fails on, each with a way out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import product
from typing import Literal, NamedTuple

from msgspec.structs import replace

from satcheck import core
from satcheck.audit.bodies import BodyCache
from satcheck.audit.body import diagonal
from satcheck.audit.check import check
from satcheck.audit.pair import Pair
from satcheck.audit.planner import Planner
from satcheck.audit.settings import Settings
from satcheck.audit.stages.depth import way_out_of_hulls
from satcheck.audit.vectors import scaled, unit
from satcheck.core.conventions import Vector
from satcheck.core.rounding import rounding_pad
from satcheck.report.report import OVERLAPS, Finding
from satcheck.report.settings import FailOn
from satcheck.report.verdict import fails
from satcheck.scene import Body, Rule, Scene, Selector
from satcheck.scene.bodies import IDENTITY

BodyPair = tuple[str, str]


class Conflict(NamedTuple):
    """A pair that does not pass. open: a hole of one body leaves open whether they overlap. push: a
    translation of the first body that ends the overlap, widens the gap to the clearance, or leads
    away from the hole; None: none is known."""

    kind: Literal["overlap", "near", "open"]
    push: Vector | None


class Checked(NamedTuple):
    """What a check found. planner: what it asks of two bodies, by their places among the sorted
    ids."""

    findings: tuple[Finding, ...]
    conflicts: dict[BodyPair, Conflict]
    planner: Planner


def at_rest(scene: Scene) -> Scene:
    """Return the bodies without motions, and sorted, so that their order does not matter."""
    return replace(
        scene,
        bodies=tuple(sorted(scene.bodies, key=lambda body: body.id)),
        order=tuple(sorted(body.id for body in scene.in_order())),
        motions=(),
        joint_path=None,
        body_rules=(),
    )


def strict(scene: Scene, findings: tuple[Finding, ...], fail_on: FailOn) -> Scene:
    """Return the scene without touch bands, as moved bodies have to be free. findings: of its
    check: a pair whose overlap its band excuses keeps it."""
    excused = (
        Rule(a=Selector.exactly(each.a), b=Selector.exactly(each.b), tolerance=each.tolerance)
        for each in findings
        if each.tolerance is not None
        and not is_objected(each, fail_on)
        and (each.exact_relation in OVERLAPS or each.undecided is not None)
    )
    rules = (
        rule if rule.tolerance is None else replace(rule, tolerance=0.0) for rule in scene.rules
    )
    return replace(scene, rules=(*rules, *excused))


def check_at_rest(scene: Scene, settings: Settings, cache: BodyCache) -> Checked:
    """scene: sorted, at rest. cache: of its earlier checks."""
    report = check(scene, settings, cache=cache, least=0)
    assert cache.book is not None
    planner = Planner(settings, cache.book, scene.composed)
    place = {id_: number for number, id_ in enumerate(scene.order)}
    conflicts = {}
    for finding in report.findings:
        a, b = (cache.placed.get(id_) for id_ in (finding.a, finding.b))
        if a is not None and b is not None:
            pair = Pair(a, b, settings, planner.request(place[finding.a], place[finding.b]))
            conflict = _conflict(pair, finding)
            if conflict is not None:
                conflicts[finding.a, finding.b] = conflict
    return Checked(report.findings, conflicts, planner)


def is_objected(finding: Finding, fail_on: FailOn) -> bool:
    """Return whether a check fails because of the pair, or cannot decide whether an overlap is
    within its limits."""
    if finding.undecided == "limit" and finding.at_rest in OVERLAPS:
        return True
    return fails(finding, fail_on)


def _conflict(pair: Pair, finding: Finding) -> Conflict | None:
    clearance = pair.request.clearance or 0.0
    if finding.relation == "indeterminate":
        push = None if pair.both_solid or pair.curved else _way_outside(pair)
        return push and Conflict("open", push)
    if not is_objected(finding, pair.settings.fail_on):
        return None
    if finding.relation in OVERLAPS:
        more = clearance - _may_overlap(pair)
        return Conflict("overlap", finding.mtv and longer(finding.mtv, more))
    if finding.normal is None:
        return Conflict("near", _parting_step(pair, clearance))
    return Conflict("near", scaled(finding.normal, (finding.distance or 0.0) - clearance))


def _may_overlap(pair: Pair) -> float:
    """Return how deep the bodies may overlap; no overlap is thicker than it is deep. If depth is an
    interval, the limit is reduced by its width, so that the upper end stays below the limit. A
    limit of the volume gives no length."""
    limits = [pair.request.max_depth, pair.request.max_thickness]
    most = min((limit for limit in limits if limit is not None), default=0.0)
    if pair.request.max_volume is not None:
        return 0.0
    return most if pair.both_convex else most * (1 - pair.settings.width)


def _parting_step(pair: Pair, length: float) -> Vector | None:
    """Return the translation of A, of this length and towards a face, edge or corner of a cube,
    that leaves touching bodies farthest apart; None: none separates them."""
    best, way = 0.0, None
    for x, y, z in product((-1.0, 0.0, 1.0), repeat=3):
        if x or y or z:
            step = scaled(unit((x, y, z)), length)
            moved = core.Surface(pair.a.mesh.translated(step), pair.a.solid)
            if core.mesh_relation(moved, pair.b.surface()).relation == "separated":
                gap = core.mesh_distance(moved, pair.b.surface()).distance
                best, way = max((best, way), (gap, step), key=lambda found: found[0])
    return way


def _way_outside(pair: Pair) -> Vector | None:
    """Return the shortest translation of A that parts the hulls and leaves the clearance between
    them, if it is no longer than the smaller body: a spoon leaves its cup, but a chair does not
    leave the room."""
    way = way_out_of_hulls(pair)
    length = way.upper + (pair.request.clearance or 0.0) + rounding_pad(pair.largest_coordinate)
    small = min(diagonal(pair.a.bounds), diagonal(pair.b.bounds))
    return scaled(way.normal, -length) if length <= small else None


def longer(way: Vector, by: float) -> Vector:
    length = math.hypot(*way)
    return scaled(way, (length + by) / length) if by and length else way


def translated(body: Body, offset: Vector) -> Body:
    """Return the body, moved in the world; each entry of its placement is rounded once."""
    transform = list(body.transform or IDENTITY)
    for row in range(3):
        transform[4 * row + 3] += offset[row]
    return replace(body, transform=tuple(transform))


def moved_scene(scene: Scene, translations: Mapping[str, Vector]) -> Scene:
    """Return the scene with these bodies, by id, moved in the world."""
    bodies = (
        translated(body, translations[body.id]) if body.id in translations else body
        for body in scene.bodies
    )
    return replace(scene, bodies=tuple(bodies))
