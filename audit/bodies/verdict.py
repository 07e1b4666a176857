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

    proven: False where a capped ladder or a degenerate contact leaves it open. overlaps: an overlap
    is proven although the relation is not: it is open whether one body holds the other.
    gap_lower: a proven lower bound of their distance, 0.0 where none is known.
    signed_distance: of two convex bodies, where it says everything about them.
    crossing: indices of one triangle of each body that meet; point: a common point, rounded.
    reason: why it is not proven, where --accuracy is not why. climb: what the core found, where
    the core settled the pair.
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
