"""A curved shape: the exact image of a primitive under a matrix.

The points are x = M y + t for y in the primitive. If h is the support of the primitive, the support
of the body is h(M^T n) + t.n. M is any regular matrix. A rounded rotation is used as it is, without
an ideal rotation behind it.
"""

from __future__ import annotations

import math

from satcheck.core.curved.exact.faces import Disc, Face, Polygon
from satcheck.core.curved.exact.lattice import (
    ROOT_BITS,
    IntVector,
    Point,
    Reach,
    combined,
    cross,
    dot,
    integer,
    negated,
    shortened,
)
from satcheck.core.shapes import Capsule, Cone, Cylinder, Ellipsoid, ShapeImage, Sphere, half_sizes

Sizes = tuple[int, int, int]  # see half_sizes


class CurvedBody:
    """Integer values. columns: of M, times 2**matrix_bits; sizes: times 2**(bits - matrix_bits);
    origin: t times 2**bits."""

    flat = False

    def __init__(self, image: ShapeImage, bits: int, matrix_bits: int) -> None:
        self.kind = type(image.primitive)
        x, y, z = (_integers(column, matrix_bits) for column in image.columns)
        self.columns = x, y, z
        self.origin: IntVector = _integers(image.origin, bits)
        a, b, c = (integer(s, bits - matrix_bits) for s in half_sizes(image.primitive))
        self.sizes = a, b, c
        # Rows of the inverse of M times its determinant.
        self.inverse = cross(y, z), cross(z, x), cross(x, y)
        self.determinant = dot(x, self.inverse[0])

    @property
    def middle(self) -> Point:
        return (*self.origin, 1)

    def reach(self, n: IntVector) -> Reach:
        """The largest product of n with a point of the body."""
        x, y, z = self._turned(n)
        a, b, c = self.sizes
        base = dot(self.origin, n)
        across = a * a * (x * x + y * y)
        if self.kind is Ellipsoid:
            return Reach(base, across + (b * b - a * a) * y * y + c * c * z * z)
        if self.kind is Cone:
            tip = self._towards_tip(x, y, z)
            return Reach(base + c * z) if tip > 0 else Reach(base - c * z, across)
        if self.kind is Cylinder:
            return Reach(base + c * abs(z), across)
        return Reach(base + c * abs(z), across + a * a * z * z)

    def _turned(self, n: IntVector) -> IntVector:
        x, y, z = self.columns
        return dot(x, n), dot(y, n), dot(z, n)

    def _towards_tip(self, x: int, y: int, z: int) -> int:
        """> 0: the apex of a cone reaches farther than its base; 0: equally far."""
        a, _, c = self.sizes
        if z <= 0:
            return -1
        return 4 * c * c * z * z - a * a * (x * x + y * y)

    def face(self, n: IntVector) -> Face:
        """The points that are farthest along n. If they are irrational, points very close to
        them."""
        x, y, z = self._turned(n)
        a, b, c = self.sizes
        if self.kind is Ellipsoid:
            return self._polygon([self._round((a, b, c), (x, y, z))])
        if self.kind is Sphere or self.kind is Capsule:
            ends = [c, -c] if z == 0 and c else [c if z >= 0 else -c]
            return self._polygon([self._round((a, a, a), (x, y, z), end) for end in ends])
        if self.kind is Cone:
            tip = self._towards_tip(x, y, z)
            if tip > 0:
                return self._polygon([(0, 0, c, 1)])
            if tip == 0:
                return self._polygon([(0, 0, c, 1), self._round((a, a, 0), (x, y, z), -c)])
        if x == y == 0:
            return self._disc(c if z > 0 else -c)
        ends = [-c] if self.kind is Cone else [c, -c] if z == 0 else [c if z > 0 else -c]
        return self._polygon([self._round((a, a, 0), (x, y, z), end) for end in ends])

    def _round(self, radii: Sizes, m: IntVector, lift: int = 0) -> Point:
        """The point farthest along m of an ellipsoid about (0, 0, lift), in the frame of the shape:
        (radii^2 m) / |radii m|."""
        square = sum((r * c) ** 2 for r, c in zip(radii, m, strict=True))
        root, bits = math.isqrt(square), 0
        if root * root != square:
            root, bits = math.isqrt(square << 2 * ROOT_BITS), ROOT_BITS
        x, y, z = ((r * r * c) << bits for r, c in zip(radii, m, strict=True))
        return x, y, z + lift * root, root

    def _polygon(self, local: list[Point]) -> Polygon:
        return Polygon(tuple(self._placed(p) for p in local))

    def _disc(self, lift: int) -> Disc:
        u = self.columns[0]
        radius = self.sizes[0] * math.isqrt(dot(u, u))
        return Disc(self._placed((0, 0, lift, 1)), radius, self.inverse[:2])

    def _placed(self, p: Point) -> Point:
        x, y, z = combined((*self.columns, self.origin), p)
        return x, y, z, p[3]

    def side(self, p: Point) -> int:
        """1 inside, 0 on the border, -1 outside."""
        w = p[3] * abs(self.determinant)
        step = tuple(p[k] - p[3] * self.origin[k] for k in range(3))
        x, y, z = (dot(row, step) for row in self.inverse)
        a, b, c = (s * w for s in self.sizes)
        z = z if self.determinant > 0 else -z
        across = x * x + y * y
        if self.kind is Ellipsoid:
            squares = (b * c * x) ** 2 + (c * a * y) ** 2 + (a * b * z) ** 2
            return _sign((a * b * c) ** 2 - squares)
        if self.kind is Cylinder:
            return min(_sign(a * a - across), _sign(c - abs(z)))
        if self.kind is Cone:
            # At z the radius is a (c - z) / 2 c.
            slant = (a * (c - z)) ** 2 - 4 * c * c * across
            return min(_sign(slant), _sign(c - abs(z))) if abs(z) < c else _end(across, a, c, z)
        beyond = max(abs(z) - c, 0)
        return _sign(a * a - across - beyond * beyond)

    def normals(self, toward: IntVector) -> list[IntVector]:
        """Normals of the flat ends; for an ellipsoid, normals of the planes across its axes."""
        if self.kind is Ellipsoid:
            rows = list(self.inverse)
        elif self.kind is Cylinder or self.kind is Cone:
            rows = [self.inverse[2]]
        else:
            return []
        normals = [shortened(row) for row in rows]
        return [n if dot(n, toward) > 0 else negated(n) for n in normals]

    def lines(self, _toward: IntVector) -> list[tuple[IntVector, IntVector]]:
        """Lines that a contact may depend on, each a point and a direction."""
        if self.kind is Capsule or self.kind is Cylinder:
            return [(self.origin, shortened(self.columns[2]))]
        return []

    def points(self, _toward: IntVector) -> list[IntVector]:
        """Points that a contact may depend on."""
        if self.kind is Sphere or self.kind is Ellipsoid or self.kind is Cylinder:
            return [self.origin]
        half = combined([self.columns[2]], [self.sizes[2]])
        ends = [(o + h, o - h) for o, h in zip(self.origin, half, strict=True)]
        tip, end = tuple(e[0] for e in ends), tuple(e[1] for e in ends)
        return [tip] if self.kind is Cone else [tip, end]  # type: ignore[list-item]


def _end(across: int, radius: int, half: int, z: int) -> int:
    """The side of a cone (see `side`) for a point at the height of its apex or its base, or
    beyond."""
    at_base = z == -half and across <= radius * radius
    return 0 if at_base or (z == half and across == 0) else -1


def _sign(number: int) -> int:
    return (number > 0) - (number < 0)


def _integers(v: tuple[float, ...], bits: int) -> IntVector:
    x, y, z = (integer(c, bits) for c in v)
    return x, y, z
