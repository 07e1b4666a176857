"""How deep two bodies with a common interior overlap, and the way out for A.

A way out is verified: it is applied to the mesh, and the moved mesh is checked exactly.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck import core
from satcheck.audit.body import box_escape
from satcheck.audit.draft import Depth, Draft, Escape
from satcheck.audit.pair import Pair
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.report.report import Vector, Witness

if TYPE_CHECKING:
    from collections.abc import Iterator

    from satcheck.core.curved.signed import Signed


def measure_depth(draft: Draft, move: Vector | None) -> Depth:
    """The depth of an overlapping pair: exact for convex ones, an interval for the others.

    move: a translation of A within the touch band that is known to free it.
    """
    pair = draft.pair
    if draft.signed is not None and draft.signed.normal is None:
        from satcheck.core.curved.signed import convex_pair

        draft.signed = convex_pair(pair.a, pair.b)
    if draft.signed is not None:
        return _convex_depth(draft, draft.signed)
    if pair.curved:
        from satcheck.audit.stages.curved import sandwiched_depth

        return sandwiched_depth(draft, move)
    from satcheck.audit.stages.concave_depth import concave_depth, depth_by_move

    if move is not None:
        return depth_by_move(draft, move)
    return concave_depth(draft)


def _convex_depth(draft: Draft, result: core.PairResult | Signed) -> Depth:
    pair = draft.pair
    if result.distance is None or result.normal is None:
        raise AssertionError("a penetrating pair has a signed distance and a normal")
    value = max(-result.distance, 0.0)
    escape = verified_escape(draft, value, result.normal)
    lower = value if result.upper is None else min(max(0.0, -result.upper), value)
    upper = escape.bound if result.lower is None else -result.lower
    if pair.curved:
        upper = min(upper, escape.bound)
    elif frees_boxes(pair, value, result.normal):
        upper = value
    witness = None
    if result.witness_a is not None and result.witness_b is not None:
        witness = Witness(result.witness_a, result.witness_b)
    return Depth(lower, max(upper, value), escape, witness)


def frees_boxes(pair: Pair, length: float, normal: Vector) -> bool:
    """Whether a translation of A along an axis, as long as that and without any rounding, takes its
    world box off that of B. Then it bounds the depth whichever body is moved."""
    axes = [axis for axis in range(3) if normal[axis]]
    if len(axes) != 1 or abs(normal[axes[0]]) != 1.0:
        return False
    axis = axes[0]
    ahead, behind = (pair.b, pair.a) if normal[axis] > 0 else (pair.a, pair.b)
    return math.fsum((behind.bounds[1][axis], -ahead.bounds[0][axis], -length)) <= 0


FREE = frozenset({"separated", "touching"})

# By how much an MTV may be lengthened until the moved mesh is free, in ulps of the largest
# coordinate of the pair. The first step covers another order of rounding. Each step is four times
# longer than the last. The longest is about 1e-9 of the size.
LENGTHENING_ULPS = (4, 16, 64, 256, 1024, 4096, 16384, 65536, 262144, 1048576, 4194304)
# Decimals to which the way into a fit is rounded, after the first digit of its largest component. A
# search goes 1e-10 of it too far.
_DECIMALS = (9, 7, 5, 4, 3, 2, 1, 0)


def verified_escape(
    draft: Draft, length: float, normal: Vector, found: Vector | None = None
) -> Escape:
    """The shortest accepted translation along -normal, at least `length` long.

    found: that of a search, from which both follow but for rounding. Where no longer one is free,
    as in a hole into which A just fits, it is taken as it is, or else in fewer decimals: only a way
    that rounds no coordinate may stay in the plane in which A fits.

    The nominal length is tried only where adding it to A's coordinates rounds nothing; elsewhere a
    few ulps are added at once, so that another program's order of rounding separates too. The
    nominal length comes back unverified when the ladder is capped below the hulls or nothing helps.
    """
    pair = draft.pair
    if not pair.may("hull"):
        draft.record("verify", "not asked", "the capped ladder has nothing to verify with")
        return Escape(against(normal, length), normal, False, math.inf)
    ulp = 2 * UNIT_ROUNDOFF * (pair.largest_coordinate + length)
    steps = (0, *LENGTHENING_ULPS) if adds_exactly(pair, length, normal) else LENGTHENING_ULPS
    for step in steps:
        mtv = against(normal, length + step * ulp)
        relation = relation_after(pair, mtv)
        if relation in FREE:
            longer = f", lengthened by {step} units in the last place" if step else ""
            draft.record("verify", relation, f"A moved by its MTV{longer}")
            bound = length if step == 0 else length + (step + 2) * ulp
            return Escape(mtv, normal, True, bound)
    for way in () if found is None else _in_fewer_decimals(found):
        if (relation := relation_after(pair, way)) in FREE:
            draft.record("verify", relation, "A moved by its MTV; a longer one is not free")
            length, normal = length_and_normal(way)
            return Escape(way, normal, True, length + 2 * ulp)
    most = f"{LENGTHENING_ULPS[-1]} units in the last place"
    draft.record("verify", "failed", f"still not free when the MTV is lengthened by {most}")
    return Escape(against(normal, length), normal, False, math.inf)


def _in_fewer_decimals(way: Vector) -> Iterator[Vector]:
    """Yield a translation as it is, then rounded to ever fewer decimals."""
    places = -math.floor(math.log10(max(map(abs, way))))
    last = way
    yield way
    for decimals in _DECIMALS:
        x, y, z = (round(c, places + decimals) + 0.0 for c in way)
        if (x, y, z) != last:
            last = x, y, z
            yield last


def length_and_normal(translation: Vector) -> tuple[float, Vector]:
    """Return its length and the direction against it; both exact along an axis."""
    length = math.hypot(*translation)
    x, y, z = (0.0 - c / length for c in translation)
    return length, (x, y, z)


def relation_after(pair: Pair, translation: Vector) -> str:
    """The relation once A's world mesh is moved: of the triangles, or of the hulls under a cap."""
    if pair.curved:
        from satcheck.core.curved.freeing import frees

        return "separated" if frees(pair.a, pair.b, translation) else "penetrating"
    if pair.may("exact"):
        try:
            surface = pair.a.surface().translated(translation)
        except ValueError:  # rounding has made one point of several: no longer the same solid
            return "unproven"
        result = core.mesh_relation(surface, pair.b.surface(), steps=pair.steps_for_moves)
        pair.moved_steps += result.steps
        return result.relation if result.proven else "unproven"
    moved = core.Hull(pair.a.mesh.translated(translation).convex_hull())
    return core.check_pair(moved, pair.b.hull_shape(), query="overlap").outcome


