"""A ball and meshes that are not convex, at places where the answer is known."""

from __future__ import annotations

import pytest

from satcheck.core.curved.in_mesh import is_free, relate
from satcheck.core.curved.triangles import against_triangles
from satcheck.core.shapes import Sphere
from tests.core.curved.bodies import l_bracket
from tests.core.curved.worlds import World, at

BRACKET = World(l_bracket())


@pytest.mark.parametrize(
    ("radius", "z", "relation"),
    [
        (0.25, 0.5, "inside"),  # in the middle of the arm from z = 0 to 1
        (0.5, 1.25, "penetrating"),
        (0.5, 1.5, "touching"),
        (0.5, 1.75, "separated"),
        (10.0, 0.5, "contains"),
        (0.5, 0.5, "penetrating"),  # touches the surface from within
    ],
)
def test_relations(radius: float, z: float, relation: str) -> None:
    ball = at(Sphere(radius), (2.5, 0.0, z)).curved
    assert ball is not None
    result = relate(ball, BRACKET, against_triangles(ball, BRACKET.mesh, 1.0), 1.0)
    assert (result.relation, result.proven) == (relation, True)
    assert is_free(ball, BRACKET) == (relation in ("separated", "touching"))
    if relation == "separated":
        assert result.signed is not None
        assert result.gap_lower == result.signed.lower <= 0.25 <= result.signed.upper


def test_beyond_reach_the_gap_is_more_than_that() -> None:
    ball = at(Sphere(0.5), (2.5, 0.0, 9.0)).curved
    assert ball is not None
    result = relate(ball, BRACKET, against_triangles(ball, BRACKET.mesh, 1.0), 1.0)
    assert (result.relation, result.signed) == ("separated", None)
    assert 1.0 < result.gap_lower < 7.5
