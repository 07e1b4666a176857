"""Checks in a plane: what certificates about prisms prove about their outlines.

Each body is the prism over its outline, |z| <= height, where z is normal to the plane. Every height
exceeds the width of every body. Two prisms relate as their outlines do, with the same gap and
depth. Only containment depends on the heights, which outlines do not have. So a prism that is
claimed to contain the other one gets the greater height. Otherwise both get the same height, and
only their walls may separate them.

A polygon may replace a curve, within which it lies. A proof must then hold for every boundary
around the polygon whose distance from it is at most the deviation of the body.
"""

from __future__ import annotations

import numpy as np
from msgspec import UnsetType

from satcheck.report.certificate import (
    AxisProof,
    Certificate,
    ExactVector,
    Proof,
)
from satcheck.report.report import Finding
from satcheck.report.values import Relation
from satcheck.verify.distances import nothing_nearer
from satcheck.verify.exact import Rejected
from satcheck.verify.pairs import AnyPair, Pair, axis, vector
from satcheck.verify.world import World, stick_out

ACROSS = {"xy": 2, "yz": 0, "xz": 1}


def check_overlap_of_curves(relation: Relation | None, pair: Pair) -> None:
    """Rejects an exact relation of bodies that meet if it is proven of the polygons only. pair:
    with heights that suit the relation.

    A body lies within another if its polygon does, with more room than the deviation. Bodies
    overlap if their polygons do. Neither body contains the other if the box of each sticks out of
    the other by more than the deviation.
    """
    closer = pair.closer
    if not closer:
        return
    if relation in ("contains", "inside"):
        nothing_nearer(pair.a, pair.b, closer, closer)
        return
    if relation != "penetrating":
        raise Rejected(f"{relation!r} is shown of polygons alone, not of the curves")
    if not stick_out(pair.a.world, pair.b.world, closer, pair.across):
        raise Rejected("one body may hold the other, by what its curve is off its polygon")


def leaves_gap_of_curves(proof: Proof, pair: AnyPair) -> bool:
    """Return whether the polygons are as far apart along the axis as the curves may be off them."""
    closer = pair.closer
    return not closer or (isinstance(proof, AxisProof) and pair.gap(axis(proof.axis), closer) > 0)


def reaching(relation: Relation | None, a: World, b: World, across: int) -> tuple[World, World]:
    """The prisms with heights that suit the relation to be proven."""
    height = max(float(world.bounds[1][across]) for world in (a, b))
    heights: dict[Relation | None, tuple[float, float]] = {
        "contains": (2 * height, height),
        "inside": (height, 2 * height),
        "penetrating": (height, height),
        "coincident": (height, height),
    }
    if relation not in heights:
        return a, b
    high_a, high_b = heights[relation]
    return _reaching(a, high_a, across), _reaching(b, high_b, across)


def _reaching(world: World, height: float, across: int) -> World:
    vertices = world.vertices.copy()
    vertices[:, across] = np.copysign(height, vertices[:, across])
    return World(vertices, world.triangles, world.solid)


def check_in_plane(finding: Finding, certificate: Certificate, across: int) -> None:
    """Directions and moves of a finding, and of its certificate, run along the plane."""
    directions: list[ExactVector | UnsetType | None] = [finding.mtv, finding.normal]
    if not isinstance(certificate.depth, UnsetType):
        directions.append(certificate.depth.upper)
    if not isinstance(certificate.band, UnsetType):
        directions += [certificate.band.axis, certificate.band.move]
    for direction in directions:
        if isinstance(direction, tuple) and vector(direction)[across] != 0:
            raise Rejected("a direction leaves the plane")