def against(normal: Vector, length: float) -> Vector:
    """Return the translation of this length against the normal."""
    # Adding 0.0 turns a negative zero into zero.
    return -length * normal[0] + 0.0, -length * normal[1] + 0.0, -length * normal[2] + 0.0


def adds_exactly(pair: Pair, length: float, normal: Vector) -> bool:
    """Whether any program that moves A by this lands on the same coordinates.

    So when both poses round each coordinate once, whatever the order of their sums, the translation
    runs along one axis, and A's outermost coordinates take it exactly.
    """
    if not (rounds_once(pair.a.body.transform) and rounds_once(pair.b.body.transform)):
        return False
    if sorted(abs(c) for c in normal) != [0.0, 0.0, 1.0]:
        return False
    axis = [abs(c) for c in normal].index(1.0)
    shift = -length * normal[axis]
    ends = (pair.a.bounds[0][axis], pair.a.bounds[1][axis])
    return all((end + shift) - end == shift and (end + shift) - shift == end for end in ends)


def rounds_once(transform: tuple[float, ...] | None) -> bool:
    """Whether each row has one factor, a power of two: then only adding its translation rounds."""
    if transform is None:
        return True
    rows = [[c for c in transform[4 * row : 4 * row + 3] if c != 0] for row in range(3)]
    return all(len(row) == 1 and abs(math.frexp(row[0])[0]) == 0.5 for row in rows)


class WayOut(Struct, frozen=True):
    """length: of the nominal translation along -normal; upper: that length rounded outward; by:
    the shapes that it frees."""

    length: float
    upper: float
    normal: Vector
    by: str


def way_out_of_hulls(pair: Pair) -> WayOut:
    """A translation that frees A for certain: out of B's hull, or of B's box if the ladder ends
    there."""
    length, normal = box_escape(pair.a.bounds, pair.b.bounds)
    boxes = WayOut(length, length, normal, "world boxes")
    if not pair.may("hull"):
        return boxes
    hulls = core.hull_depth(pair.a.geometry, pair.b.geometry, pair.alone)
    if hulls.distance is None or hulls.lower is None or hulls.normal is None:
        return boxes
    if hulls.outcome == "touching":
        return WayOut(0.0, 0.0, hulls.normal, "hulls of the whole meshes")
    if hulls.outcome != "penetrating":
        return boxes
    return WayOut(-hulls.distance, -hulls.lower, hulls.normal, "hulls of the whole meshes")


def gap_around(draft: Draft) -> float:
    """A lower bound of the depth of nested bodies: the inner body is not free before the surfaces
    meet. 0.0 for other pairs."""
    pair = draft.pair
    if draft.exact not in ("contains", "inside"):
        return 0.0
    climb = draft.climb
    if climb is not None and climb.relation == draft.exact and climb.least_depth is not None:
        return climb.least_depth  # no triangles of nested bodies cross
    return core.nested_depth(pair.a.geometry, pair.b.geometry)
