"""Sums of contact forces, and the power of a motion, in rational numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from satcheck.report.statics import FirstMotion
from satcheck.verify.exact import Point, Rejected, cross, dot, point, sub
from satcheck.verify.pairs import vector
from satcheck.verify.statics.places import Place
from satcheck.verify.statics.weights import Weight

# Forces balance a weight up to this share of it, and torques up to this share of the weight times
# the size of the body: the rounding of the numbers in a report.
BALANCED = Fraction(1, 10**9)
# Forces are in their cones up to this share: the rounding of a force along a normal.
CONE = Fraction(1, 10**12)
# No forces below this many weights stop a motion.
LEAST_FACTOR = 10**5


@dataclass(frozen=True, slots=True)
class Push:
    """A force at a point of the world."""

    at: Point
    force: Point


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
    for push in pushes:
        turning = cross(sub(push.at, weight.centre), push.force)
        for k in range(3):
            force[k] += push.force[k]
            torque[k] += turning[k]
    limit = BALANCED * weight.mass
    if max(map(abs, force)) > limit or max(map(abs, torque)) > limit * size:
        raise Rejected(f"the contact forces on {name} do not add up to its weight")


def velocity_at(motion: FirstMotion | None, centre: Point | None, at: Point) -> Point:
    """Of a point of a body that moves so; None: it is at rest."""
    if motion is None or centre is None:
        return Fraction(0), Fraction(0), Fraction(0)
    turning = cross(vector(motion.angular), sub(at, centre))
    return point(p + q for p, q in zip(vector(motion.velocity), turning, strict=True))


def resistance(place: Place, friction: float, relative: Point) -> float:
    """How fast the motion presses the contact, or slides more than it opens: 0 if no force there
    does work against it. relative: the velocity of A against B. By J. J. Moreau, the dual of a
    friction cone holds the velocities u with u.n >= mu |u - (u.n) n|."""
    n = vector(place.normal.tolist())
    opening = Fraction(dot(relative, n))
    across = [r - opening * c for r, c in zip(relative, n, strict=True)]
    sliding = math.sqrt(dot(across, across))
    return max(friction * sliding - float(opening), 0.0)


def check_power(
    motions: Mapping[str, FirstMotion],
    weights: Mapping[str, Weight],
    down: Point,
    worst: float,
) -> None:
    """Rejects a motion along which gravity does no work, or which contacts resist: by `worst`, the
    largest resistance. Forces f >= 0 with f * worst < power cannot stop it."""
    power = Fraction(0)
    total = Fraction(0)
    for name, motion in motions.items():
        power += weights[name].mass * dot(vector(motion.velocity), down)
        total += weights[name].mass
    if power <= 0:
        raise Rejected("gravity does no work along the motion")
    if Fraction(worst) * LEAST_FACTOR * total > power:
        raise Rejected("a contact resists the motion")
