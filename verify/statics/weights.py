"""Mass and centre of mass of a body, in rational numbers.

A tetrahedron between the origin and each triangle: the sum of the signed volumes, and of their
centres, is that of the solid (C. Zhang, T. Chen, "Efficient feature extraction for 2D/3D objects in
mesh representation", 2001).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from satcheck.core.shapes import Sphere
from satcheck.verify.bodies import Placed
from satcheck.verify.exact import Point, Rejected, cross, dot, integers
from satcheck.verify.world import World

MOST_PARTS = 500  # of a mesh, whose boxes are compared in pairs


@dataclass(frozen=True, slots=True)
class Weight:
    """mass: also the weight, as gravity is 1. centre: in the world."""

    mass: Fraction
    centre: Point


def weight_of(body: Placed, mass: float | None, density: float | None) -> Weight:
    """mass, density: as rules state them; the density is 1 by default. Rejects a body without a
    known volume."""
    if body.curved is not None:
        volume, centre = _of_ball(body)
    elif body.world is not None and body.world.solid and not body.holed:
        volume, centre = _of_mesh(body.world)
    else:
        raise Rejected(f"{body.id}: a surface that is not closed has no mass")
    if mass is not None:
        return Weight(Fraction(mass), centre)
    return Weight(volume * Fraction(1.0 if density is None else density), centre)


def covers_once(body: Placed) -> bool:
    """Whether no two parts of a mesh share space, as far as their boxes tell."""
    if body.world is None:
        return True
    world = body.world
    labels = world.labels(world.triangles)[world.triangles[:, 0]]
    parts = [labels == label for label in np.unique(labels)]
    if len(parts) > MOST_PARTS:
        return False
    boxes = [(world.low[p].min(axis=0), world.high[p].max(axis=0)) for p in parts]
    return not any(
        ((low < high_2) & (low_2 < high)).all()
        for (low, high), (low_2, high_2) in itertools.combinations(boxes, 2)
    )


def _of_mesh(world: World) -> tuple[Fraction, Point]:
    k = world.lattice
    points = integers(world.vertices, k)
    six, moments = 0, [0, 0, 0]
    for i, j, m in world.triangles.tolist():
        a, b, c = points[i], points[j], points[m]
        part = dot(a, cross(b, c))
        six += part
        for axis in range(3):
            moments[axis] += part * (a[axis] + b[axis] + c[axis])
    if six <= 0:
        raise Rejected("a body without a volume has no mass")
    scale = 1 << k
    x, y, z = (Fraction(moment, 4 * six * scale) for moment in moments)
    return Fraction(six, 6 * scale**3), (x, y, z)


def _of_ball(body: Placed) -> tuple[Fraction, Point]:
    """The volume up to the rounding of pi: forces are compared with it up to more than that."""
    centre, radius = ball(body)
    x, y, z = map(Fraction, centre)
    return Fraction(4, 3) * Fraction(math.pi) * Fraction(radius) ** 3, (x, y, z)


def ball(body: Placed) -> tuple[tuple[float, float, float], float]:
    """(centre, radius). Rejects other curved shapes, and balls that are scaled unevenly."""
    image = None if body.curved is None else body.curved.image
    if image is None or not isinstance(image.primitive, Sphere):
        raise Rejected(f"{body.id}: the contacts of such a shape are not certified")
    stretch = [math.hypot(*column) for column in image.columns]
    if max(stretch) - min(stretch) > 1e-12 * max(stretch):
        raise Rejected(f"{body.id}: the contacts of such a shape are not certified")
    return image.origin, image.primitive.radius * stretch[0]
