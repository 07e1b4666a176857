"""Translations that separate two bodies, of which at least one is a curved shape."""

from __future__ import annotations

import math

from satcheck.core.conventions import Vector
from satcheck.core.curved.exact.pair import proven
from satcheck.core.curved.in_mesh import is_free
from satcheck.core.curved.placed import Body, CurvedShape, is_convex
from satcheck.core.curved.signed import convex_pair
from satcheck.core.curved.triangles import FEW, against_triangles


def frees(a: Body, b: Body, move: Vector) -> bool:
    """Whether A, moved, provably has no common interior with B."""
    if is_convex(a) and is_convex(b):
        bounds = convex_pair(a, b, move)
        if bounds is None or bounds.exact or bounds.lower >= 0:
            return bounds is not None and bounds.lower >= 0
        return proven(a, b, bounds, move)[0].lower >= 0
    curved, mesh, sign = sides(a, b)
    return is_free(curved.moved((sign * move[0], sign * move[1], sign * move[2])), mesh)


def sides(a: Body, b: Body) -> tuple[CurvedShape, Body, float]:
    """(the curved body, the other body, +1 if A is the curved one, else -1)."""
    if a.curved is not None:
        return a.curved, b, 1.0
    assert b.curved is not None
    return b.curved, a, -1.0


def move_off(a: Body, b: Body, most: float, pad: float) -> Vector | None:
    """A translation of A, no longer than `most`, that provably frees it. It leads away from the
    triangle with the deepest overlap. pad: an extra length that covers rounding. None: not found,
    usually because the shape penetrates several faces."""
    curved, mesh, sign = sides(a, b)
    few = against_triangles(curved, mesh.mesh, 0.0, FEW).nearest
    if few is not None and -few.lower > most:  # one of them is deeper
        return None
    nearest = against_triangles(curved, mesh.mesh, 0.0).nearest
    if nearest is None or nearest.normal is None:
        return None
    for longer in (0.0, pad):
        length = -sign * (longer - min(nearest.lower, 0.0))
        x, y, z = nearest.normal
        move = length * x + 0.0, length * y + 0.0, length * z + 0.0  # + 0.0: no negative zero
        if 0 < math.hypot(*move) <= most and frees(a, b, move):
            return move
    return None
