"""The check of an MTV: it is applied to the mesh, and the moved mesh is checked exactly."""

from __future__ import annotations

import math

from msgspec import Struct

from satcheck import core
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.request.trace import Trace
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.report.report import Vector

FREE = frozenset({"separated", "touching"})

# By how much an MTV may be lengthened until the moved mesh is free, in ulps of the largest
# coordinate of the pair. The first step covers another order of rounding. Each step is four times
# longer than the last. The longest is about 1e-9 of the size.
LENGTHENING_ULPS = (4, 16, 64, 256, 1024, 4096, 16384, 65536, 262144, 1048576, 4194304)


class Escape(Struct, frozen=True):
    """A translation of A, world units. verified: A's mesh, moved, has no common interior with B.

    bound: then an upper bound of the depth, its length plus the rounding of A's moved coordinates
    (0.0 where there is none); inf when not verified.
    """

    mtv: Vector
    verified: bool
    bound: float


def verified_escape(pair: Pair, length: float, normal: Vector, trace: Trace) -> Escape:
    """The shortest accepted translation along -normal, at least `length` long.

    The nominal length is tried only where adding it to A's coordinates rounds nothing; elsewhere a
    few ulps are added at once, so that another program's order of rounding separates too. The
    nominal length comes back unverified when the ladder is capped below the hulls or nothing helps.
    """
    if not pair.may("hull"):
        trace.record("verify", "not asked", "the capped ladder has nothing to verify with")
        return Escape(_along(normal, length), False, math.inf)
    ulp = 2 * UNIT_ROUNDOFF * (pair.largest_coordinate + length)
    steps = (0, *LENGTHENING_ULPS) if adds_exactly(pair, length, normal) else LENGTHENING_ULPS
    for step in steps:
        mtv = _along(normal, length + step * ulp)
        relation = relation_after(pair, mtv)
        if relation in FREE:
            longer = f", lengthened by {step} units in the last place" if step else ""
            trace.record("verify", relation, f"A moved by its MTV{longer}")
            return Escape(mtv, True, length if step == 0 else length + (step + 2) * ulp)
    most = f"{LENGTHENING_ULPS[-1]} units in the last place"
    trace.record("verify", "failed", f"still not free when the MTV is lengthened by {most}")
    return Escape(_along(normal, length), False, math.inf)


def relation_after(pair: Pair, translation: Vector) -> str:
    """The relation once A's world mesh is moved: of the triangles, or of the hulls under a cap."""
    if pair.curved:
        from satcheck.core.curved.freeing import frees

        return "separated" if frees(pair.a, pair.b, translation) else "penetrating"
    moved = pair.a.mesh.translated(translation)
    if pair.may("exact"):
        try:
            surface = pair.a.surface().refit(moved)
        except ValueError:  # rounding has made one point of several: no longer the same solid
            return "unproven"
        result = core.mesh_relation(surface, pair.b.surface())
        return result.relation if result.proven else "unproven"
    return core.check_pair(
        core.Hull(moved.convex_hull()), pair.b.hull_shape(), query="overlap"
    ).outcome


def _along(normal: Vector, length: float) -> Vector:
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
