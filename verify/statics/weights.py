"""Masses and their centres, in rational numbers.

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

from satcheck.core.shapes import (
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Primitive,
    Sphere,
    sizes_of,
)
from satcheck.verify.bodies import Placed
from satcheck.verify.exact import Point, Rejected, cross, dot, point
from satcheck.verify.surfaces import meeting
from satcheck.verify.world import Exact, World, connected

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
        # Up to the rounding of pi: forces are compared with it up to more than that.
        unplaced, above = _unplaced(body.curved.image.primitive)
        ends = zip(body.curved.image.origin, body.curved.image.columns[2], strict=True)
        volume = abs(body.curved.determinant) * unplaced
        centre = point(Fraction(o) + above * Fraction(axis) for o, axis in ends)
    elif body.world is not None and body.world.solid and not body.holed:
        volume, centre = _of_mesh(body.world)
    else:
        raise Rejected(f"{body.id}: a surface that is not closed has no mass")
    if mass is not None:
        return Weight(Fraction(mass), centre)
    return Weight(volume * Fraction(1.0 if density is None else density), centre)


def covers_once(body: Placed) -> bool:
    """Whether no two parts of a mesh share space, and parts within others bound voids."""
    if body.world is None:
        return True
    world = body.world
    labels = connected(world.triangles, len(world.vertices))[world.triangles[:, 0]]
    parts = [world.triangles[labels == label] for label in np.unique(labels)]
    if not 1 < len(parts) <= MOST_PARTS:
        return len(parts) == 1
    shells = [Exact(World(world.vertices, part, solid=True), world.lattice) for part in parts]
    beside: list[list[Exact]] = [[] for _ in shells]
    for (i, one), (j, other) in itertools.combinations(enumerate(shells), 2):
        (low, high), (low_b, high_b) = one.world.bounds, other.world.bounds
        if ((low < high_b) & (low_b < high)).all():
            if meeting(one, other):
                return False
            beside[i].append(other)
            beside[j].append(one)
    return all(_bounds_once(shell, others) for shell, others in zip(shells, beside, strict=True))


def _bounds_once(shell: Exact, others: list[Exact]) -> bool:
    """Whether the others, which the shell does not meet, leave the winding numbers on both sides of
    it 0 and 1."""
    corner = point(shell.points[shell.world.triangles[0, 0]])
    outside = sum(other.winding(corner) or 0 for other in others)
    return {outside, outside + (1 if shell.six_volumes > 0 else -1)} == {0, 1}


def _of_mesh(world: World) -> tuple[Fraction, Point]:
    solid = Exact(world, world.lattice)
    six, scale = solid.six_volumes, solid.scale
    if six <= 0:
        raise Rejected("a body without a volume has no mass")
    moments = [0, 0, 0]
    for a, b, c in map(solid.corners, range(len(world.triangles))):
        part = dot(a, cross(b, c))
        for axis in range(3):
            moments[axis] += part * (a[axis] + b[axis] + c[axis])
    return Fraction(six, 6 * scale**3), point(Fraction(m, 4 * six * scale) for m in moments)


def _unplaced(shape: Primitive) -> tuple[Fraction, Fraction]:
    """The volume of a curved shape, and the height of its centre of mass along its axis."""
    ball = Fraction(4, 3) * Fraction(math.pi)
    circle, sizes = Fraction(math.pi), tuple(map(Fraction, sizes_of(shape)))
    match shape:
        case Sphere():
            return ball * sizes[0] ** 3, Fraction(0)
        case Ellipsoid():
            return ball * sizes[0] * sizes[1] * sizes[2], Fraction(0)
        case Capsule():
            radius, length = sizes
            return ball * radius**3 + circle * radius**2 * length, Fraction(0)
        case Cylinder():
            radius, height = sizes
            return circle * radius**2 * height, Fraction(0)
        case Cone():
            radius, height = sizes
            return circle * radius**2 * height / 3, -height / 4
        case _:
            raise Rejected("a box is no curved shape")
