"""The point where two bodies meet, in the pose of their first overlap."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from satcheck import core
from satcheck.audit.figures.thickness import why_not_thick

if TYPE_CHECKING:
    from satcheck.audit.bodies.pair import Pair
    from satcheck.core.conventions import Vector

# The point is the centre of a ball in both bodies. The search ends once the thickest ball is at
# most twice as thick, so that it is a ball of the impact, not of a contact before it. Or it ends
# after this work, less than a tenth of a second after its preparation.
COARSE = 0.5
WORK = 10_000_000


def impact_point(placed: Pair, moved: float) -> Vector | None:
    """A world point of both bodies, which overlap as they are placed.

    Of closed meshes it is the centre of a ball that is proven to lie in both, if a short search
    finds one. Else, and of other meshes, it is a common point, rounded: of the surfaces, or of one
    surface and the inside of the other body. Of curved shapes it is at most the tolerance and
    `moved` away from both. moved: how far the bodies moved since they did not overlap. None: no
    point is known.
    """
    if placed.curved:
        return _between_witnesses(placed, moved)
    a, b = placed.a.surface(), placed.b.surface()
    if why_not_thick(placed) is None:
        thick = core.search_thickness(a, b, width=COARSE, work=WORK)
        if thick.centre is not None and thick.lower > 0:
            return thick.centre
    return core.mesh_relation(a, b).point


def _between_witnesses(placed: Pair, moved: float) -> Vector | None:
    """The middle between the deepest points of two bodies, one of them a curved shape."""
    from satcheck.core.curved.freeing import sides
    from satcheck.core.curved.placed import is_convex
    from satcheck.core.curved.signed import convex_pair
    from satcheck.core.curved.triangles import against_triangles

    if is_convex(placed.a) and is_convex(placed.b):
        signed = convex_pair(placed.a, placed.b)
    else:
        curved, mesh, _ = sides(placed.a, placed.b)
        signed = against_triangles(curved, mesh.mesh, 0.0).nearest
    if signed is None or signed.witness_a is None or signed.witness_b is None:
        return None
    off = 0.5 * math.dist(signed.witness_a, signed.witness_b)
    if off > moved + 0.5 * placed.tolerance:  # the other half of the tolerance is for rounding
        return None
    x, y, z = (0.5 * (p + q) for p, q in zip(signed.witness_a, signed.witness_b, strict=True))
    return x, y, z
