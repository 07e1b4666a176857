"""The answers of a report to its body rules, one by one: sums of contact forces, and the power of
motions, in rational numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from functools import partial
from operator import add
from typing import Any

import numpy as np

from satcheck.report.statics import (
    BodyContact,
    FirstMotion,
    Statics,
    SupportedBody,
    SupportFinding,
)
from satcheck.report.verification import CheckedSupport
from satcheck.scene.statics import QUESTIONS
from satcheck.verify.answers import body_terms, checked, once
from satcheck.verify.bodies import Placed
from satcheck.verify.exact import NotCertified, Point, Rejected, cross, dot, point, sub
from satcheck.verify.pairs import vector
from satcheck.verify.relations import check_apart
from satcheck.verify.statics.contacts import ROUNDING, Contacts, Place
from satcheck.verify.statics.weights import Weight, covers_once, weight_of

SAME_WEIGHT = 1e-9  # relative
FASTEST = 1e100  # of a motion, whose squares are floats
STEEP = np.sqrt(0.5)  # the cosine of 45 degrees: bodies beside such contacts may be squeezed

# Forces balance a weight up to this share of it, and torques up to this share of the weight times
# the size of the body: the rounding of the numbers in a report.
BALANCED = Fraction(1, 10**9)
# Forces are in their cones up to this share: the rounding of a force along a normal.
CONE = Fraction(1, 10**12)
# No forces below this many weights stop a motion.
LEAST_FACTOR = 10**5

Push = tuple[Point, Point]  # where a force acts, and the force
Motion = tuple[FirstMotion, Weight]


class Claims:
    """statics: of the report. bodies: of the report, by id. Raises Rejected if the section does not
    fit the bodies or its own rules."""

    def __init__(self, statics: Statics, bodies: Mapping[str, Placed]) -> None:
        self.statics, self.terms = statics, body_terms(statics.rules, bodies)
        regions = {id_ for id_, terms in self.terms.items() if terms.value("region")}
        self.bodies = {id_: body for id_, body in bodies.items() if id_ not in regions}
        self.contacts = Contacts(self.bodies, statics.tolerance)
        self.down = vector(statics.gravity)
        self.stated = {body.id: body for body in statics.bodies}
        self._balanced = once(self._check_island)
        self._falling = once(self._check_motion)
        self._afloat = once(self._check_afloat)
        self._check_section()

    def judged(self) -> Iterator[CheckedSupport]:
        """Each answer, in the order of the report."""
        for finding in self.statics.findings:
            check, is_doubted = partial(self._check, finding), partial(self._is_doubted, finding)
            own = self.terms[finding.body]
            yield checked(finding, finding.question, own, check, is_doubted)

    def _check_section(self) -> None:
        """Rejects questions, fixed bodies, weights and frictions that do not follow."""
        answered = sorted((f.body, f.question) for f in self.statics.findings)
        asked = [(id_, q) for id_, own in self.terms.items() for q in QUESTIONS if own.asks(q)]
        if sorted(asked) != answered:
            raise Rejected("the questions are not those that rules ask")
        usable = {id_ for id_, body in self.bodies.items() if body.claims}
        if set(self.stated) != usable or len(self.stated) < len(self.statics.bodies):
            raise Rejected("the bodies of the support are not those of the report")
        if abs(float(sum(c * c for c in self.down)) - 1.0) > 1e-12:
            raise Rejected("gravity is a unit vector")
        for body in self.statics.bodies:
            self._check_body(body)
        for contact in self.statics.contacts:
            if contact.a not in self.stated or contact.b not in self.stated:
                raise Rejected("a contact of a body that the report does not have")
            if contact.friction != self._friction(contact.a, contact.b):
                raise Rejected("the friction of a contact is not that of the rules")

    def _friction(self, a: str, b: str) -> float:
        """Of a contact: the smaller one of both bodies."""
        own = (self.terms[name].value("friction") for name in (a, b))
        return min([value for value in own if value is not None], default=self.statics.friction)

    def _weight(self, id_: str) -> Weight:
        """Rejects a body without a known volume."""
        terms = self.terms[id_]
        return weight_of(self.bodies[id_], terms.value("mass"), terms.value("density"))

    def _check_body(self, body: SupportedBody) -> None:
        mounted = "mounted" if self.terms[body.id].value("mounted") else None
        if body.fixed != ("static" if self.bodies[body.id].static else mounted):
            raise Rejected(f"{body.id}: whether it is fixed does not follow from the rules")
        if (body.mass is None) is not (body.centre is None):
            raise Rejected(f"{body.id}: a mass has a centre")
        if body.mass is None or body.centre is None:
            return
        weight, size = self._weight(body.id), self.contacts.size(body.id)
        if abs(float(weight.mass) - body.mass) > SAME_WEIGHT * body.mass:
            raise Rejected(f"{body.id}: its mass is {float(weight.mass):.9g}")
        off = max(abs(float(c) - s) for c, s in zip(weight.centre, body.centre, strict=True))
        if off > SAME_WEIGHT * size + 4 * ROUNDING * self.contacts.largest(body.id):
            raise Rejected(f"{body.id}: its centre of mass is elsewhere")

    def _check(self, finding: SupportFinding) -> None:
        body = self.stated.get(finding.body)
        if finding.answer == "open":
            return
        if body is None:
            raise Rejected("nothing is known about this body")
        if finding.answer == "yes":
            if body.fixed is None:
                self._balanced(self._island(body), finding.question == "stable")
        elif body.floating == "yes":
            self._afloat()
        else:
            self._check_moves(body)

    def _is_doubted(self, finding: SupportFinding) -> bool:
        """Whether a yes comes with a warning. Rejects one that hides its doubt."""
        if finding.answer != "yes":
            return False
        if finding.severity == "warning" and finding.reason:
            return True
        body = self.stated.get(finding.body)
        if body is None or body.fixed is not None:
            return False
        island = self.statics.islands[self._island(body)]
        beside_walls = island.squeezed is None and any(
            abs(np.array(point.normal) @ np.array(self.statics.gravity)) < STEEP
            for contact in self._contacts_of(set(island.bodies))
            for point in contact.points
        )
        if island.doubtful or beside_walls:
            raise Rejected("a body that may fall although forces hold it has a warning")
        return False

    def _contacts_of(self, members: set[str]) -> list[BodyContact]:
        return [each for each in self.statics.contacts if members & {each.a, each.b}]

    def _check_island(self, number: int, strict: bool) -> None:
        """That forces hold all bodies of an island."""
        members = set(self.statics.islands[number].bodies)
        pushes: dict[str, list[Push]] = {name: [] for name in members}
        for contact in self._contacts_of(members):
            for at in contact.points:
                if at.force is None:
                    continue
                place = self.contacts.at(contact, at)
                if strict and not self.contacts.is_strict(contact.a, contact.b, place):
                    raise Rejected(f"{contact.a} and {contact.b}: a force needs the tolerance")
                friction = Fraction(self._friction(contact.a, contact.b))
                _check_in_cone(vector(at.force), vector(place.normal.tolist()), friction)
                for name, sign in ((contact.a, 1), (contact.b, -1)):
                    if name in members:
                        force = point(sign * c for c in vector(at.force))
                        pushes[name].append((vector(at.at), force))
                    elif self.stated[name].fixed is None:
                        raise Rejected(f"{name} holds a body, and is not in its island")
        for name, own in pushes.items():
            if not covers_once(self.bodies[name]):
                raise NotCertified(f"{name}: its parts may overlap, so its mass is not certified")
            size = Fraction(self.contacts.size(name))
            _check_balance(name, self._weight(name), self.down, size, own)
            for other in self.contacts.near(name):
                if self.bodies[other].bounds is not None:
                    self.contacts.check_shallow(name, other)

    def _check_moves(self, body: SupportedBody) -> None:
        """By a motion of all that moves in contact with it: no forces hold these bodies."""
        if body.motion is None:
            raise NotCertified(f"{body.id}: no motion shows that it falls")
        if not _is_moving(body):
            raise Rejected(f"{body.id} is at rest in the motion that shows its fall")
        self._falling(self._moving_with(body.id))

    def _moving_with(self, name: str) -> frozenset[str]:
        """The bodies that move and are connected with this one by contacts of each other."""
        together, pending = {name}, [name]
        while pending:
            body = pending.pop()
            for other in set(self.contacts.near(body)) - together:
                stated = self.stated.get(other)
                if stated and _is_moving(stated) and self.contacts.between(body, other):
                    together.add(other)
                    pending.append(other)
        return frozenset(together)

    def _check_motion(self, together: frozenset[str]) -> None:
        """That gravity does work along it, and that no contact resists."""
        motions = {
            name: (motion, self._weight(name))
            for name in sorted(together)
            if (motion := self.stated[name].motion) is not None
        }
        worst = 0.0
        for name, (motion, _) in motions.items():
            if max(map(abs, (*motion.velocity, *motion.angular))) > FASTEST:
                raise Rejected(f"{name}: a motion this fast cannot be checked")
            for other in self.contacts.near(name):
                if other in motions and other < name:
                    continue
                friction = self._friction(name, other)
                for place in self.contacts.between(name, other):
                    at = vector(place.at.tolist())
                    own, against = (_velocity_at(motions.get(n), at) for n in (name, other))
                    worst = max(worst, _resistance(place, friction, sub(own, against)))
                self.contacts.check_shallow(name, other)
        moving = motions.values()
        power = sum((w.mass * dot(vector(m.velocity), self.down) for m, w in moving), Fraction(0))
        if power <= 0:
            raise Rejected("gravity does no work along the motion")
        # Forces f >= 0 with f * worst < power cannot stop it.
        if Fraction(worst) * LEAST_FACTOR * sum(weight.mass for _, weight in moving) > power:
            raise Rejected("a contact resists the motion")

    def _check_afloat(self) -> None:
        """All bodies that float, together: none of them touches another one."""
        afloat = {body.id for body in self.statics.bodies if body.floating == "yes"}
        if any(self.stated[name].fixed is not None for name in afloat):
            raise Rejected("a fixed body floats")
        for name in afloat:
            for other in self.contacts.near(name):
                if other not in afloat:
                    check_apart(self.bodies[name], self.bodies[other], self.statics.tolerance)

    def _island(self, body: SupportedBody) -> int:
        number = body.island
        islands = self.statics.islands
        if number is None or number >= len(islands) or body.id not in islands[number].bodies:
            raise Rejected(f"{body.id}: its island does not list it")
        strangers = [n for n in islands[number].bodies if n not in self.stated]
        if strangers or any(self.stated[n].fixed is not None for n in islands[number].bodies):
            raise Rejected("an island has free bodies of the report only")
        return number


def _is_moving(body: SupportedBody) -> bool:
    return body.motion is not None and any((*body.motion.velocity, *body.motion.angular))


def _check_in_cone(force: Point, normal: Point, friction: Fraction) -> None:
    """Rejects a force that pulls, or that friction does not allow: |f|^2 |n|^2 <= (1 + mu^2)
    (f.n)^2."""
    along = dot(force, normal)
    if along < 0:
        raise Rejected("a contact force pulls")
    limit = (1 + friction * friction) * along * along * (1 + CONE)
    if dot(force, force) * dot(normal, normal) > limit:
        raise Rejected("a contact force is outside of its friction cone")


def _check_balance(
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


def _velocity_at(motion: Motion | None, at: Point) -> Point:
    """Of a point of a body that moves so; None: it is at rest."""
    if motion is None:
        return point((0, 0, 0))
    first, weight = motion
    turning = cross(vector(first.angular), sub(at, weight.centre))
    return point(map(add, vector(first.velocity), turning))


def _resistance(place: Place, friction: float, relative: Point) -> float:
    """How fast the motion presses the contact, or slides more than it opens: 0 if no force there
    does work against it. relative: the velocity of A against B. By J. J. Moreau, the dual of a
    friction cone holds the velocities u with u.n >= mu |u - (u.n) n|."""
    n = vector(place.normal.tolist())
    opening = Fraction(dot(relative, n))
    across = [r - opening * c for r, c in zip(relative, n, strict=True)]
    sliding = math.sqrt(dot(across, across))
    return max(friction * sliding - float(opening), 0.0)
