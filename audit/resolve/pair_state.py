"""The state of a pair at its current place: whether it fails a check, and its way out."""

from __future__ import annotations

import math
from itertools import product
from typing import Literal

from msgspec import Struct

from satcheck import core
from satcheck.audit.bodies.boxes import diagonal
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.ladder.cheap_bounds import way_out_of_hulls
from satcheck.audit.request.settings import FailOn
from satcheck.audit.severity import fails
from satcheck.audit.vectors import scaled, unit
from satcheck.core.conventions import Vector
from satcheck.core.rounding import rounding_pad
from satcheck.report.report import OVERLAPS, Finding


class PairState(Struct, frozen=True):
    """How a pair is judged where it is.

    open: a hole of one body leaves open whether they overlap. push: a translation of the first body
    that ends the overlap, widens the gap to the clearance, or leads away from the hole; None: none
    is known. excused: the bodies overlap at home, or may overlap, but no check fails on that, for
    example within the touch band.
    """

    kind: Literal["free", "overlap", "near", "open", "undecided"]
    push: Vector | None = None
    excused: bool = False


def is_objected(finding: Finding, fail_on: FailOn) -> bool:
    """Whether a check fails because of the pair, or cannot decide whether an overlap is within its
    limits."""
    if finding.undecided == "limit" and finding.at_rest in OVERLAPS:
        return True
    return fails(finding, fail_on)


def state_of(pair: Pair, finding: Finding) -> PairState:
    """finding: of the pair where its bodies are."""
    clearance = pair.request.clearance or 0.0
    if finding.relation == "indeterminate":
        push = None if pair.both_solid or pair.curved else way_outside(pair)
        return PairState("undecided" if push is None else "open", push)
    if not is_objected(finding, pair.settings.fail_on):
        return PairState("free")
    if finding.relation in OVERLAPS:
        return PairState(
            "overlap", finding.mtv and longer(finding.mtv, clearance - may_overlap(pair))
        )
    if finding.normal is None:
        return PairState("near", parting_step(pair, clearance))
    return PairState("near", scaled(finding.normal, (finding.distance or 0.0) - clearance))


def may_overlap(pair: Pair) -> float:
    """How deep the bodies may overlap; no overlap is thicker than it is deep. If depth is an
    interval, the limit is reduced by its width, so that the upper end stays below the limit. A
    limit of the volume gives no length."""
    limits = [pair.request.max_depth, pair.request.max_thickness]
    most = min((limit for limit in limits if limit is not None), default=0.0)
    if pair.request.max_volume is not None:
        return 0.0
    width = 0.0 if pair.both_convex else pair.settings.depth_width
    return most * (1 - width)


def is_overlap_excused(finding: Finding) -> bool:
    """Whether a finding that no check fails on is an overlap, or may be one."""
    return finding.exact_relation in OVERLAPS or finding.undecided is not None


def parting_step(pair: Pair, length: float) -> Vector | None:
    """The translation of A, of this length and towards a face, edge or corner of a cube, that
    leaves touching bodies farthest apart; None: none separates them."""
    best, way = 0.0, None
    for x, y, z in product((-1.0, 0.0, 1.0), repeat=3):
        if x == y == z == 0.0:
            continue
        step = scaled(unit((x, y, z)), length)
        moved = core.Surface(pair.a.mesh.translated(step), pair.a.solid)
        if core.mesh_relation(moved, pair.b.surface()).relation != "separated":
            continue
        gap = core.mesh_distance(moved, pair.b.surface()).distance
        if gap > best:
            best, way = gap, step
    return way


def out_of_hull(pair: Pair) -> Vector:
    """The shortest translation of A that parts the hulls and leaves the clearance between them."""
    way = way_out_of_hulls(pair)
    more = (pair.request.clearance or 0.0) + rounding_pad(pair.largest_coordinate)
    return scaled(way.normal, -(way.upper + more))


def way_outside(pair: Pair) -> Vector | None:
    """The same, if it is no longer than the smaller body: a spoon leaves its cup, but a chair does
    not leave the room."""
    way = out_of_hull(pair)
    small = min(diagonal(pair.a.bounds), diagonal(pair.b.bounds))
    return way if math.hypot(*way) <= small else None


def longer(way: Vector, by: float) -> Vector:
    length = math.hypot(*way)
    return scaled(way, (length + by) / length) if by and length else way
