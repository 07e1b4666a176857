"""Inputs that say the same get the same answer: hard pairs and sample pairs, each in variants.

Where a variant moves no surface, the answer has equal bits: scaled by a power of two, vertices and
faces in another order, A and B swapped. If both bodies are turned as one, the rounding of their
coordinates moves the two surfaces together by at most d. Supporting planes, closest points and the
surface around a ball move by no more, so a gap or a depth changes by at most d, a thickness by 2 d.
A relation may change only where d brings surfaces together or empties the common interior.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck import Finding, Settings, check_meshes, core, load_scene
from satcheck.report.report import OVERLAPS
from tests.hard_cases.case import ConvexPair
from tests.hard_cases.families import FAMILIES, flats, large, slivers
from tests.hard_cases.judge_convex import WIDEST
from tests.hard_cases.mesh_case import MIRRORED, MeshData
from tests.hard_cases.mesh_families import FAMILIES as MESH_FAMILIES

Points = NDArray[np.float64]
Side = tuple[Points, NDArray[Any]]  # vertices (n, 3), triangles (m, 3)
Ends = tuple[float, float]

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
SAMPLE_PAIRS = [
    ("box.obj", "box_pushed.stl"),
    ("box.obj", "box_flush.stl"),
    ("box.obj", "cube.off"),
    ("box.obj", "box.obj"),
    ("needle.stl", "box.obj"),
    ("far_a.obj", "far_b.obj"),
    ("l_bracket.obj", "peg_in_notch.ply"),
    ("l_bracket.obj", "peg_in_arm.ply"),
    ("l_bracket.obj", "seed_in_arm.stl"),
    ("ring.glb", "rod.stl"),
    ("open_box.off", "cube.off"),
    ("fin_box.obj", "box_pushed.stl"),
    ("kettle.obj", "snowflake.obj"),
]
# The hull of points in a plane is no solid.
SOLID_FAMILIES = [family for family in FAMILIES if family is not flats]
CATEGORIES = [family.CATEGORY for family in SOLID_FAMILIES]
CATEGORIES += [*(family.CATEGORY for family in MESH_FAMILIES), "samples"]
# At most so many pairs a category, chosen by the seed, and turns a pair. Large hulls take long.
PAIRS, SEED, TURNS, TURNS_OF_LARGE = 24, 5, 3, 1

U = 2.0**-53  # unit roundoff of float64
# A figure of the convex tier lies in its proven bounds. They close to two support errors of 40 u
# and 16 u of slack, all times the scale of the pair: the extents of both and their offset, each at
# most twice the largest coordinate. The chain of operations of the mesh tier, 64 u, is shorter.
FIGURE_ROUNDOFFS = (2 * 40 + 16) * 6
# A turned coordinate is a row of integers times a vertex, over an integer: a product, two sums and
# a quotient round 4 times. The row over the integer is a unit vector, so the coordinate is off by
# at most 4 u times the length of the vertex. Three coordinates: times the root of 3. Two surfaces:
# twice that, which is less than 14 u; terms of second order do not reach 15.
TURN_ROUNDOFFS = 15


class Pair(NamedTuple):
    """figure_error: how far a figure may be off, as a share of the largest coordinate. may_jump:
    a fit may be so snug that the least displacement closes the shortest way out."""

    name: str
    a: Side
    b: Side
    figure_error: float = FIGURE_ROUNDOFFS * U
    may_jump: bool = False

    @property
    def largest(self) -> float:
        return float(max(np.abs(self.a[0]).max(), np.abs(self.b[0]).max()))

    @property
    def shortest_edge(self) -> float:
        sides = [points[faces] for points, faces in (self.a, self.b)]
        edges = [np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2) for corners in sides]
        return float(min(lengths.min() for lengths in edges))

    def mapped(self, change: Callable[[Points], Points]) -> Pair:
        return self._replace(a=(change(self.a[0]), self.a[1]), b=(change(self.b[0]), self.b[1]))


@cache
def answers(category: str) -> list[tuple[Pair, Finding]]:
    return [(pair, ask(pair)) for pair in pairs(category)]


def ask(pair: Pair) -> Finding:
    """Every figure: the clearance is more than any gap, and a power of two that scales along."""
    reach = math.ldexp(1.0, math.frexp(pair.largest)[1] + 3)
    settings = Settings(tolerance=0.0, clearance=reach, depth=True, budget=0.05, jobs=1)
    return check_meshes(pair.a, pair.b, settings=settings)


def pairs(category: str) -> list[Pair]:
    if category == "samples":
        return [of_files(*names) for names in SAMPLE_PAIRS]
    draw = random.Random(SEED)
    for family in SOLID_FAMILIES:
        if category == family.CATEGORY:
            error = WIDEST if family is slivers else FIGURE_ROUNDOFFS * U
            solid = [pair for pair in family.cases(SEED) if is_solid(pair.a) and is_solid(pair.b)]
            return [of_hulls(pair, error) for pair in draw.sample(solid, min(PAIRS, len(solid)))]
    (cases,) = (list(f.cases(SEED)) for f in MESH_FAMILIES if category == f.CATEGORY)
    chosen = draw.sample(cases, PAIRS)
    return [Pair(p.name, arrays(p.a), arrays(p.b), may_jump=True) for p in chosen]


def of_files(*names: str) -> Pair:
    scene = load_scene([SAMPLES / name for name in names], units="m")
    a, b = (body.world_mesh() for body in scene.bodies)
    return Pair(" ".join(names), (a.vertices, a.triangles), (b.vertices, b.triangles))


def is_solid(points: Any) -> bool:
    edges = np.array(points) - np.array(points)[0]
    return bool(np.linalg.matrix_rank(edges / (np.abs(edges).max() or 1.0)) == 3)


def of_hulls(pair: ConvexPair, figure_error: float) -> Pair:
    a, b = (hull(np.array(points)) for points in (pair.a, pair.b))
    return Pair(pair.name, a, b, figure_error)


def hull(points: Points) -> Side:
    found = core.Geometry(core.Mesh(points, np.array([[0, 1, 2]])), False).hull()
    return found.vertices, found.triangles


def arrays(data: MeshData) -> Side:
    return np.array(data.vertices), np.array(data.triangles)


def reordered(side: Side, draw: np.random.Generator) -> Side:
    """Vertices, faces and the first corner of each face in another order."""
    points, faces = side
    order = draw.permutation(len(points))
    named = np.argsort(order)[faces]
    first = draw.integers(0, 3, (len(faces), 1))
    corners = np.take_along_axis(named, (first + np.arange(3)) % 3, axis=1)
    return points[order], draw.permutation(corners)


def turned(pair: Pair, draw: random.Random) -> tuple[Pair, float]:
    """Both bodies turned about the origin by a rational rotation, that of a quaternion of integers,
    and how far rounding moves their surfaces together at most."""
    a, b, c, d = (draw.choice((-1, 1)) * draw.randint(1, 9) for _ in range(4))
    n = a * a + b * b + c * c + d * d
    rows = (
        (a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)),
        (2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)),
        (2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d),
    )

    def turn(points: Points) -> Points:
        x, y, z = points.T
        return np.stack([(row[0] * x + row[1] * y + row[2] * z) / n for row in rows], axis=1)

    # The length of a vertex is at most the root of 3 times the largest coordinate.
    return pair.mapped(turn), TURN_ROUNDOFFS * U * math.sqrt(3) * pair.largest


def figures(finding: Finding, scale: float = 1.0, *, swapped: bool = False) -> dict[str, Any]:
    """What a variant must not change, in the scale and the order of the pair as given."""
    sign = -1.0 if swapped else 1.0
    relation = str(finding.exact_relation)
    made: dict[str, Any] = {
        "relation": MIRRORED.get(relation, relation) if swapped else relation,
        "quality": finding.quality,
        "normal": times(sign, finding.normal),
        "mtv": times(sign / scale, finding.mtv),
    }
    for name in ("distance", "depth", "depth_bounds", "thickness", "thickness_bounds"):
        made[name] = times(1 / scale, getattr(finding, name))
    if finding.witness is not None:
        ends = [times(1 / scale, end) for end in (finding.witness.a, finding.witness.b)]
        made["witness"] = ends[::-1] if swapped else ends
    return made


def times(factor: float, value: Any) -> Any:
    """A number or numbers; -0.0 becomes 0.0."""
    if value is None:
        return None
    return tuple(np.multiply(value, factor).ravel() + 0.0)


def beyond(given: Finding, varied: Finding, pair: Pair, moved: float) -> list[str]:
    """What changed by more than surfaces can that move by so much together."""
    relations = (given.exact_relation, varied.exact_relation)
    if None in relations:
        return [] if relations == (None, None) else ["proof"]
    overlap = [relation in OVERLAPS for relation in relations]
    bound = moved + 2 * pair.figure_error * pair.largest
    found = []
    if relations[0] != relations[1]:
        holds = (hold(finding, pair, nested=all(overlap)) for finding in (given, varied))
        found += ["relation"] * (max(holds) > bound)
    if not (pair.may_jump and any(overlap)) and between(signed(given), signed(varied)) > bound:
        found.append("depth" if any(overlap) else "distance")
    if between(given.thickness_bounds, varied.thickness_bounds) > 2 * bound:
        found.append("thickness")
    return found


def hold(finding: Finding, pair: Pair, *, nested: bool) -> float:
    """The bodies stay apart, or go on to overlap, while their surfaces move by less than this
    together. nested: the one in the other stays there."""
    if nested:
        if finding.exact_relation not in MIRRORED:
            return 0.0
        a, b = (core.Surface(core.Mesh(*side), False) for side in (pair.a, pair.b))
        return core.mesh_distance(a, b).distance
    if finding.exact_relation in OVERLAPS:
        return finding.thickness_bounds[0] / 2 if finding.thickness_bounds else 0.0
    return finding.distance or 0.0


def signed(finding: Finding) -> Ends | None:
    """Bounds of the signed distance: > 0 a gap, < 0 an overlap."""
    if finding.distance is not None:
        return finding.distance, finding.distance
    bounds = finding.depth_bounds
    return None if bounds is None else (-bounds[1], -bounds[0])


def between(one: Ends | None, other: Ends | None) -> float:
    """How far two intervals are apart."""
    if one is None or other is None:
        return 0.0
    return max(one[0] - other[1], other[0] - one[1], 0.0)


@pytest.mark.parametrize("category", CATEGORIES)
def test_a_power_of_two_scales_every_figure(category: str) -> None:
    for pair, given in answers(category):
        for factor in (2.0**7, 2.0**-9):
            varied = ask(pair.mapped(partial(np.multiply, factor)))
            assert figures(varied, factor) == figures(given), pair.name


@pytest.mark.parametrize("category", CATEGORIES)
def test_the_order_of_vertices_and_faces_changes_no_bit(category: str) -> None:
    draw = np.random.default_rng(SEED)
    for pair, given in answers(category):
        varied = ask(pair._replace(a=reordered(pair.a, draw), b=reordered(pair.b, draw)))
        assert figures(varied) == figures(given), pair.name


@pytest.mark.parametrize("category", CATEGORIES)
def test_swapped_bodies_get_the_mirrored_answer(category: str) -> None:
    """The way out is verified with A moved, which may add a rounding to its length."""
    for pair, given in answers(category):
        if given.exact_relation == "coincident":
            continue  # swapping them changes nothing
        expected = figures(given)
        found = figures(ask(pair._replace(a=pair.b, b=pair.a)), swapped=True)
        one, other = expected.pop("mtv"), found.pop("mtv")
        assert found == expected, pair.name
        if one is not None:
            assert math.dist(one, other) <= pair.figure_error * pair.largest, pair.name


@pytest.mark.parametrize("category", CATEGORIES)
def test_a_turn_changes_an_answer_within_its_rounding(category: str) -> None:
    """A wall thinner than the displacement may vanish: then it is another body."""
    draw, judged = random.Random(SEED), 0
    turns = TURNS_OF_LARGE if category == large.CATEGORY else TURNS
    for pair, given in answers(category):
        for _ in range(turns):
            varied, moved = turned(pair, draw)
            if varied.shortest_edge > moved:
                assert not beyond(given, ask(varied), varied, moved), pair.name
                judged += 1
    assert judged > turns * len(answers(category)) // 2


def test_a_changed_answer_is_seen() -> None:
    (pushed, given), (_, flush), (apart, gap), *_ = answers("samples")
    off, low = 1e-12, (given.thickness_bounds or (0.0,))[0]
    assert not beyond(given, given, pushed, 0.0)
    assert beyond(given, replace(given, depth_bounds=(1 + off, 1 + off)), pushed, 0.0) == ["depth"]
    thinner = replace(given, thickness_bounds=(low - 0.5, low - off))
    assert beyond(given, thinner, pushed, 0.0) == ["thickness"]
    assert beyond(gap, replace(gap, distance=0.5 + off), apart, 0.0) == ["distance"]
    assert beyond(gap, flush, apart, off) == ["relation", "distance"]
    assert beyond(given, replace(given, exact_relation=None), pushed, 0.0) == ["proof"]
    nested = next((p, f) for p, f in answers("samples") if f.exact_relation == "contains")
    crossing = replace(nested[1], exact_relation="penetrating")
    assert beyond(nested[1], crossing, nested[0], 0.0) == ["relation"]
    assert figures(replace(given, depth=1 + off)) != figures(given)
