"""Curved shapes around contact: one outcome for every query, order and scale, never a wrong one.

Truth comes from rational arithmetic on the float64 sizes and positions.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import product
from typing import Any, Literal

import numpy as np
import pytest

from satcheck.core import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Hull,
    PairResult,
    Sphere,
    check_pair,
)
from tests.core.pair_checks import CURVED
from tests.oracles.random_shapes import random_hull, random_pose

Query = Literal["overlap", "depth", "distance"]
QUERIES: tuple[Query, ...] = ("overlap", "depth", "distance")
Pose = tuple[float, ...]

HULL = random_hull(np.random.default_rng(12), 16)
# Each kind, scaled.
KINDS: dict[str, Any] = {
    "hull": lambda k: Hull(HULL * k),
    "box": lambda k: Box((0.5 * k, 0.7 * k, 0.3 * k)),
    "sphere": lambda k: Sphere(0.6 * k),
    "capsule": lambda k: Capsule(0.3 * k, 0.5 * k),
    "cylinder": lambda k: Cylinder(0.5 * k, 0.7 * k),
    "cone": lambda k: Cone(0.6 * k, 0.8 * k),
    "ellipsoid": lambda k: Ellipsoid((0.5 * k, 0.8 * k, 0.6 * k)),
}
ROUND = ("sphere", "capsule", "cylinder", "cone", "ellipsoid")
# Changes of the gap, as parts of the size: at, around and beyond the rounding of float64.
STEPS = [
    0.0,
    *(sign * 10.0**exponent for exponent in (-17, -16, -15, -13, -11, -9, -7) for sign in (1, -1)),
]


def facts(result: PairResult) -> tuple[object, ...]:
    return result.outcome, result.distance, result.lower, result.upper


def along(pose: Pose, direction: np.ndarray, length: float) -> Pose:
    return (*(np.array(pose[:3]) + direction * length).tolist(), *pose[3:])


@pytest.mark.parametrize(
    ("one", "other"), [(a, b) for a, b in product(KINDS, ROUND) if (a, b) != ("ellipsoid", "hull")]
)
def test_one_answer_near_contact(one: str, other: str) -> None:
    """Pairs moved into contact, then a little off: the bounds say what the outcome says, whatever
    is asked, in whatever order, at whatever power of two."""
    rng = np.random.default_rng(abs(hash_of(one + other)))
    pose_a: Pose = random_pose(rng, 0.3)
    pose_b: Pose = random_pose(rng, 0.3)
    a, b = KINDS[one](1.0), KINDS[other](1.0)
    for _ in range(3):  # the way to contact is straight along the normal
        start = check_pair(a, b, pose_a, pose_b)
        assert start.distance is not None
        assert start.normal is not None
        pose_b = along(pose_b, -np.array(start.normal), start.distance)
    normal = np.array(start.normal)
    outcomes = set()
    for step in STEPS:
        placed = along(pose_b, normal, step)
        results = {query: check_pair(a, b, pose_a, placed, query=query) for query in QUERIES}
        outcome = results["depth"].outcome
        outcomes.add(outcome)
        assert {result.outcome for result in results.values()} == {outcome}
        assert_bounds_say(results["depth"])
        assert facts(results["depth"]) == facts(results["distance"])
        assert_mirrored(results["depth"], check_pair(b, a, placed, pose_a))
        assert check_pair(b, a, placed, pose_a, query="overlap").outcome == outcome
        for factor in (2.0**-30, 2.0**21):
            poses = [(*(c * factor for c in pose[:3]), *pose[3:]) for pose in (pose_a, placed)]
            large = check_pair(KINDS[one](factor), KINDS[other](factor), *poses)
            assert facts(large) == tuple(
                f * factor if isinstance(f, float) else f for f in facts(results["depth"])
            )
    assert outcomes == {"separated", "touching", "penetrating"} or outcomes == {
        "separated",
        "penetrating",
    }


def hash_of(text: str) -> int:
    return int.from_bytes(text.encode(), "little") % 2**32


def assert_bounds_say(result: PairResult) -> None:
    assert result.lower is not None
    assert result.upper is not None
    assert result.distance is not None
    assert result.lower <= result.distance <= result.upper
    if result.outcome == "separated":
        assert result.upper > 0
        assert result.lower >= 0
    elif result.outcome == "penetrating":
        assert result.lower < 0
        assert result.upper <= 0
    else:
        assert result.outcome == "touching"
        assert result.lower <= 0 <= result.upper


def assert_mirrored(one: PairResult, other: PairResult) -> None:
    assert facts(one) == facts(other)
    assert one.normal is not None
    assert other.normal is not None
    assert one.normal == tuple(-c for c in other.normal)
    assert (one.witness_a, one.witness_b) == (other.witness_b, other.witness_a)


@pytest.mark.parametrize(
    ("one", "other"), [(a, b) for a, b in product(KINDS, ROUND) if (a, b) != ("ellipsoid", "hull")]
)
def test_witness_points_of_deep_pairs(one: str, other: str) -> None:
    """They are `distance` apart along the normal to rounding, and each is a point of its shape."""
    rng = np.random.default_rng(hash_of(other + one))
    a, b = KINDS[one](1.0), KINDS[other](1.0)
    for _ in range(50):
        assert_witnesses(a, random_pose(rng, 0.3), b, random_pose(rng, 0.3))


def test_witness_points_of_a_splinter() -> None:
    """A ball in a cylinder: GJK encloses the contact, on a line of the mantle, in a tetrahedron
    without volume."""
    turned = (0.769846384920389, 1.8751916653381095, 0.6548183399021803, -0.00019462529205232696)
    place = (-0.0828774459810556, 0.12713535526270967, -0.5836930115733088)
    ball = Sphere(0.7850677656567919)
    cylinder = Cylinder(0.4632211535235027, 0.7813098287806761)
    other_turn = (-0.46661869143724904, 0.3881359709354622, 0.17199884168911286, 0.5654781884581037)
    assert_witnesses(cylinder, (0.0, 0.0, 0.0, *turned), ball, (*place, *other_turn))


def assert_witnesses(a: Any, pose_a: Pose, b: Any, pose_b: Pose) -> None:
    """Of shapes whose size is about 1. Rounding: 64 roundoffs of coordinates below 4."""
    result = check_pair(a, b, pose_a, pose_b)
    assert result.distance is not None
    assert result.witness_a is not None
    assert result.witness_b is not None
    between = np.subtract(result.witness_b, result.witness_a)
    assert np.abs(result.distance * np.array(result.normal) - between).max() <= 2.0**-45
    for shape, pose, witness in ((a, pose_a, result.witness_a), (b, pose_b, result.witness_b)):
        off = check_pair(shape, Hull(np.zeros((1, 3))), pose, tuple(witness))
        assert off.lower is not None
        assert off.lower <= CURVED


# ---- exact truth


def squared(*values: Fraction) -> Fraction:
    return sum((v * v for v in values), Fraction(0))


def nearest_in_box(point: list[Fraction], half: list[Fraction]) -> list[Fraction]:
    return [max(-h, min(h, p)) for p, h in zip(point, half, strict=True)]


def exact_outcome(core_squared: Fraction, reach: Fraction) -> str:
    """Of cores at that distance, with balls whose radii sum up to `reach` around them."""
    if core_squared == reach * reach:
        return "touching"
    return "separated" if core_squared > reach * reach else "penetrating"


def nudged(value: float, ulps: int) -> float:
    for _ in range(abs(ulps)):
        value = math.nextafter(value, math.inf if ulps > 0 else -math.inf)
    return value


def test_spheres_exactly() -> None:
    """Pythagorean contacts, and all that is a few ulps beside them."""
    for u, v in ((3, 4), (5, 12), (20, 21)):
        hypotenuse = math.isqrt(u * u + v * v)
        for dx, dr in product(range(-3, 4), repeat=2):
            centre = (nudged(u / 8, dx), v / 8, 0.0)
            radii = 0.25, nudged(hypotenuse / 8 - 0.25, dr)
            truth = exact_outcome(
                squared(*(Fraction(c) for c in centre)), Fraction(radii[0]) + Fraction(radii[1])
            )
            for query in QUERIES:
                result = check_pair(Sphere(radii[0]), Sphere(radii[1]), None, centre, query=query)
                assert result.outcome == truth, (centre, radii)


@pytest.mark.parametrize("far", [0.0, 2.0**20])
def test_spheres_and_boxes_exactly(far: float) -> None:
    """A ball at a face, an edge and a corner of a box; whole numbers make exact contacts."""
    half = (1.0, 2.0, 3.0)
    for extra in ((0.5, 0, 0), (0.375, 0.5, 0), (0.25, 0.25, 0.125), (0.25, 0.5, 0.5)):
        for ulps in range(-3, 4):
            centre = [h + e for h, e in zip(half, extra, strict=True)]
            centre = [c if e else c / 2 for c, e in zip(centre, extra, strict=True)]
            radius = nudged(math.sqrt(sum(e * e for e in extra)), ulps)
            point = [Fraction(c) for c in centre]
            near = nearest_in_box(point, [Fraction(h) for h in half])
            apart = squared(*(p - q for p, q in zip(point, near, strict=True)))
            truth = exact_outcome(apart, Fraction(radius))
            place = (far, -far, far)
            moved = tuple(c + p for c, p in zip(centre, place, strict=True))
            for query in QUERIES:
                result = check_pair(Box(half), Sphere(radius), place, moved, query=query)
                assert result.outcome == truth, (extra, ulps)


def test_capsules_exactly() -> None:
    """Crossed over each other, beside each other, end to end and end to side; unit quaternions of
    whole halves turn axes without rounding."""
    across = (0.5, 0.5, 0.5, 0.5)  # x to y to z to x
    a, half = 0.25, 2.0
    places: list[tuple[Pose, Fraction]] = [
        ((0.0, 0.75, 0.0, *across), Fraction(3, 4)),  # its axis is x: crossed
        ((0.75, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0), Fraction(3, 4)),
        ((0.0, 0.0, 4.75, 0.0, 0.0, 0.0, 1.0), Fraction(3, 4)),
        ((2.75, 0.0, 0.0, *across), Fraction(3, 4)),
    ]
    for pose, core in places:
        for ulps in range(-3, 4):
            radius = nudged(0.5, ulps)
            truth = exact_outcome(core * core, Fraction(a) + Fraction(radius))
            for query in QUERIES:
                result = check_pair(
                    Capsule(a, half), Capsule(radius, half), None, pose, query=query
                )
                assert result.outcome == truth, (pose, ulps)


def test_a_ball_on_a_slanted_face_exactly() -> None:
    """The plane x + 2y + 2z = 9 is three from the origin: a face of this hull holds (1, 2, 2)."""
    corners = np.array([[9, 0, 0], [1, 4, 0], [-3, 1, 5], [9, 9, 9]], dtype=float)
    for ulps in range(-3, 4):
        for query in QUERIES:
            result = check_pair(Hull(corners), Sphere(nudged(3.0, ulps)), query=query)
            expected = "separated" if ulps < 0 else "touching" if ulps == 0 else "penetrating"
            assert result.outcome == expected


@pytest.mark.parametrize("ulps", [*range(-4, 5), -40, 40, -4000, 4000, -(10**6), 10**6])
@pytest.mark.parametrize("lower", ["cylinder", "cone", "ellipsoid", "box"])
@pytest.mark.parametrize("upper", ["cylinder", "ellipsoid"])
def test_bounds_hold_the_truth(lower: str, upper: str, ulps: int) -> None:
    """Stacked on the axis: the gap is the height less both half heights, exactly."""
    heights = {"cylinder": 0.7, "cone": 0.8, "ellipsoid": 0.6, "box": 0.3}
    lift = heights[lower] + heights[upper] + ulps * 2.0**-52
    truth = Fraction(lift) - Fraction(heights[lower]) - Fraction(heights[upper])
    result = check_pair(KINDS[lower](1.0), KINDS[upper](1.0), None, (0.0, 0.0, lift))
    assert result.lower is not None
    assert result.upper is not None
    assert Fraction(result.lower) <= truth <= Fraction(result.upper)
    if result.outcome == "separated":
        assert truth > 0
    if result.outcome == "penetrating":
        assert truth < 0


@pytest.mark.parametrize("seed", range(40))
def test_deep_enough_is_what_the_whole_depth_says(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shapes: list[Any] = [
        Cylinder(0.7, 0.4),
        Cone(0.8, 0.6),
        Ellipsoid((0.3, 0.9, 0.6)),
        Capsule(0.3, 0.5),
        Box((0.5, 0.3, 0.8)),
    ]
    a, b = rng.choice(len(shapes), 2)
    pose = (*rng.uniform(-0.4, 0.4, 3), *rng.normal(size=4))
    whole = check_pair(shapes[a], shapes[b], None, pose)
    assert whole.lower is not None
    most = -whole.lower  # no depth is more
    for enough in (0.0, 0.5 * most, 0.99 * most, 1.01 * most, 2.0 * most):
        early = check_pair(shapes[a], shapes[b], None, pose, enough=max(enough, 0.0))
        assert early.outcome == whole.outcome
        if early.normal is None:
            assert early.outcome == "penetrating"
            assert enough < most
        else:
            assert (early.distance, early.normal) == (whole.distance, whole.normal)
