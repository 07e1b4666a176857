"""The verdict on a pair of bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck.core.conventions import Vector
from satcheck.report.report import Relation

if TYPE_CHECKING:
    from satcheck import core
    from satcheck.core.curved.signed import Signed


class Verdict(Struct, frozen=True):
    """How two bodies relate, without a touch band.

    proven: False if --accuracy or a degenerate contact leaves the relation open. overlaps: an
    overlap is proven, but it is open whether one body contains the other. gap_lower: a proven lower
    bound of the distance; 0.0: none is known. signed_distance: of two convex bodies, if it decides
    everything about them. crossing: indices of one triangle of each body that meet; point: a common
    point, rounded. reason: why the relation is not proven, unless --accuracy is the reason. climb:
    of the core, if the core settled the pair.
    """

    relation: Relation
    proven: bool
    gap_lower: float = 0.0
    signed_distance: core.PairResult | Signed | None = None
    crossing: tuple[int, int] | None = None
    point: Vector | None = None
    reason: str | None = None
    climb: core.Climb | None = None
    overlaps: bool = False
