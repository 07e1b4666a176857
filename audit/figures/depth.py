"""How deep two bodies with a common interior overlap, and the way out for A."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck import core
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.figures.escape import Escape, verified_escape
from satcheck.audit.request.trace import Trace
from satcheck.report.report import Vector, Witness

if TYPE_CHECKING:
    from satcheck.audit.bodies.verdict import Verdict
    from satcheck.core.curved.signed import Signed


class Depth(Struct, frozen=True):
    """World units: lower <= true depth <= upper.

    normal: unit, from A to B, along which A retreats; escape: the translation that was verified,
    which may be longer than the depth by what verification asked for. witness: with
    witness_b - witness_a = -upper * normal to rounding, known for convex pairs.
    """

    lower: float
    upper: float
    normal: Vector
    escape: Escape
    witness: Witness | None = None


def measure_depth(pair: Pair, verdict: Verdict, move: Vector | None, trace: Trace) -> Depth:
    """The depth of an overlapping pair: exact for convex ones, an interval for the others.

    move: a translation of A within the touch band that is known to free it.
    """
    if verdict.signed_distance is not None:
        return _convex_depth(pair, verdict.signed_distance, trace)
    if pair.curved:
        from satcheck.audit.figures.curved import sandwiched_depth

        return sandwiched_depth(pair, move, trace)
    from satcheck.audit.figures.concave_depth import concave_depth, depth_by_move

    if move is not None:
        return depth_by_move(pair, verdict, move, trace)
    return concave_depth(pair, verdict, trace)


def _convex_depth(pair: Pair, result: core.PairResult | Signed, trace: Trace) -> Depth:
    if result.distance is None or result.normal is None:
        raise AssertionError("a penetrating pair has a signed distance and a normal")
    value = max(-result.distance, 0.0)
    escape = verified_escape(pair, value, result.normal, trace)
    lower = value if result.upper is None else min(max(0.0, -result.upper), value)
    upper = escape.bound if result.lower is None else -result.lower
    if pair.curved:
        upper = min(upper, escape.bound)
    elif frees_boxes(pair, value, result.normal):
        upper = value
    witness = None
    if result.witness_a is not None and result.witness_b is not None:
        witness = Witness(result.witness_a, result.witness_b)
    return Depth(lower, max(upper, value), result.normal, escape, witness)


def frees_boxes(pair: Pair, length: float, normal: Vector) -> bool:
    """Whether a translation of A along an axis, as long as that and without any rounding, takes its
    world box off that of B. Then it bounds the depth whichever body is moved."""
    axes = [axis for axis in range(3) if normal[axis]]
    if len(axes) != 1 or abs(normal[axes[0]]) != 1.0:
        return False
    axis = axes[0]
    ahead, behind = (pair.b, pair.a) if normal[axis] > 0 else (pair.a, pair.b)
    return math.fsum((behind.bounds[1][axis], -ahead.bounds[0][axis], -length)) <= 0
