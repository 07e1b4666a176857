"""The candidate axes of hard pairs show the relation that exact arithmetic finds."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from satcheck import core
from satcheck.audit.axes import axes_shown, relation_shown
from satcheck.core.axes import corners_of, edge_pairs, hull_of
from tests.hard_cases.case import ConvexPair, Family, Vertices
from tests.hard_cases.families import FAMILIES, large

# Every so many of the cases of a family, and no large hulls, to stay within seconds.
EVERY = 5
MOST_VERTICES = 200
SMALL = [family for family in FAMILIES if family is not large]


def polytope_of(points: Vertices) -> core.Polytope:
    no_triangles = np.zeros((1, 3), dtype=np.uint32)
    return core.Mesh(np.array(points), no_triangles).convex_hull()


def has_axes(pair: ConvexPair) -> bool:
    """Two polygons in one plane have others, and less than a polygon has none."""
    if max(len(pair.a), len(pair.b)) > MOST_VERTICES:
        return False
    dimensions = polytope_of(pair.a).dimension, polytope_of(pair.b).dimension
    together = polytope_of((*pair.a, *pair.b)).dimension
    return (min(dimensions) == 2 and together == 3) or dimensions == (3, 3)


def shown_by_axes(pair: ConvexPair) -> str:
    first, second = polytope_of(pair.a), polytope_of(pair.b)
    of_a, of_b = corners_of(first.vertices, second.vertices)
    step = max(float(np.abs(side.world).max()) for side in (of_a, of_b)) * 2.0**-53
    a, b = hull_of(first, of_a, step), hull_of(second, of_b, step)
    pairs = edge_pairs(a, b)
    return relation_shown(axes_shown(a, b, pairs.where(pairs.plain)))


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
