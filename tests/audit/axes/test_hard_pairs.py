"""The candidate axes of hard pairs show the relation that exact arithmetic finds."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from satcheck import core
from satcheck.audit.axes import axes_shown, relation_shown
from satcheck.core.axes.candidates import candidates, edge_pairs, features_of
from satcheck.core.axes.shadows import Points
from tests.hard_cases.case import ConvexPair, Family, Vertices
from tests.hard_cases.families import FAMILIES, large

# Every so many of the cases of a family, and no large hulls, to stay within seconds.
EVERY = 5
MOST_VERTICES = 200
SMALL = [family for family in FAMILIES if family is not large]


def hull_of(points: Vertices) -> core.Polytope:
    no_triangles = np.zeros((1, 3), dtype=np.uint32)
    return core.Mesh(np.array(points), no_triangles).convex_hull()


def has_axes(pair: ConvexPair) -> bool:
    """Two polygons in one plane have others, and less than a polygon has none."""
    if max(len(pair.a), len(pair.b)) > MOST_VERTICES:
        return False
    dimensions = hull_of(pair.a).dimension, hull_of(pair.b).dimension
    together = hull_of((*pair.a, *pair.b)).dimension
    return (min(dimensions) == 2 and together == 3) or dimensions == (3, 3)


def shown_by_axes(pair: ConvexPair) -> str:
    hulls = hull_of(pair.a), hull_of(pair.b)
    points = Points(np.concatenate([np.asarray(hull.vertices) for hull in hulls]))
    step = float(np.abs(points.world).max()) * 2.0**-53
    a = features_of(hulls[0], 0, points, step)
    b = features_of(hulls[1], hulls[0].vertex_count, points, step)
    found = candidates(a, b, edge_pairs(a, b), noise=False)
    return relation_shown(axes_shown(found, points, a.points, b.points))


@pytest.mark.parametrize("family", SMALL, ids=lambda family: family.CATEGORY)
def test_axes_show_the_exact_relation(family: Family) -> None:
    tried = 0
    for pair in list(family.cases(0))[::EVERY]:
        if has_axes(pair):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                assert shown_by_axes(pair) == pair.truth().outcome, pair.name
            tried += 1
    assert tried >= 10
