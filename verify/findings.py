"""One finding: its certificates, and whether what it says follows from what they prove."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from satcheck.scene.health import MOST_AROUND
from satcheck.verify.bodies import SAME, Placed
from satcheck.verify.boundary import boundary_point, contacts_if_apart
from satcheck.verify.cover import depth_is_at_least
from satcheck.verify.curved import Curved
from satcheck.verify.curved_pair import CurvedPair
from satcheck.verify.distances import check_distance, hulls_are_apart, spanned, squared_gap
from satcheck.verify.evidence import axis, gap_along, member, rational, vector
from satcheck.verify.exact import Point, Rejected, dot, sub
from satcheck.verify.figures import (
    EXACT_WIDTH,
    check_figures,
    check_id,
    rounding_of,
    shows_direction,
)
from satcheck.verify.in_plane import (
    CurveError,
    check_in_plane,
    check_proof_in_plane,
    curve_error,
    reaching,
)
from satcheck.verify.open_parts import turns_around
from satcheck.verify.polytope import inner_radius_exceeds
from satcheck.verify.relations import OVERLAPS, Pair, prove, prove_free
from satcheck.verify.rules import Asked
from satcheck.verify.severity import Known, check_severity, proven_depth
from satcheck.verify.world import Exact, World

NO_ERROR = CurveError(Fraction(0), Fraction(0))
TOUCH_FRACTION = 1e-3  # the default touch band, of the smaller body's diagonal, at most


@dataclass(frozen=True, slots=True)
class Proven:
    """What was proven of an accepted finding besides its relation."""

    depth: bool = False
    mtv: bool = False
    distance: bool = False
    normal: bool = False
    contacts: bool = False


def check_finding(finding: dict[str, Any], a: Placed, b: Placed, asked: Asked) -> Proven:
    """Rejects a finding, of two bodies that could be read, that is not proven."""
    if a.reason is not None or b.reason is not None:
        raise Rejected(a.reason or b.reason or "a body is missing")
    certificate = finding.get("certificate")
    if certificate is None:
        raise Rejected("it has no certificate")
    check_id(finding)
    tolerance = _tolerance(finding, a, b, asked)
    clearance = Fraction(asked.clearance or 0.0)
    check_figures(finding, a, b)
    if a.curved is not None or b.curved is not None:
        return _check_curved(finding, a, b, asked, tolerance)
    assert a.world is not None
    assert b.world is not None
    pair = pair_of(a, b, a.world, b.world)
    relation, exact = finding.get("relation"), finding.get("exact_relation")
    error = curve_error(a, b)
    hulls_apart = _prove_relation(finding, pair, a, b, asked, tolerance)
    mtv = _check_mtv(finding, certificate, a, b)
    depth = _check_depth(finding, certificate, pair, error)
    covered = _check_cover(finding, certificate, pair) and not error.farther
    rounding = rounding_of(a, b)
    if pair.convex:
        distance = directed = spanned(finding, rounding, hulls_are_apart(pair))
    else:
        distance = check_distance(finding, certificate, pair, rounding)
        distance = distance and not (a.holed or b.holed)
        directed = mtv or shows_direction(finding, a, b)
    distance = distance and not error.closer
    proven = Proven(depth or (covered and mtv), mtv, distance or _is_zero(finding), directed or mtv)
    if relation != exact:
        near = max(clearance - error.farther, Fraction(0))
        _check_band(finding, certificate, pair, (a, b), tolerance, near, proven)
    if exact not in OVERLAPS and not hulls_apart:
        check_holes(a, b, max(tolerance, clearance))
        check_pieces(a, b)

    def keeps(length: Fraction) -> bool | None:
        return _keeps(
            finding,
            length,
            lambda: squared_gap(member(certificate, "gap"), pair),
            lambda least: _prove_apart(certificate, pair, (a, b), least),
            error,
        )

    most = proven_depth(finding, depth, mtv)
    slack = rounding.of(tolerance)
    if relation == "near":
        _prove_apart(certificate, pair, (a, b), max(tolerance - slack, Fraction(0)))
    if relation in OVERLAPS and most is not None and most + slack < tolerance:
        raise Rejected("the overlap is within the tolerance: the bodies touch")
    check_severity(finding, asked, Known(most, keeps, EXACT_WIDTH))
    return proven


def _prove_relation(
    finding: dict[str, Any], pair: Pair, a: Placed, b: Placed, asked: Asked, tolerance: Fraction
) -> bool:
    """By the certificate. Whether it holds for the hulls, so that neither body can lie inside the
    other."""
    relation = str(finding.get("exact_relation"))
    proof, ends = member(finding["certificate"], "relation"), pair
    if asked.across is not None:
        check_in_plane(finding, asked.across)
        ends = pair_of(a, b, *reaching(relation, pair.a.world, pair.b.world, asked.across))
        check_proof_in_plane(proof, ends, asked.across)
    error = curve_error(a, b)
    if asked.across is not None and relation != "separated":
        error.check_overlap(relation, proof, ends, asked.across)
    beyond = tolerance if finding.get("relation") == "separated" else Fraction(0)
    least = _least(finding, asked) + error.closer
    return prove(relation, proof, ends, max(beyond, error.closer), least)


def _is_zero(finding: dict[str, Any]) -> bool:
    """Whether the distance is that of bodies with a common point, which is 0, to rounding."""
    return str(finding["exact_relation"]) == "touching"


def _least(finding: dict[str, Any], asked: Asked) -> Fraction:
    """The least gap of a finding that says that it keeps its clearance. A figure that equals the
    clearance up to rounding keeps it."""
    if finding["relation"] != "separated" or finding["undecided"] == "limit":
        return Fraction(0)
    return Fraction(asked.clearance or 0.0) * (1 - EXACT_WIDTH)


def _keeps(
    finding: dict[str, Any],
    clearance: Fraction,
    squared: Callable[[], Fraction],
    prove_apart: Callable[[Fraction], None],
    error: CurveError = NO_ERROR,
) -> bool | None:
    """Whether the gap keeps the clearance, independent of the touch band; None: not shown either
    way. squared: of the gap between two points. prove_apart: rejects a narrower gap. error: of the
    polygons that stand for the bodies."""
    if finding["exact_relation"] != "separated":
        return False
    if finding["relation"] == "separated":  # then that is a part of what was proven
        return None if finding["undecided"] == "limit" else True
    if squared() < max(clearance - error.farther, Fraction(0)) ** 2:
        return False
    try:
        prove_apart(clearance * (1 - EXACT_WIDTH) + error.closer)
    except Rejected:
        return None
    return True


def _prove_apart(
    certificate: Any, pair: Pair, bodies: tuple[Placed, Placed], least: Fraction
) -> None:
    """Rejects separated bodies with a gap narrower than that."""
    if not pair.convex:
        check_holes(*bodies, least)
        contacts_if_apart(pair.a, pair.b, Fraction(0), least)
        return
    gap = member(certificate, "gap")
    p, q = (
        boundary_point(member(gap, key), body, of_hull=True)
        for key, body in (("a", pair.a), ("b", pair.b))
    )
    n: Point = sub(q, p)  # type: ignore[arg-type, assignment]
    along = gap_along(pair.a, pair.b, n)
    if along <= 0 or along * along < least * least * dot(n, n):
        raise Rejected("the gap is not shown to be as wide")


def _check_curved(
    finding: dict[str, Any], a: Placed, b: Placed, asked: Asked, tolerance: Fraction
) -> Proven:
    """Of two solids, so that neither can hide in the other; their depth is not certified."""
    pair, certificate = curved_pair_of(a, b), finding["certificate"]
    relation, exact = finding.get("relation"), finding.get("exact_relation")
    clearance = Fraction(asked.clearance or 0.0)
    separated = relation == "separated"
    beyond, least = (tolerance if separated else Fraction(0)), _least(finding, asked)
    pair.prove(str(exact), member(certificate, "relation"), beyond, least)
    mtv = _check_mtv(finding, certificate, a, b)
    distance = spanned(finding, rounding_of(a, b), lambda n, length: pair.gap(n, length) >= 0)
    proven = Proven(False, mtv, distance or _is_zero(finding), distance or mtv)
    _bounds_of_depth(finding)
    if relation != exact:
        band = tolerance * (1 + EXACT_WIDTH)
        if exact == "separated" and relation in ("touching", "near"):
            squared, near = pair.squared_gap(member(certificate, "gap")), relation == "near"
            if not (squared < clearance**2 if near else squared <= band**2):
                raise Rejected("the points of the gap are further apart than that")
        elif not (exact in OVERLAPS and relation == "touching" and _in_band(finding, pair, band)):
            raise Rejected(f"{relation!r} does not follow from {exact!r}")

    def keeps(length: Fraction) -> bool | None:
        return _keeps(
            finding,
            length,
            lambda: pair.squared_gap(member(certificate, "gap")),
            lambda least: pair.prove_apart(member(certificate, "gap"), least),
        )

    most = proven_depth(finding, proven.depth, proven.mtv)
    check_severity(finding, asked, Known(most, keeps, EXACT_WIDTH))
    return proven


def _in_band(finding: dict[str, Any], pair: CurvedPair, band: Fraction) -> bool:
    """Whether an overlap is no deeper than that, along the axis of the certificate."""
    proof = member(finding["certificate"], "band")
    if pair.gap(axis(member(proof, "axis")), -band) < 0:
        raise Rejected("the bodies overlap by more than the tolerance")
    return True


def curved_pair_of(a: Placed, b: Placed) -> CurvedPair:
    """World units: one lattice is enough for the vertices of the one mesh at most."""
    bodies: list[Curved | Exact] = []
    for body in (a, b):
        if body.curved is not None:
            bodies.append(body.curved)
        elif body.world is None or not body.convex or body.world.is_flat:
            raise Rejected("a curved shape is certified against convex bodies only")
        else:
            bodies.append(Exact(body.world, body.world.lattice))
    return CurvedPair(bodies[0], bodies[1])


def pair_of(a: Placed, b: Placed, world_a: World, world_b: World) -> Pair:
    k = max(world_a.lattice, world_b.lattice)
    return Pair(Exact(world_a, k), Exact(world_b, k), a.convex and b.convex)


def number(value: Any) -> Fraction:
    """A finite JSON number."""
    if isinstance(value, str):
        raise Rejected("a number is expected")
    found = rational(value)
    if abs(found) > sys.float_info.max:  # an integer of JSON has any length
        raise Rejected("a number is out of range")
    return found


def default_tolerance(a: Placed, b: Placed, across: int | None) -> float:
    """The input precision of two bodies, but no more than a share of the smaller one, and no less
    than what their curves may be off their polygons. across: the axis that no size counts along."""
    axes = [axis for axis in range(3) if axis != across]
    sizes = [
        math.dist(*(corner[axes].tolist() for corner in body.bounds))
        for body in (a, b)
        if body.bounds is not None
    ]
    written = min(a.resolution + b.resolution, TOUCH_FRACTION * min(sizes))
    return max(written, a.deviation + b.deviation)


def _tolerance(finding: dict[str, Any], a: Placed, b: Placed, asked: Asked) -> Fraction:
    said = number(finding.get("tolerance"))
    expected = asked.tolerance
    if expected is None:
        expected = default_tolerance(a, b, asked.across)
    if not math.isclose(said, expected, rel_tol=SAME):
        raise Rejected(f"the tolerance is {expected!r}")
    return said


def _check_mtv(finding: dict[str, Any], certificate: Any, a: Placed, b: Placed) -> bool:
    """A, moved by the MTV with one rounding of each coordinate, has no common interior with B.

    The MTV is the depth long, and what rounding takes: it is lengthened until the rounded
    coordinates are free.
    """
    if finding.get("mtv_verified") is not True:
        return False
    if finding.get("exact_relation") not in OVERLAPS:
        raise Rejected("only an overlap has a way out")
    bounds = [body.bounds for body in (a, b) if body.bounds is not None]
    largest = Fraction(max(float(np.abs(box).max()) for box in bounds))
    if finding.get("mtv_moves") != "a":
        raise Rejected("the MTV moves A")
    depth = number(finding.get("depth"))
    move = vector(finding.get("mtv"))
    if dot(move, move) > (depth + EXACT_WIDTH * (depth + largest)) ** 2:
        raise Rejected("the MTV is longer than the depth")
    if curve_error(a, b).closer and "mtv" not in certificate:
        return False
    _prove_way_out(move, member(certificate, "mtv"), a, b)
    return True


def _prove_way_out(move: Point, certificate: Any, a: Placed, b: Placed) -> None:
    offset = [float(c) for c in move]
    if not np.isfinite(offset).all():
        raise Rejected("a translation is finite")
    if a.curved is not None or b.curved is not None:
        curved_pair_of(a.moved(offset), b).prove_free(certificate)
        return
    assert a.world is not None
    assert b.world is not None
    moved = a.moved(offset)
    assert moved.world is not None
    if member(certificate, "kind") != "axis":
        check_holes(moved, b, Fraction(0))
    pair = pair_of(a, b, moved.world, b.world)
    prove_free(certificate, pair)
    if not curve_error(a, b).leaves_gap(certificate, pair):
        raise Rejected("the way out is shown of polygons alone, not of the curves")


def _check_depth(
    finding: dict[str, Any], certificate: dict[str, Any], pair: Pair, error: CurveError
) -> bool:
    """The interval of the depth: a ball in the Minkowski difference, an axis across it."""
    bounds = _bounds_of_depth(finding)
    if bounds is None or "depth" not in certificate:
        return False
    low, high = bounds
    if not pair.convex:
        raise Rejected("a depth is certified for convex bodies only")
    proof = certificate["depth"]
    inner_radius_exceeds(member(proof, "lower"), pair.a, pair.b, low + error.farther)
    if not depth_at_most(axis(member(proof, "upper")), pair, high - error.closer):
        raise Rejected("along the axis the bodies overlap by more than the depth")
    return True


def _check_cover(finding: dict[str, Any], certificate: dict[str, Any], pair: Pair) -> bool:
    """The lower end of the depth of bodies that are not both convex, where it is certified."""
    if "cover" not in certificate:
        return False
    bounds = _bounds_of_depth(finding)
    if bounds is None:
        raise Rejected("a cover, and no depth")
    depth_is_at_least(certificate["cover"], pair.a, pair.b, bounds[0])
    return True


def _bounds_of_depth(finding: dict[str, Any]) -> tuple[Fraction, Fraction] | None:
    bounds, figure = finding.get("depth_bounds"), finding.get("depth")
    if bounds is None:
        if figure is not None:
            raise Rejected("a depth without its bounds")
        return None
    if not isinstance(bounds, list) or len(bounds) != 2:
        raise Rejected("depth_bounds are two numbers")
    low, high = number(bounds[0]), number(bounds[1])
    if not 0 <= low <= high or number(figure) != high:
        raise Rejected("the depth is the upper end of its bounds")
    return low, high


def depth_at_most(n: Point, pair: Pair, length: Fraction) -> bool:
    """Whether moving A against this axis by the length, world units, takes it off B."""
    overlap = -gap_along(pair.a, pair.b, n)
    return overlap <= 0 or overlap * overlap <= length * length * dot(n, n)


def _check_band(
    finding: dict[str, Any],
    certificate: dict[str, Any],
    pair: Pair,
    bodies: tuple[Placed, Placed],
    tolerance: Fraction,
    clearance: Fraction,
    proven: Proven,
) -> None:
    """Why the relation is another than the exact one."""
    relation, exact = finding.get("relation"), finding.get("exact_relation")
    band = tolerance * (1 + EXACT_WIDTH)
    if exact == "separated" and relation in ("touching", "near"):
        squared, near = squared_gap(member(certificate, "gap"), pair), relation == "near"
        if not (squared < clearance**2 if near else squared <= band**2):
            raise Rejected("the points of the gap are further apart than that")
        return
    if exact in OVERLAPS and relation == "touching":
        if "band" in certificate:
            proof = certificate["band"]
            if "axis" in proof:
                if pair.convex and depth_at_most(axis(proof["axis"]), pair, band):
                    return
                raise Rejected("the bodies overlap by more than the tolerance")
            move = vector(member(proof, "move"))
            if dot(move, move) <= band * band:
                _prove_way_out(move, member(proof, "free"), *bodies)
                return
        elif proven.depth and number(finding["depth"]) <= band:
            return
        elif proven.mtv:
            move = vector(finding["mtv"])
            if dot(move, move) <= band * band:
                return
    raise Rejected(f"{relation!r} does not follow from {exact!r}")


def check_pieces(a: Placed, b: Placed) -> None:
    """Rejects bodies that do not meet, of which open pieces of one surround the other."""
    for outer, inner in ((a, b), (b, a)):
        if outer.world is None or inner.world is None or outer.pieces is None:
            continue
        world, point = outer.world, inner.world.vertices[0]
        low, high = world.bounds
        is_within = (low <= point).all() and (point <= high).all()
        if is_within and abs(turns_around(world.vertices[outer.pieces], point)) > MOST_AROUND:
            raise Rejected(f"open pieces of {outer.id} surround {inner.id}")


def check_holes(a: Placed, b: Placed, margin: Fraction) -> None:
    """Rejects bodies of which one has holes, unless their boxes are farther apart than that: what
    fills a hole may be there."""
    if not (a.holed or b.holed) or a.bounds is None or b.bounds is None:
        return
    (a_low, a_high), (b_low, b_high) = a.bounds, b.bounds
    gaps = np.concatenate([b_low - a_high, a_low - b_high])
    if Fraction(gaps.max()) <= margin * (1 + EXACT_WIDTH):
        raise Rejected("what fills a hole is not certified, and may be where the other body is")
