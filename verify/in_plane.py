"""Checks in a plane: what certificates of prisms prove of the outlines that they stand over.

Each body is the prism over its outline, |z| <= its height, where z runs across the plane, and all
reach farther than any body is wide. Prisms are apart, or touch, or overlap, exactly where their
outlines do, and are as far apart and as deep in each other. Which of them holds the other depends
on heights that no outline has. So one that is said to hold the other is made to reach beyond it.
Where neither does, both have one height, and only their walls may tell them apart.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from satcheck.verify.evidence import member, on_body, vector
from satcheck.verify.exact import Rejected
from satcheck.verify.relations import Pair
from satcheck.verify.world import World

ACROSS = {"xy": 2, "yz": 0, "xz": 1}
Json = dict[str, Any]


def reaching(relation: str, a: World, b: World, across: int) -> tuple[World, World]:
    """The prisms with heights that suit the relation to be proven."""
    height = max(float(world.bounds[1][across]) for world in (a, b))
    heights = {
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


def check_in_plane(finding: Json, across: int) -> None:
    """Directions and moves of a finding, and of its certificate, run along the plane."""
    certificate = finding["certificate"]
    parts = [finding["mtv"], finding["normal"], (certificate.get("depth") or {}).get("upper")]
    band = certificate.get("band") or {}
    for direction in (*parts, band.get("axis"), band.get("move")):
        if direction is not None and vector(direction)[across] != 0:
            raise Rejected("a direction leaves the plane")


def check_proof_in_plane(proof: Json, pair: Pair, across: int) -> None:
    """What shows that neither outline holds the other: no axis across the plane, and no point at
    the ends of the prisms, which are of one height."""
    for key in ("a_reaches", "b_reaches"):
        if key in proof and vector(proof[key])[across] != 0:
            raise Rejected("an axis leaves the plane")
    if "meet" in proof:
        p = on_body(member(proof["meet"], "a"), pair.a, of_hull=False)
        ends = {abs(point[across]) for point in pair.a.points}
        if abs(p[across]) in ends:
            raise Rejected("the common point lies at the end of a prism")
