"""The contacts of the bodies of a report, found again, and how deep two bodies may overlap."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import cache, cached_property

import numpy as np

from satcheck.report.certificate import SurfacesProof
from satcheck.report.statics import BodyContact, ContactPoint
from satcheck.verify.bodies import Placed, box_gaps
from satcheck.verify.exact import Floats, NotCertified, Rejected, point, sub
from satcheck.verify.findings import prove_way_out
from satcheck.verify.pairs import any_pair_of, pair_of, vector
from satcheck.verify.patches import comes_within
from satcheck.verify.relations import prove
from satcheck.verify.statics.places import (
    SLACK,
    Place,
    Surface,
    place_of_balls,
    places_of,
    places_of_ball,
)
from satcheck.verify.statics.weights import ball
from satcheck.verify.world import Exact


def check_apart(a: Placed, b: Placed, tolerance: float) -> None:
    """Rejects bodies that are not farther apart than the tolerance. If one is a ball, the tolerance
    may be negative: then the bodies may overlap by less than that."""
    least = Fraction(tolerance)
    if max(box_gaps(a, b)) > least:
        return
    if a.world is not None and b.world is not None:
        pair = pair_of(a, b, a.world, b.world)
        prove("separated", SurfacesProof(), pair, least, Fraction(0))
        return
    round_, other = (b, a) if b.world is None else (a, b)
    centre, radius = ball(round_)
    if other.world is None:
        along = sub(point(centre), point(ball(other)[0]))
        is_apart = any_pair_of(other, round_).gap(along, least) > 0
    else:
        mesh = Exact(other.world, other.world.lattice)
        middle = mesh.at(centre)
        reach = max(Fraction(radius) + least, Fraction(0))
        is_apart = not comes_within(mesh, middle, reach, open_=False)
        if is_apart and mesh.world.solid and mesh.winding(middle) != 0:
            raise Rejected("a body that should be apart lies in another")
    if not is_apart:
        raise Rejected("bodies that should be apart are within the tolerance")


# How far two computations of one contact may be off: of the largest coordinate, and of a normal.
SAME_PLACE, SAME_NORMAL = 1e-9, 1e-6
# Of the rounding of coordinates, as in the search for contacts, and as much to spare.
ROUNDING, SHARE = 2.0**-46, 0.02
# Directions in which an overlap may be shallow. With more, none is looked for.
MOST_WAYS = 30


class Contacts:
    """bodies: of the report, by id. tolerance: of contacts."""

    def __init__(self, bodies: Mapping[str, Placed], tolerance: float) -> None:
        self._bodies, self._tolerance = bodies, tolerance
        self._places: dict[tuple[str, str], list[Place]] = {}
        self._shallow = cache(self._is_shallow)

    def near(self, name: str) -> list[str]:
        """Other bodies whose boxes are within the tolerance, or unknown."""
        bounds = self._bodies[name].bounds
        ids, low, high, known = self._boxes
        if bounds is None:
            return [id_ for id_ in ids if id_ != name]
        gap = np.maximum(low - bounds[1], bounds[0] - high).max(axis=1)
        near = (gap <= self._tolerance * (1 + SLACK)) | ~known
        return [ids[k] for k in np.flatnonzero(near).tolist() if ids[k] != name]

    @cached_property
    def _boxes(self) -> tuple[list[str], Floats, Floats, np.ndarray]:
        bounds = [body.bounds for body in self._bodies.values()]
        nowhere = np.zeros(3), np.zeros(3)
        low, high = (np.array([(b or nowhere)[k] for b in bounds]) for k in (0, 1))
        return list(self._bodies), low, high, np.array([b is not None for b in bounds])

    def between(self, a: str, b: str) -> list[Place]:
        """Contacts of A and B, normals from B to A. Raises NotCertified if they cannot be found."""
        if (b, a) in self._places:
            return [place.turned for place in self._places[b, a]]
        if (a, b) not in self._places:
            try:
                self._places[a, b] = self._found(a, b)
            except Rejected as why:
                raise NotCertified(f"the contacts of {a} and {b}: {why}") from None
        return self._places[a, b]

    def _found(self, a: str, b: str) -> list[Place]:
        one, other = self._bodies[a], self._bodies[b]
        tolerance = self._tolerance
        if max(box_gaps(one, other)) > tolerance * (1 + SLACK):
            return []
        rounding = self.rounding(a, b)
        of_a, of_b = self._surfaces.get(a), self._surfaces.get(b)
        if of_a is not None and of_b is not None:
            return places_of(of_a, of_b, tolerance, rounding)
        if of_b is not None:
            centre, radius = ball(one)
            return places_of_ball(np.array(centre), radius, of_b, tolerance, rounding)
        if of_a is not None:
            return [place.turned for place in self._found(b, a)]
        (p, r), (q, s) = ball(one), ball(other)
        return place_of_balls(np.array(p), r, np.array(q), s, tolerance)

    @cached_property
    def _surfaces(self) -> dict[str, Surface]:
        return {
            id_: Surface(body.world) for id_, body in self._bodies.items() if body.world is not None
        }

    def at(self, contact: BodyContact, point: ContactPoint) -> Place:
        """The contact of the bodies at this point and along this normal."""
        far = SAME_PLACE * max(self.largest(contact.a), self.largest(contact.b))
        at, normal = np.array(point.at), np.array(point.normal)
        same = [
            place
            for place in self.between(contact.a, contact.b)
            if np.abs(place.at - at).max() <= far
            and np.abs(place.normal - normal).max() <= SAME_NORMAL
        ]
        if not same:
            raise Rejected(f"{contact.a} and {contact.b} have no contact where a force acts")
        return min(same, key=lambda place: (not place.exact, np.abs(place.normal - normal).max()))

    def is_strict(self, a: str, b: str, place: Place) -> bool:
        """Whether the contact is as near as the nearest one, and needs no tolerance."""
        exact = [p.height for p in self.between(a, b) if p.exact]
        return place.exact and place.height <= min(exact) + 4 * self.rounding(a, b)

    def check_shallow(self, a: str, b: str) -> None:
        """Raises NotCertified if A and B may overlap by more than the tolerance: they may, unless A
        is seen to be free once it is moved by the tolerance along the normal of a contact. So may
        bodies that are thinner than the tolerance."""
        a, b = sorted((a, b))
        if not self._shallow(a, b):
            raise NotCertified(f"how deep {a} and {b} overlap is not certified")

    def _is_shallow(self, a: str, b: str) -> bool:
        one, other = self._bodies[a], self._bodies[b]
        reach = self._tolerance * (1 + SLACK)
        if one.world is None or other.world is None:
            return _passes(check_apart, one, other, -reach)
        places = self.between(a, b)
        if not places:
            return _passes(check_apart, one, other, self._tolerance)
        normals = np.unique([place.normal for place in places], axis=0)
        p, q = (world.vertices[world.used] for world in (one.world, other.world))
        if any(np.ptp(p @ n) + np.ptp(q @ n) <= 2 * reach for n in normals):
            return False  # so thin that a contact may be on the far side
        if any((p @ n).min() - (q @ n).max() >= -reach for n in normals):
            return True
        ways = np.unique(np.round(normals, 9), axis=0)[:MOST_WAYS] * reach
        return any(
            _passes(prove_way_out, vector(way), SurfacesProof(), one, other)
            for way in ways.tolist()
        )

    def largest(self, name: str) -> float:
        """The largest coordinate."""
        low, high = self._bounds(name)
        return float(max(np.abs(low).max(), np.abs(high).max()))

    def size(self, name: str) -> float:
        """The diagonal of the box."""
        low, high = self._bounds(name)
        return float(np.linalg.norm(high - low))

    def _bounds(self, name: str) -> tuple[Floats, Floats]:
        bounds = self._bodies[name].bounds
        if bounds is None:
            raise Rejected(f"{name} cannot be read")
        return bounds

    def rounding(self, a: str, b: str) -> float:
        """How far coordinates of A and B may be off by themselves."""
        written = self._bodies[a].resolution + self._bodies[b].resolution
        largest = max(self.largest(a), self.largest(b))
        return min(2 * written, SHARE * self._tolerance) + ROUNDING * largest


def _passes(check: Callable[..., None], *arguments: object) -> bool:
    try:
        check(*arguments)
    except Rejected:
        return False
    return True
