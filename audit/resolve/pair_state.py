"""The state of a pair at its current place: whether it fails a check, and its way out."""

from __future__ import annotations

import math
from itertools import product
from typing import Literal

from msgspec import Struct

from satcheck import core
from satcheck.audit.body import diagonal
from satcheck.audit.pair import Pair
from satcheck.audit.settings import FailOn
from satcheck.audit.stages.depth import way_out_of_hulls
from satcheck.audit.vectors import scaled, unit
from satcheck.core.conventions import Vector
from satcheck.core.rounding import rounding_pad
from satcheck.report.report import OVERLAPS, Finding
from satcheck.report.verdict import fails


class PairState(Struct, frozen=True):
    """The judgement of a pair where it is.

    open: a hole of one body leaves open whether they overlap. push: a translation of the first body
    that ends the overlap, widens the gap to the clearance, or leads away from the hole; None: none
    is known. excused: the bodies overlap at home, or may overlap, but no check fails on that, for
    example within the touch band.
    """

    kind: Literal["free", "overlap", "near", "open", "undecided"]
    push: Vector | None = None
    excused: bool = False

    @property
    def is_unresolved(self) -> bool:
        return self.kind in ("overlap", "near", "open")


def is_objected(finding: Finding, fail_on: FailOn) -> bool:
    """Return whether a check fails because of the pair, or cannot decide whether an overlap is
    within its limits."""
    if finding.undecided == "limit" and finding.at_rest in OVERLAPS:
        return True
    return fails(finding, fail_on)


def state_of(pair: Pair, finding: Finding, *, banded: bool) -> PairState:
    """finding: of the pair where its bodies are. banded: the touch band applied, which may excuse
    an overlap."""
    clearance = pair.request.clearance or 0.0
    objected = is_objected(finding, pair.settings.fail_on)
    if finding.relation == "indeterminate":
        push = None if pair.both_solid or pair.curved else _way_outside(pair)
        return PairState("undecided" if push is None else "open", push)
    if not objected:
        overlaps = finding.exact_relation in OVERLAPS or finding.undecided is not None
        return PairState("free", excused=banded and overlaps)
    if finding.relation in OVERLAPS:
        more = clearance - _may_overlap(pair)
        return PairState("overlap", finding.mtv and longer(finding.mtv, more))
    if finding.normal is None:
        return PairState("near", _parting_step(pair, clearance))
    return PairState("near", scaled(finding.normal, (finding.distance or 0.0) - clearance))


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
    """The translation of A, of this length and towards a face, edge or corner of a cube, that
    leaves touching bodies farthest apart; None: none separates them."""
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
    """The shortest translation of A that parts the hulls and leaves the clearance between them, if
    it is no longer than the smaller body: a spoon leaves its cup, but a chair does not leave the
    room."""
    way = way_out_of_hulls(pair)
    length = way.upper + (pair.request.clearance or 0.0) + rounding_pad(pair.largest_coordinate)
    small = min(diagonal(pair.a.bounds), diagonal(pair.b.bounds))
    return scaled(way.normal, -length) if length <= small else None


def longer(way: Vector, by: float) -> Vector:
    length = math.hypot(*way)
    return scaled(way, (length + by) / length) if by and length else way
