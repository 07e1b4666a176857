"""Bounds of the depth of an overlapping pair that need no search."""

from __future__ import annotations

from msgspec import Struct

from satcheck import core
from satcheck.audit.bodies.boxes import box_escape
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.verdict import Verdict
from satcheck.core.conventions import Vector


class WayOut(Struct, frozen=True):
    """length: of the nominal translation along -normal; upper: that length rounded outward; by:
    the shapes that it frees."""

    length: float
    upper: float
    normal: Vector
    by: str


def way_out_of_hulls(pair: Pair) -> WayOut:
    """A translation that frees A for certain: out of B's hull, or of B's box if the ladder ends
    there."""
    length, normal = box_escape(pair.a.bounds, pair.b.bounds)
    boxes = WayOut(length, length, normal, "world boxes")
    if not pair.may("hull"):
        return boxes
    hulls = core.check_pair(pair.a.hull_shape(), pair.b.hull_shape(), query="depth")
    if hulls.distance is None or hulls.lower is None or hulls.normal is None:
        return boxes
    if hulls.outcome == "touching":
        return WayOut(0.0, 0.0, hulls.normal, "hulls of the whole meshes")
    if hulls.outcome != "penetrating":
        return boxes
    return WayOut(-hulls.distance, -hulls.lower, hulls.normal, "hulls of the whole meshes")


def gap_around(pair: Pair, verdict: Verdict) -> float:
    """A lower bound of the depth of nested bodies: the inner body is not free before the surfaces
    meet. 0.0 for other pairs."""
    if verdict.relation not in ("contains", "inside"):
        return 0.0
    climb = verdict.climb
    if climb is not None and climb.relation == verdict.relation and climb.least_depth is not None:
        return climb.least_depth  # no triangles of nested bodies cross
    return core.nested_depth(pair.a.geometry, pair.b.geometry)
