"""Curved shapes whose signed distance has a closed form: exact truth for spheres, capsules,
cylinders, cones and ellipsoids, each with the others and with boxes and hulls.

A ball's radius is subtracted from the signed distance of what it is swept along: a sphere is a
point, a capsule a segment. Cylinders on parallel axes are a disc times an interval.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

import numpy as np

from satcheck import core
from tests.hard_cases.case import Points
from tests.hard_cases.score import Score
from tests.hard_cases.shapes import ball, box, moved, octahedron, prism, tetrahedron
from tests.oracles.exact_distance import Truth, exact_truth, root

CATEGORY = "curved shapes, closed forms"

GAPS = (1.0, 1e-3, 1e-6, -1e-6, -1e-3, -0.25)
FLIPPED = (1.0, 0.0, 0.0, 0.0)  # by 180 degrees about x, exactly
Offset = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class CurvedPair:
    """A at the origin of the world, B placed there; `size` is what errors are compared with."""

    name: str
    a: core.Shape
    b: core.Shape
    pose_b: tuple[float, ...]
    truth: Truth
    size: float = 2.0


def of(low: Fraction, high: Fraction) -> Truth:
    outcome = "separated" if low > 0 else "penetrating" if high < 0 else "touching"
    return Truth(outcome, low, high)


def less(truth: Truth, *radii: float) -> Truth:
    """The signed distance once both are grown by balls."""
    grown = sum((Fraction(r) for r in radii), Fraction(0))
    return of(truth.low - grown, truth.high - grown)


def cases(seed: int) -> Iterator[CurvedPair]:
    rng = np.random.default_rng(seed)
    yield from balls(rng)
    yield from swept(rng)
    yield from cylinders(rng)
    yield from tips()


def balls(rng: np.random.Generator) -> Iterator[CurvedPair]:
    """Sphere and sphere, ellipsoids that are spheres, along any direction and concentric."""
    for gap, radius in product(GAPS, (1.0, 1e-3, 1e3)):
        way = rng.normal(size=3)
        offset = way / np.linalg.norm(way) * (1.0 + radius + gap * min(radius, 1.0))
        place = (float(offset[0]), float(offset[1]), float(offset[2]))
        truth = less(exact_truth([place], [(0.0, 0.0, 0.0)]), 1.0, radius)
        name = f"spheres of 1 and {radius:g}, {gap:g}"
        size = max(1.0, radius)
        yield CurvedPair(name, core.Sphere(1.0), core.Sphere(radius), place, truth, size)
        if radius == 1.0:
            yield CurvedPair(
                f"round ellipsoids, {gap:g}",
                core.Ellipsoid((1, 1, 1)),
                core.Ellipsoid((1, 1, 1)),
                place,
                truth,
            )
    for small, large in ((0.5, 1.0), (1.0, 1.0), (1e-3, 1.0)):
        depth = Fraction(small) + Fraction(large)
        yield CurvedPair(
            f"concentric spheres of {small:g} and {large:g}",
            core.Sphere(small),
            core.Sphere(large),
            (0.0, 0.0, 0.0),
            of(-depth, -depth),
        )


def swept(rng: np.random.Generator) -> Iterator[CurvedPair]:
    """Spheres and capsules with hulls and with each other."""
    bodies: dict[str, Points] = {
        "box": box(),
        "tetrahedron": tetrahedron(),
        "octahedron": octahedron(),
        "prism": prism(12),
        "stone": ball(rng, 30),
    }
    cores: dict[str, tuple[core.Shape, Points]] = {
        "sphere": (core.Sphere(0.25), np.zeros((1, 3))),
        "capsule": (core.Capsule(0.25, 0.5), np.array([[0, 0, -0.5], [0, 0, 0.5]])),
    }
    places = [rng.normal(size=3) * spread for spread in (0.3, 0.8, 1.2, 1.8) for _ in range(3)]
    places += [
        np.array(p) for p in ((0, 0, 0), (1.25, 0, 0), (1.5, 0, 0), (1.5, 1.5, 0), (0, 0, 1))
    ]
    for (name, points), (kind, (make, swept_core)) in product(bodies.items(), cores.items()):
        for number, place in enumerate(places):
            offset = (float(place[0]), float(place[1]), float(place[2]))
            truth = less(exact_truth(points, moved(swept_core, *offset)), 0.25)
            label = f"{name} and {kind}, place {number}"
            yield CurvedPair(label, core.Hull(points), make, offset, truth)
    for (kind, (make, one)), (other, (make_other, two)) in product(cores.items(), cores.items()):
        for number, place in enumerate(places[3:]):
            offset = (float(place[0]), float(place[1]), float(place[2]))
            truth = less(exact_truth(one, moved(two, *offset)), 0.25, 0.25)
            yield CurvedPair(f"{kind} and {other}, place {number}", make, make_other, offset, truth)


def cylinders(rng: np.random.Generator) -> Iterator[CurvedPair]:
    """On parallel axes, side by side, end on end, and corner to corner."""
    for gap in GAPS:
        for where in ("side", "end", "rim"):
            turn = float(rng.uniform(0.2, 1.3))
            out = 1.5 + (0.5 if where == "end" else 1.0) * (gap if where != "end" else -1.0)
            up = 2.25 + (gap if where != "side" else -1.0)
            offset = (out * np.cos(turn), out * np.sin(turn), up)
            place = (float(offset[0]), float(offset[1]), float(offset[2]))
            yield CurvedPair(
                f"cylinders {where} to {where}, {gap:g}",
                core.Cylinder(1.0, 1.0),
                core.Cylinder(0.5, 1.25),
                place,
                parallel_cylinders(place, 1.5, 2.25),
            )
            if abs(gap) < 0.1 and where != "side":
                continue
            sphere_place = (out, 0.0, 1.5 + (gap if where != "side" else -1.0))
            # A ball of 0.5 about a point: the cylinder's signed distance there, less 0.5.
            truth = less(parallel_cylinders(sphere_place, 1.0, 1.0), 0.5)
            yield CurvedPair(
                f"cylinder and sphere, {where}, {gap:g}",
                core.Cylinder(1.0, 1.0),
                core.Sphere(0.5),
                sphere_place,
                truth,
            )


def parallel_cylinders(place: Offset, radius: float, half: float) -> Truth:
    """Signed distance of a point from a cylinder about z: that of two, their sizes added up."""
    x, y, z = (Fraction(c) for c in place)
    low, high = root(x * x + y * y)
    low, high = low - Fraction(radius), high - Fraction(radius)
    above = abs(z) - Fraction(half)
    if low > 0 and above > 0:
        return of(root(low * low + above * above)[0], root(high * high + above * above)[1])
    return of(max(low, above), max(high, above))


def tips() -> Iterator[CurvedPair]:
    """Apexes and poles on the middle of a face, and on each other."""
    wide = box((4, 4, 1))
    for gap in GAPS:
        cone_z, egg_z = 1.5 + gap, 1.75 + gap
        for name, shape, z, pose in (
            ("apex", core.Cone(1.0, 0.5), cone_z, (0.0, 0.0, cone_z, *FLIPPED)),
            ("base of a cone", core.Cone(1.0, 0.5), cone_z, (0.0, 0.0, cone_z)),
            ("pole", core.Ellipsoid((1, 0.5, 0.75)), egg_z, (0.5, -0.25, egg_z)),
        ):
            half = Fraction(z) - (Fraction(1, 2) if z == cone_z else Fraction(3, 4)) - 1
            yield CurvedPair(
                f"{name} on a face, {gap:g}", core.Hull(wide), shape, pose, of(half, half)
            )
    for inner, outer in (((0.5, 0.75, 1.0), (1.0, 1.5, 2.0)), ((1.0, 2.0, 3.0), (1.0, 2.0, 3.0))):
        depth = Fraction(min(inner)) + Fraction(min(outer))
        yield CurvedPair(
            f"concentric ellipsoids, {inner} in {outer}",
            core.Ellipsoid(inner),
            core.Ellipsoid(outer),
            (0.0, 0.0, 0.0),
            of(-depth, -depth),
        )


# Curved bounds close in the limit: EPA stops at `kCurvedFacetGap`, 1e-9 of the scale, and what lies
# within twice that of 0 is called touching. The scale is at most 4 sizes here.
BAND = 8e-9


def judge_curved(pair: CurvedPair, score: Score) -> None:
    score.cases += 1
    truth = pair.truth
    for query in ("overlap", "depth", "distance"):
        result = core.check_pair(pair.a, pair.b, None, pair.pose_b, query=query)
        score.answers += 1
        what = f"{pair.name} ({query})"
        in_balance = abs(float(truth.low)) <= BAND * pair.size
        if result.outcome == "undecided":
            score.fail("undecided", what)
        elif result.outcome != truth.outcome and not (in_balance and result.outcome == "touching"):
            score.fail("wrong", f"{what}: {result.outcome}, in truth {truth.outcome}")
        if result.distance is None or result.lower is None or result.upper is None:
            continue
        if not (Fraction(result.lower) <= truth.low and truth.high <= Fraction(result.upper)):
            interval = f"{result.lower!r} <= {result.distance!r} <= {result.upper!r}"
            score.fail("outside", f"{what}: {interval}, in truth {float(truth.low)!r}")
        error = truth.error_of(result.distance)
        if error > 0:
            granted = max(result.upper - result.distance, result.distance - result.lower)
            score.error = max(score.error, error / pair.size)
            score.share = max(score.share, error / granted if granted > 0 else float("inf"))
