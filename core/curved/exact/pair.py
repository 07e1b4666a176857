"""Exact decisions about a pair: puts both bodies on one integer lattice and proves there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import chain

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.conventions import Vector
from satcheck.core.curved.exact.curved_body import CurvedBody
from satcheck.core.curved.exact.lattice import (
    IntVector,
    Point,
    bits_of,
    direction_of,
    dot,
    root_bounds,
)
from satcheck.core.curved.exact.polytope_body import Floats, PolytopeBody, Triangles
from satcheck.core.curved.exact.proof import ExactBody, Proof, candidates, prove
from satcheck.core.curved.placed import Body
from satcheck.core.curved.signed import ORIGIN, Signed
from satcheck.core.shapes import ShapeImage, half_sizes


class Faces(Struct, frozen=True):
    """vertices: (n, 3), world; triangles: (m, 3), outward, all of a solid, or a single one."""

    vertices: Floats
    triangles: Triangles


Side = ShapeImage | Faces
_ALONE = np.array([[0, 1, 2]], dtype=np.uint32)
# A face may stand on many triangles. A few points of contact are enough.
MOST_CONTACTS = 8


class Lattice:
    """bits: world coordinates times 2**bits are integers."""

    def __init__(self, sides: Sequence[Side]) -> None:
        images = [side for side in sides if isinstance(side, ShapeImage)]
        self.matrix_bits = max(bits_of(c for column in g.columns for c in column) for g in images)
        sizes = max(bits_of(half_sizes(g.primitive)) for g in images)
        origins = max(bits_of(g.origin) for g in images)
        corners = [bits_of_array(side.vertices) for side in sides if isinstance(side, Faces)]
        self.bits = max(origins, self.matrix_bits + sizes, *corners)

    def body(self, side: Side) -> ExactBody:
        if isinstance(side, ShapeImage):
            return CurvedBody(side, self.bits, self.matrix_bits)
        return PolytopeBody(side.vertices, side.triangles, self.bits)


def bits_of_array(numbers: Floats) -> int:
    fractions, exponents = np.frexp(numbers[numbers != 0.0])
    if not fractions.size:
        return 0
    mantissas = np.ldexp(fractions, 53).astype(np.int64)
    lowest = np.frexp((mantissas & -mantissas).astype(np.float64))[1] - 1
    return max(0, int((53 - exponents - lowest).max()))


def proven(a: Body, b: Body, bounds: Signed, move: Vector = ORIGIN) -> tuple[Signed, Proof | None]:
    """The signed distance of A, translated by `move`, and B. Exact arithmetic narrows its
    bounds."""
    proof, bits = proof_of(a, b, bounds, move)
    return (bounds if proof is None else with_proof(bounds, proof, bits)), proof


def proof_of(a: Body, b: Body, bounds: Signed, move: Vector = ORIGIN) -> tuple[Proof | None, int]:
    """(proof, bits of its lattice)."""
    first, second, lattice = on_lattice(a, b, move)
    return prove(first, second, candidates(first, second, _toward(bounds, a, b))), lattice.bits


def on_lattice(a: Body, b: Body, move: Vector = ORIGIN) -> tuple[ExactBody, ExactBody, Lattice]:
    """Both as exact bodies; A is translated by `move`. At least one is curved."""
    sides = _side_of(a, move), _side_of(b, ORIGIN)
    lattice = Lattice(sides)
    return lattice.body(sides[0]), lattice.body(sides[1]), lattice


def _side_of(body: Body, move: Vector) -> Side:
    if body.curved is not None:
        return body.curved.moved(move).image
    hull = body.hull() if move == ORIGIN else body.mesh.translated(move).convex_hull()
    return Faces(np.asarray(hull.vertices), np.asarray(hull.triangles))


def _toward(bounds: Signed, a: Body, b: Body) -> IntVector:
    if bounds.normal is not None:
        return direction_of(bounds.normal)
    return direction_of(q - p for p, q in zip(_middle(a), _middle(b), strict=True))


def _middle(body: Body) -> list[float]:
    low, high = body.bounds
    return [p + (q - p) / 2 for p, q in zip(low, high, strict=True)]


def with_proof(bounds: Signed, proof: Proof, bits: int) -> Signed:
    """The outcome of the proof, and the intersection of both bounds."""
    if proof.outcome == "free":
        lower = max(bounds.lower, 0.0)
        return replace(
            bounds,
            lower=lower,
            distance=max(bounds.distance, lower),
            upper=max(bounds.upper, lower),
        )
    axis = unit(proof.axis)
    if proof.outcome == "touching":
        assert proof.point is not None
        at = rounded(proof.point, bits)
        return Signed(0.0, 0.0, 0.0, axis, at, at, "touching", True)
    along = length_below(proof.gap[0], proof.axis, bits)
    if proof.outcome == "separated":
        lower = max(bounds.lower, along)
        upper = bounds.upper if proof.ends is None else min(bounds.upper, apart(proof.ends, bits))
        upper = max(upper, lower)
        distance = min(max(bounds.distance, lower), upper)
        return replace(
            bounds, distance=distance, lower=lower, upper=upper, outcome="separated", exact=True
        )
    upper = min(bounds.upper, 0.0)
    if along <= bounds.lower:
        distance = min(max(bounds.distance, bounds.lower), upper)
        return replace(bounds, distance=distance, upper=upper, outcome="penetrating", exact=True)
    assert proof.point is not None
    at = rounded(proof.point, bits)
    half = -along / 2
    ends = [tuple(c + s * half * n for c, n in zip(at, axis, strict=True)) for s in (1, -1)]
    return Signed(along, along, upper, axis, ends[0], ends[1], "penetrating", True)  # type: ignore[arg-type]


def length_below(gap: Fraction, axis: IntVector, bits: int) -> float:
    """A gap in world units, rounded down. gap: in lattice units times the length of the axis."""
    low, high = root_bounds(dot(axis, axis))
    exact = gap / (high if gap > 0 else low) / (1 << bits)
    nearest = float(exact)
    return nearest if Fraction(nearest) <= exact else math.nextafter(nearest, -math.inf)


def apart(ends: tuple[Point, Point], bits: int) -> float:
    """The distance of two points, world units, rounded up."""
    p, q = ends
    w = p[3] * q[3]
    square = sum((p[k] * q[3] - q[k] * p[3]) ** 2 for k in range(3))
    exact = root_bounds(square)[1] / (w << bits)
    nearest = float(exact)
    return nearest if Fraction(nearest) >= exact else math.nextafter(nearest, math.inf)


def rounded(p: Point, bits: int) -> Vector:
    x, y, z = (float(Fraction(c, p[3] << bits)) for c in p[:3])
    return x, y, z


def unit(axis: IntVector) -> Vector:
    largest = max(abs(c) for c in axis)
    x, y, z = (c / largest for c in axis)
    length = math.hypot(x, y, z)
    return x / length, y / length, z / length


def refined(image: ShapeImage, corners: Floats, bounds: Sequence[Signed]) -> list[Signed]:
    """The signed distances of triangles.

    Exact arithmetic narrows their bounds. corners: (n, 3, 3), world, of the triangles; the shape is
    A."""
    lattice = Lattice((image, Faces(corners.reshape(-1, 3), _ALONE)))
    shape = CurvedBody(image, lattice.bits, lattice.matrix_bits)
    known: list[IntVector] = []  # axes that often prove other triangles too
    touched, results = 0, []
    for points, signed in zip(corners, bounds, strict=True):
        triangle = PolytopeBody(points, _ALONE, lattice.bits)
        if not triangle.face_normals():  # without area: only edges of its neighbours
            results.append(signed)
            continue
        toward = direction_of(signed.normal or (0.0, 0.0, 1.0))
        axes = chain(known, candidates(shape, triangle, toward))
        proof = prove(shape, triangle, axes, contact=touched < MOST_CONTACTS)
        if proof is not None:
            touched += proof.outcome == "touching"
            if proof.axis not in known:
                known.append(proof.axis)
        results.append(signed if proof is None else with_proof(signed, proof, lattice.bits))
    return results
