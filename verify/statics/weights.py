"""Masses, sums of contact forces, and the power of a motion, in rational numbers.

A tetrahedron between the origin and each triangle: the sum of the signed volumes, and of their
centres, is that of the solid (C. Zhang, T. Chen, "Efficient feature extraction for 2D/3D objects in
mesh representation", 2001).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

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
from satcheck.report.statics import FirstMotion
from satcheck.verify.bodies import Placed
from satcheck.verify.curved import Curved
from satcheck.verify.exact import (
    NotCertified,
    Point,
    Rejected,
    cross,
    dot,
    integers,
    point,
    sub,
)
from satcheck.verify.pairs import vector
from satcheck.verify.statics.places import Place
from satcheck.verify.surfaces import meeting
from satcheck.verify.world import Exact, World, connected

MOST_PARTS = 500  # of a mesh, whose boxes are compared in pairs
# Forces balance a weight up to this share of it, and torques up to this share of the weight times
# the size of the body: the rounding of the numbers in a report.
BALANCED = Fraction(1, 10**9)
# Forces are in their cones up to this share: the rounding of a force along a normal.
CONE = Fraction(1, 10**12)
# No forces below this many weights stop a motion.
LEAST_FACTOR = 10**5


@dataclass(frozen=True, slots=True)
class Weight:
    """mass: also the weight, as gravity is 1. centre: in the world."""

    mass: Fraction
    centre: Point


Push = tuple[Point, Point]  # where a force acts, and the force
Motion = tuple[FirstMotion, Weight]


def weight_of(body: Placed, mass: float | None, density: float | None) -> Weight:
    """mass, density: as rules state them; the density is 1 by default. Rejects a body without a
    known volume."""
    if body.curved is not None:
        volume, centre = _of_shape(body.curved)
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
    six = sum(dot(a, cross(b, c)) for a, b, c in map(shell.corners, range(len(shell.world.low))))
    return {outside, outside + (1 if six > 0 else -1)} == {0, 1}


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
    return Fraction(six, 6 * scale**3), point(Fraction(m, 4 * six * scale) for m in moments)


def _of_shape(shape: Curved) -> tuple[Fraction, Point]:
    """The volume up to the rounding of pi: forces are compared with it up to more than that."""
    volume, above = _unplaced(shape.image.primitive)
    ends = zip(shape.image.origin, shape.image.columns[2], strict=True)
    centre = point(Fraction(o) + above * Fraction(axis) for o, axis in ends)
    return abs(shape.determinant) * volume, centre


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


def ball(body: Placed) -> tuple[tuple[float, float, float], float]:
    """(centre, radius). Raises NotCertified for other curved shapes, and for balls that are scaled
    unevenly."""
    image = None if body.curved is None else body.curved.image
    if image is None or not isinstance(image.primitive, Sphere):
        raise NotCertified(f"{body.id}: the contacts of such a shape are not certified")
    stretch = [math.hypot(*column) for column in image.columns]
    if max(stretch) - min(stretch) > 1e-12 * max(stretch):
        raise NotCertified(f"{body.id}: the contacts of such a shape are not certified")
    return image.origin, image.primitive.radius * stretch[0]


def check_in_cone(force: Point, normal: Point, friction: Fraction) -> None:
    """Rejects a force that pulls, or that friction does not allow: |f|^2 |n|^2 <= (1 + mu^2)
    (f.n)^2."""
    along = dot(force, normal)
    if along < 0:
        raise Rejected("a contact force pulls")
    limit = (1 + friction * friction) * along * along * (1 + CONE)
    if dot(force, force) * dot(normal, normal) > limit:
        raise Rejected("a contact force is outside of its friction cone")


def check_balance(
    name: str, weight: Weight, down: Point, size: Fraction, pushes: Iterable[Push]
) -> None:
    """Rejects forces that do not balance gravity on a body. down: unit, up to rounding. size: of
    the body, for torques."""
    force: list[Any] = [weight.mass * c for c in down]
    torque: list[Any] = [Fraction(0)] * 3
    for at, push in pushes:
        turning = cross(sub(at, weight.centre), push)
        for k in range(3):
            force[k] += push[k]
            torque[k] += turning[k]
    limit = BALANCED * weight.mass
    if max(map(abs, force)) > limit or max(map(abs, torque)) > limit * size:
        raise Rejected(f"the contact forces on {name} do not add up to its weight")


def velocity_at(motion: Motion | None, at: Point) -> Point:
    """Of a point of a body that moves so; None: it is at rest."""
    if motion is None:
        return Fraction(0), Fraction(0), Fraction(0)
    first, weight = motion
    turning = cross(vector(first.angular), sub(at, weight.centre))
    return point(p + q for p, q in zip(vector(first.velocity), turning, strict=True))


def resistance(place: Place, friction: float, relative: Point) -> float:
    """How fast the motion presses the contact, or slides more than it opens: 0 if no force there
    does work against it. relative: the velocity of A against B. By J. J. Moreau, the dual of a
    friction cone holds the velocities u with u.n >= mu |u - (u.n) n|."""
    n = vector(place.normal.tolist())
    opening = Fraction(dot(relative, n))
    across = [r - opening * c for r, c in zip(relative, n, strict=True)]
    sliding = math.sqrt(dot(across, across))
    return max(friction * sliding - float(opening), 0.0)


def check_power(motions: Collection[Motion], down: Point, worst: float) -> None:
    """Rejects a motion along which gravity does no work, or which contacts resist: by `worst`, the
    largest resistance. Forces f >= 0 with f * worst < power cannot stop it."""
    works = (weight.mass * dot(vector(first.velocity), down) for first, weight in motions)
    power = sum(works, Fraction(0))
    if power <= 0:
        raise Rejected("gravity does no work along the motion")
    total = sum((weight.mass for _, weight in motions), Fraction(0))
    if Fraction(worst) * LEAST_FACTOR * total > power:
        raise Rejected("a contact resists the motion")
