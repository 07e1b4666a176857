"""The answers of a report to its body rules, one by one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from satcheck.report.statics import (
    BodyContact,
    ContactPoint,
    FirstMotion,
    Statics,
    SupportedBody,
    SupportFinding,
)
from satcheck.report.verification import CheckedSupport, Outcome
from satcheck.verify.bodies import Placed
from satcheck.verify.evidence import vector
from satcheck.verify.exact import Floats, Point, Rejected
from satcheck.verify.rules import selected_by
from satcheck.verify.statics.gaps import check_apart
from satcheck.verify.statics.places import (
    Place,
    Surface,
    place_of_balls,
    places_of,
    places_of_ball,
)
from satcheck.verify.statics.sums import (
    Push,
    check_balance,
    check_in_cone,
    check_power,
    resistance,
    velocity_at,
)
from satcheck.verify.statics.weights import Weight, ball, covers_once, weight_of

QUESTIONS = ("supported", "stable")
KEYS = (*QUESTIONS, "mounted", "density", "mass", "friction", "severity")
# How far two computations of one contact may be off: of the largest coordinate, and of a normal.
SAME_PLACE, SAME_NORMAL = 1e-9, 1e-6
# Of the rounding of coordinates, as in the search for contacts, and as much to spare.
ROUNDING, SHARE = 2.0**-46, 0.02
SAME_WEIGHT = 1e-9  # relative
FASTEST = 1e100  # of a motion, whose squares are floats


class _NotCertified(Exception):
    """The claim may be true, but it cannot be proven here."""


class Claims:
    """statics: of the report. bodies: of the report, by id. Raises Rejected if the section does not
    fit the bodies or its own rules."""

    def __init__(self, statics: Statics, bodies: Mapping[str, Placed]) -> None:
        self.statics, self.bodies = statics, bodies
        self.terms = _terms(statics, bodies)
        self.down = vector(statics.gravity)
        self.usable = {id_: body for id_, body in bodies.items() if body.claims}
        self.stated = {body.id: body for body in statics.bodies}
        self._places: dict[tuple[str, str], list[Place]] = {}
        self._balanced: dict[tuple[int, bool], str | None] = {}
        self._moving: dict[int, str | None] = {}
        self._worst: dict[int, float] = {}
        self._afloat: str | bool | None = False
        self._check_section()

    def judged(self) -> Iterator[CheckedSupport]:
        """Each answer, in the order of the report."""
        for finding in self.statics.findings:
            outcome, reason = self._outcome(finding)
            yield CheckedSupport(finding.body, finding.question, finding.answer, outcome, reason)

    def _outcome(self, finding: SupportFinding) -> tuple[Outcome, str | None]:
        try:
            self._check(finding)
        except _NotCertified as why:
            return "not certified", str(why)
        except Rejected as why:
            return "rejected", str(why)
        return ("open", finding.reason) if finding.answer == "open" else ("accepted", None)

    def _check_section(self) -> None:
        """Rejects questions, fixed bodies, weights and frictions that do not follow."""
        asked = [
            (id_, question)
            for id_ in self.bodies
            for question in QUESTIONS
            if self.terms[id_].get(question)
        ]
        if sorted(asked) != sorted((f.body, f.question) for f in self.statics.findings):
            raise Rejected("the questions are not those that rules ask")
        if set(self.stated) != set(self.usable) or len(self.stated) < len(self.statics.bodies):
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

    def _check_body(self, body: SupportedBody) -> None:
        static = self.bodies[body.id].static
        mounted = bool(self.terms[body.id].get("mounted"))
        if body.fixed != ("static" if static else "mounted" if mounted else None):
            raise Rejected(f"{body.id}: whether it is fixed does not follow from the rules")
        if (body.mass is None) is not (body.centre is None):
            raise Rejected(f"{body.id}: a mass has a centre")
        if body.mass is None or body.centre is None:
            return
        weight, size = self.weight(body.id), self._size(body.id)
        if abs(float(weight.mass) - body.mass) > SAME_WEIGHT * body.mass:
            raise Rejected(f"{body.id}: its mass is {float(weight.mass):.9g}")
        off = max(abs(float(c) - s) for c, s in zip(weight.centre, body.centre, strict=True))
        if off > SAME_WEIGHT * size + 4 * ROUNDING * self._largest(body.id):
            raise Rejected(f"{body.id}: its centre of mass is elsewhere")

    def _check(self, finding: SupportFinding) -> None:
        terms = self.terms[finding.body]
        if finding.rule != terms["names"][finding.question]:
            raise Rejected("another rule asks this")
        doubted = finding.answer == "yes" and finding.reason and finding.severity == "warning"
        if not doubted and finding.severity != _severity(finding.answer, terms.get("severity")):
            raise Rejected("the severity does not follow from the answer and the rules")
        if finding.answer == "open":
            return
        body = self.stated.get(finding.body)
        if body is None:
            raise Rejected("nothing is known about this body")
        if finding.answer == "yes":
            if body.fixed is None:
                self._check_held(body, strict=finding.question == "stable")
        elif body.floating == "yes":
            self._check_afloat()
        else:
            self._check_moves(body)

    def _check_held(self, body: SupportedBody, *, strict: bool) -> None:
        """By forces on all bodies of its island."""
        number = self._island(body)
        key = number, strict
        if key not in self._balanced:
            try:
                self._check_island(number, strict)
                self._balanced[key] = None
            except Rejected as why:
                self._balanced[key] = str(why)
        if self._balanced[key] is not None:
            raise Rejected(str(self._balanced[key]))

    def _check_island(self, number: int, strict: bool) -> None:
        members = set(self.statics.islands[number].bodies)
        pushes: dict[str, list[Push]] = {name: [] for name in members}
        for contact in self.statics.contacts:
            if not members & {contact.a, contact.b}:
                continue
            for point in contact.points:
                if point.force is None:
                    continue
                self._check_force(contact, point, strict)
                for name, sign in ((contact.a, 1), (contact.b, -1)):
                    if name in members:
                        x, y, z = (sign * c for c in vector(point.force))
                        pushes[name].append(Push(vector(point.at), (x, y, z)))
                    elif self.stated[name].fixed is None:
                        raise Rejected(f"{name} holds a body, and is not in its island")
        for name, own in pushes.items():
            if not covers_once(self.bodies[name]):
                raise _NotCertified(f"{name}: its parts may overlap, so its mass is not certified")
            size = Fraction(self._size(name))
            check_balance(name, self.weight(name), self.down, size, own)

    def _check_force(self, contact: BodyContact, point: ContactPoint, strict: bool) -> None:
        place = self._place(contact, point)
        if strict and not self._is_strict(contact, place):
            raise Rejected(f"{contact.a} and {contact.b}: a force needs the tolerance")
        friction = Fraction(self._friction(contact.a, contact.b))
        check_in_cone(vector(point.force or ()), vector(place.normal.tolist()), friction)

    def _place(self, contact: BodyContact, point: ContactPoint) -> Place:
        """The contact of the bodies at this point and along this normal."""
        far = SAME_PLACE * max(self._largest(contact.a), self._largest(contact.b))
        at, normal = np.array(point.at), np.array(point.normal)
        same = [
            place
            for place in self.places(contact.a, contact.b)
            if np.abs(place.at - at).max() <= far
            and np.abs(place.normal - normal).max() <= SAME_NORMAL
        ]
        if not same:
            raise Rejected(f"{contact.a} and {contact.b} have no contact where a force acts")
        return min(same, key=lambda place: (not place.exact, np.abs(place.normal - normal).max()))

    def _is_strict(self, contact: BodyContact, place: Place) -> bool:
        rounding = self._rounding(contact.a, contact.b)
        exact = [p.height for p in self.places(contact.a, contact.b) if p.exact]
        return place.exact and place.height <= min(exact) + 4 * rounding

    def _check_moves(self, body: SupportedBody) -> None:
        """By the motion of its island."""
        if body.motion is None:
            raise _NotCertified(f"{body.id}: no motion shows that it falls")
        if not any((*body.motion.velocity, *body.motion.angular)):
            raise Rejected(f"{body.id} is at rest in the motion that shows its fall")
        number = self._island(body)
        for name in self.statics.islands[number].bodies:
            moves = self.stated[name].motion
            if moves and max(map(abs, (*moves.velocity, *moves.angular))) > FASTEST:
                raise Rejected(f"{name}: a motion this fast cannot be checked")
        if number not in self._moving:
            try:
                self._worst[number] = self._check_motion(number)
                self._moving[number] = None
            except Rejected as why:
                self._moving[number] = str(why)
        if self._moving[number] is not None:
            raise Rejected(str(self._moving[number]))
        self._check_falls(body.id, body.motion, self._worst[number])

    def _check_falls(self, name: str, motion: FirstMotion, worst: float) -> None:
        """That the motion is the fall of this body too: others of its island may pay for it."""
        try:
            check_power({name: motion}, {name: self.weight(name)}, self.down, worst)
        except Rejected as why:
            raise _NotCertified(f"{name}, by itself: {why}") from None

    def _check_motion(self, number: int) -> float:
        """The largest resistance of a contact."""
        motions = {
            name: motion
            for name in self.statics.islands[number].bodies
            if (motion := self.stated[name].motion) is not None
        }
        weights = {name: self.weight(name) for name in motions}
        worst = 0.0
        for name in motions:
            for other in self.bodies:
                if other != name and not (other in motions and other < name):
                    worst = max(worst, self._resistance(name, other, motions, weights))
        check_power(motions, weights, self.down, worst)
        return worst

    def _resistance(
        self,
        name: str,
        other: str,
        motions: Mapping[str, FirstMotion],
        weights: Mapping[str, Weight],
    ) -> float:
        friction = self._friction(name, other)
        worst = 0.0
        for place in self.places(name, other):
            at = vector(place.at.tolist())
            own = velocity_at(motions.get(name), self._centre(name, weights), at)
            against = velocity_at(motions.get(other), self._centre(other, weights), at)
            x, y, z = (p - q for p, q in zip(own, against, strict=True))
            worst = max(worst, resistance(place, friction, (x, y, z)))
        return worst

    def _centre(self, name: str, weights: Mapping[str, Weight]) -> Point | None:
        weight = weights.get(name)
        return None if weight is None else weight.centre

    def _check_afloat(self) -> None:
        """All bodies that float, together: none of them touches another one."""
        if self._afloat is False:
            afloat = {body.id for body in self.statics.bodies if body.floating == "yes"}
            try:
                if any(self.stated[name].fixed is not None for name in afloat):
                    raise Rejected("a fixed body floats")
                for name in afloat:
                    for other in self.bodies.keys() - afloat:
                        check_apart(self.bodies[name], self.bodies[other], self.statics.tolerance)
                self._afloat = None
            except Rejected as why:
                self._afloat = str(why)
        if self._afloat is not None:
            raise Rejected(str(self._afloat))

    def places(self, a: str, b: str) -> list[Place]:
        """Contacts of A and B, normals from B to A."""
        if (a, b) not in self._places:
            if (b, a) in self._places:
                turned = self._places[b, a]
                self._places[a, b] = [Place(p.at, -p.normal, p.height, p.exact) for p in turned]
            else:
                try:
                    self._places[a, b] = self._found(a, b)
                except Rejected as why:
                    raise _NotCertified(f"the contacts of {a} and {b}: {why}") from None
        return self._places[a, b]

    def _found(self, a: str, b: str) -> list[Place]:
        one, other = self.bodies[a], self.bodies[b]
        if one.bounds is None or other.bounds is None:
            raise Rejected("a body that cannot be read may hold others")
        tolerance, rounding = self.statics.tolerance, self._rounding(a, b)
        gap = np.maximum(one.bounds[0] - other.bounds[1], other.bounds[0] - one.bounds[1])
        if float(gap.max()) > tolerance * (1 + 1e-6):
            return []
        of_a, of_b = self._surfaces.get(a), self._surfaces.get(b)
        if of_a is not None and of_b is not None:
            return places_of(of_a, of_b, tolerance, rounding)
        if of_b is not None:
            centre, radius = ball(one)
            return places_of_ball(np.array(centre), radius, of_b, tolerance, rounding)
        if of_a is not None:
            centre, radius = ball(other)
            found = places_of_ball(np.array(centre), radius, of_a, tolerance, rounding)
            return [Place(p.at, -p.normal, p.height, p.exact) for p in found]
        (p, r), (q, s) = ball(one), ball(other)
        return place_of_balls(np.array(p), r, np.array(q), s, tolerance)

    @cached_property
    def _surfaces(self) -> dict[str, Surface]:
        return {
            id_: Surface(body.world) for id_, body in self.bodies.items() if body.world is not None
        }

    def weight(self, name: str) -> Weight:
        terms = self.terms[name]
        return weight_of(self.bodies[name], terms.get("mass"), terms.get("density"))

    def _island(self, body: SupportedBody) -> int:
        number = body.island
        islands = self.statics.islands
        if number is None or number >= len(islands) or body.id not in islands[number].bodies:
            raise Rejected(f"{body.id}: its island does not list it")
        strangers = [n for n in islands[number].bodies if n not in self.stated]
        if strangers or any(self.stated[n].fixed is not None for n in islands[number].bodies):
            raise Rejected("an island has free bodies of the report only")
        return number

    def _friction(self, a: str, b: str) -> float:
        own = [self.terms[name].get("friction") for name in (a, b)]
        return min([value for value in own if value is not None], default=self.statics.friction)

    def _largest(self, name: str) -> float:
        low, high = self._bounds(name)
        return float(max(np.abs(low).max(), np.abs(high).max()))

    def _size(self, name: str) -> float:
        low, high = self._bounds(name)
        return float(np.linalg.norm(high - low))

    def _bounds(self, name: str) -> tuple[Floats, Floats]:
        bounds = self.bodies[name].bounds
        if bounds is None:
            raise Rejected(f"{name} cannot be read")
        return bounds

    def _rounding(self, a: str, b: str) -> float:
        written = self.bodies[a].resolution + self.bodies[b].resolution
        largest = max(self._largest(a), self._largest(b))
        return min(2 * written, SHARE * self.statics.tolerance) + ROUNDING * largest


def _terms(statics: Statics, bodies: Mapping[str, Placed]) -> dict[str, dict[str, Any]]:
    """id -> key -> the value of the last rule that sets it; `names`: key -> that rule."""
    terms: dict[str, dict[str, Any]] = {id_: {"names": {}} for id_ in bodies}
    select = selected_by(bodies)
    for rule in statics.rules:
        values = {key: getattr(rule, key) for key in KEYS}
        said = {key: value for key, value in values.items() if value is not None}
        for id_ in select(rule.bodies):
            terms[id_] |= said
            terms[id_]["names"] |= dict.fromkeys(said, rule.where or rule.bodies)
    return terms


def _severity(answer: str, own: str | None) -> str:
    if answer == "yes":
        return "none"
    if answer == "open":
        return "error" if own == "error" else "warning"
    return "silenced" if own == "none" else own or "error"
