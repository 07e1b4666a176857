"""Open surfaces in contact: what crosses, what only meets, and the same answers as the core's."""

from __future__ import annotations

import numpy as np

from satcheck import core
from satcheck.verify.cells import no_crossing
from satcheck.verify.exact import Rejected
from satcheck.verify.surfaces import meeting
from satcheck.verify.world import Exact, World

Points = list[tuple[int, int, int]]
TWO = [(0, 1, 2), (1, 0, 3)]  # two triangles at the edge 0 1
FLOOR: Points = [(-9, -9, 0), (9, -9, 0), (0, 9, 0)]


def surface(points: Points, triangles: list[tuple[int, int, int]]) -> Exact:
    return Exact(World(np.array(points, float), np.array(triangles), False), 0)


def wings(p: tuple[int, int, int], q: tuple[int, int, int]) -> Exact:
    """Two triangles at the edge from (-1, 0, 0) to (1, 0, 0), with their third corners."""
    return surface([(-1, 0, 0), (1, 0, 0), p, q], TWO)


def why_not(a: Exact, b: Exact) -> str:
    """Why the check rejects them; empty where it does not."""
    try:
        no_crossing(a, b, meeting(a, b))
    except Rejected as why:
        return str(why)
    return ""


def crosses(a: Exact, b: Exact) -> bool:
    said = why_not(a, b)
    assert said == why_not(b, a)
    assert said in ("", "the surfaces cross")
    return said != ""


def floor() -> Exact:
    return surface(FLOOR, [(0, 1, 2)])


def test_an_edge_on_a_face() -> None:
    assert not crosses(wings((0, -1, 2), (0, 1, 2)), floor())  # a roof upside down
    assert crosses(wings((0, -1, -2), (0, 1, 2)), floor())
    assert not crosses(surface([(-1, 0, 0), (1, 0, 0), (0, 1, 2)], [(0, 1, 2)]), floor())


def test_an_edge_on_an_edge() -> None:
    valley = wings((0, -2, 2), (0, 2, 2))
    assert not crosses(valley, wings((0, -1, 3), (0, 1, 3)))  # one within the other
    assert not crosses(valley, wings((0, -2, -2), (0, 2, -2)))
    assert crosses(valley, wings((0, 0, 3), (0, 0, -3)))


def test_faces_that_pass_through_each_other() -> None:
    assert crosses(surface([(0, 0, -1), (1, 0, 2), (-1, 0, 2)], [(0, 1, 2)]), floor())


def test_a_point_is_no_crossing() -> None:
    assert not crosses(surface([(0, 0, 0), (1, 0, 2), (-1, 1, 2)], [(0, 1, 2)]), floor())


def test_surfaces_that_lie_in_each_other_are_left_undecided() -> None:
    flat = surface([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    assert why_not(flat, floor()) == "two open surfaces lie in each other"


def test_the_core_agrees_on_a_small_grid() -> None:
    """Strips of two triangles, where most contacts are along edges and through corners."""
    random = np.random.default_rng(3)
    seen = {"penetrating": 0, "touching": 0}
    for _ in range(600):
        a, b = (random.integers(-1, 2, size=(4, 3)) for _ in range(2))
        triangles = np.array(TWO, np.uint32)
        found = core.mesh_relation(
            *(core.Surface(core.Mesh(p.astype(float), triangles), False) for p in (a, b))
        )
        x, y = (Exact(World(p.astype(float), np.array(TWO), False), 0) for p in (a, b))
        if not found.proven or found.relation not in seen:
            continue
        said = why_not(x, y)
        if said != "two open surfaces lie in each other":
            assert bool(said) == (found.relation == "penetrating")
        seen[found.relation] += 1
    assert min(seen.values()) > 50
