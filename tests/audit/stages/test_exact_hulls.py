"""Exact GJK and EPA beside the core's."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
from msgspec import convert

from satcheck import core
from satcheck.audit.stages.exact_hulls import expanded, nearest_point
from satcheck.report.certificate import Polytope
from satcheck.verify.depth import inner_radius_exceeds
from satcheck.verify.exact import dot, lattice
from satcheck.verify.pairs import Pair
from satcheck.verify.world import Exact, World


def test_depth_and_distance_are_those_of_the_core() -> None:
    random = np.random.default_rng(3)
    overlaps = 0
    for _ in range(20):
        clouds = [random.normal(size=(12, 3)), random.normal(size=(12, 3)) + random.random(3) * 4]
        hulls = [core.Mesh(c, np.arange(12, dtype=np.uint32).reshape(-1, 3)) for c in clouds]
        shapes = [core.Hull(mesh.convex_hull()) for mesh in hulls]
        k = lattice(*clouds)
        worlds = [World(c, np.arange(12).reshape(-1, 3), False) for c in clouds]
        pair = Pair(Exact(worlds[0], k), Exact(worlds[1], k))
        truth = core.check_pair(*shapes, query="depth")
        found = expanded(pair, Fraction(10**6))
        assert found is not None
        assert found.overlaps == (truth.outcome == "penetrating")
        distance = truth.distance or 0.0
        if found.overlaps:
            overlaps += 1
            polytope = convert({"vertices": found.vertices, "faces": found.faces}, Polytope)
            # Its nearest face is one of the difference itself: both bounds meet there.
            inner_radius_exceeds(polytope, pair.a, pair.b, Fraction(-distance * (1 - 1e-12)))
            n = tuple(Fraction(c) for c in found.axis)
            assert pair.gap(n, Fraction(distance * (1 + 1e-12))) >= 0  # type: ignore[arg-type]
        else:
            x = nearest_point(pair).point
            gap = math.sqrt(dot(x, x)) / 2.0**k
            assert math.isclose(gap, core.check_pair(*shapes, query="distance").distance or 0.0)
    assert 0 < overlaps < 20
