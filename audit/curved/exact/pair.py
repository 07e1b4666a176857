"""The rung for what bounds leave open: both bodies on one lattice, and what is proven of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.curved.exact.axes import candidates
from satcheck.audit.curved.exact.curved_body import CurvedBody, sizes_of
from satcheck.audit.curved.exact.lattice import Point, Vector, bits_of, direction_of, dot
from satcheck.audit.curved.exact.polytope_body import Floats, PolytopeBody, Triangles
from satcheck.audit.curved.exact.proof import Proof, prove
from satcheck.audit.curved.exact.reach import root_bounds
from satcheck.audit.curved.signed import ORIGIN, Signed
from satcheck.audit.report.report import Vector as Floating
from satcheck.scene.shape_image import ShapeImage

if TYPE_CHECKING:
    from satcheck.audit.bodies.placed_body import PlacedBody


class Faces(Struct, frozen=True):
    """vertices: (n, 3), world; triangles: (m, 3), outward, all of a solid, or one by itself."""

    vertices: Floats
    triangles: Triangles


Side = ShapeImage | Faces


class Lattice:
    """bits: world coordinates times 2**bits are integers."""

    def __init__(self, sides: Sequence[Side]) -> None:
        images = [side for side in sides if isinstance(side, ShapeImage)]
        self.matrix_bits = max(bits_of(c for column in g.columns for c in column) for g in images)
        sizes = max(bits_of(sizes_of(g.primitive)) for g in images)
        origins = max(bits_of(g.origin) for g in images)
        corners = [bits_of_array(side.vertices) for side in sides if isinstance(side, Faces)]
        self.bits = max(origins, self.matrix_bits + sizes, *corners)

    def body(self, side: Side) -> CurvedBody | PolytopeBody:
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


def proven(
    a: PlacedBody, b: PlacedBody, found: Signed, move: Floating = ORIGIN
) -> tuple[Signed, str]:
    """The signed distance of A, moved, and B with what exact arithmetic adds to it, and how."""
    proof, bits = proof_of(a, b, found, move)
    if proof is None:
        return found, "no exact axis was found"
    return with_proof(found, proof, bits), words(proof)


def proof_of(
    a: PlacedBody, b: PlacedBody, found: Signed, move: Floating = ORIGIN
) -> tuple[Proof | None, int]:
    """And the bits of the lattice that it is on."""
    sides = side_of(a, move), side_of(b, ORIGIN)
    lattice = Lattice(sides)
    first, second = (lattice.body(side) for side in sides)
    return prove(first, second, candidates(first, second, _toward(found, a, b))), lattice.bits


def side_of(body: PlacedBody, move: Floating) -> Side:
    if body.curved is not None:
        return body.curved.at(move)
    hull = body.hull() if move == ORIGIN else body.mesh.translated(move).convex_hull()
    return Faces(np.asarray(hull.vertices), np.asarray(hull.triangles))


def _toward(found: Signed, a: PlacedBody, b: PlacedBody) -> Vector:
    if found.normal is not None:
        return direction_of(found.normal)
    return direction_of(q - p for p, q in zip(_middle(a), _middle(b), strict=True))


def _middle(body: PlacedBody) -> list[float]:
    low, high = body.bounds
    return [p + (q - p) / 2 for p, q in zip(low, high, strict=True)]


def words(proof: Proof) -> str:
    axis = ", ".join(f"{c:.6g}" for c in unit(proof.axis))
    detail = {
        "separated": "separates them",
        "touching": "separates them without a gap, and they have a point in common",
        "penetrating": "is that of a point inside both",
        "free": "separates them without a gap",
    }
    return f"the axis ({axis}) {detail[proof.outcome]}"


def with_proof(found: Signed, proof: Proof, bits: int) -> Signed:
    """The proof's outcome, and bounds as narrow as both make them."""
    if proof.outcome == "free":
        lower = max(found.lower, 0.0)
        return replace(
            found, lower=lower, distance=max(found.distance, lower), upper=max(found.upper, lower)
        )
    axis = unit(proof.axis)
    if proof.outcome == "touching":
        assert proof.point is not None
        at = rounded(proof.point, bits)
        return Signed(0.0, 0.0, 0.0, axis, at, at, "touching", True)
    along = length_below(proof.gap[0], proof.axis, bits)
    if proof.outcome == "separated":
        lower = max(found.lower, along)
        upper = found.upper if proof.ends is None else min(found.upper, apart(proof.ends, bits))
        upper = max(upper, lower)
        distance = min(max(found.distance, lower), upper)
        return replace(
            found, distance=distance, lower=lower, upper=upper, outcome="separated", exact=True
        )
    upper = min(found.upper, 0.0)
    if along <= found.lower:
        distance = min(max(found.distance, found.lower), upper)
        return replace(found, distance=distance, upper=upper, outcome="penetrating", exact=True)
    assert proof.point is not None
    at = rounded(proof.point, bits)
    half = -along / 2
    ends = [tuple(c + s * half * n for c, n in zip(at, axis, strict=True)) for s in (1, -1)]
    return Signed(along, along, upper, axis, ends[0], ends[1], "penetrating", True)  # type: ignore[arg-type]


def length_below(gap: Fraction, axis: Vector, bits: int) -> float:
    """A gap in lattice units times the length of the axis, in world units, rounded down."""
    low, high = root_bounds(dot(axis, axis))
    exact = gap / (high if gap > 0 else low) / (1 << bits)
    nearest = float(exact)
    return nearest if Fraction(nearest) <= exact else math.nextafter(nearest, -math.inf)


def apart(ends: tuple[Point, Point], bits: int) -> float:
    """How far two points are apart, world units, rounded up."""
    p, q = ends
    w = p[3] * q[3]
    square = sum((p[k] * q[3] - q[k] * p[3]) ** 2 for k in range(3))
    exact = root_bounds(square)[1] / (w << bits)
    nearest = float(exact)
    return nearest if Fraction(nearest) >= exact else math.nextafter(nearest, math.inf)


def rounded(p: Point, bits: int) -> Floating:
    x, y, z = (float(Fraction(c, p[3] << bits)) for c in p[:3])
    return x, y, z


def unit(axis: Vector) -> Floating:
    largest = max(abs(c) for c in axis)
    x, y, z = (c / largest for c in axis)
    length = math.hypot(x, y, z)
    return x / length, y / length, z / length
