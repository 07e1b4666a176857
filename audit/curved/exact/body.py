"""What is asked of a body in exact arithmetic, whatever it is."""

from __future__ import annotations

from typing import Protocol

from satcheck.audit.curved.exact.faces import Face
from satcheck.audit.curved.exact.lattice import Point, Vector
from satcheck.audit.curved.exact.reach import Reach


class ExactBody(Protocol):
    """Closed and convex, on the lattice of a pair. flat: it has no inside."""

    @property
    def flat(self) -> bool: ...

    @property
    def middle(self) -> Point:
        """A point inside; of a flat body on it."""

    def reach(self, n: Vector) -> Reach:
        """The largest product of n with one of its points."""

    def face(self, n: Vector) -> Face:
        """The points that reach so far; where they are irrational, points very close to them."""

    def side(self, p: Point) -> int:
        """1 inside, 0 on the border, -1 outside. A flat body has no inside: 0 on it."""

    def normals(self, toward: Vector, /) -> list[Vector]:
        """Of flat parts of its border, outward, those that look along `toward` most."""

    def lines(self, toward: Vector, /) -> list[tuple[Vector, Vector]]:
        """Straight lines in or along it that a contact may depend on: a point, a direction."""

    def points(self, toward: Vector, /) -> list[Vector]:
        """Points in it that a contact may depend on."""
