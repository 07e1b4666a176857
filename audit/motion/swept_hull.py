"""Contact of solids that slide along a line, as a slider in its slot. No translation may free them.

While A moves along a line relative to B, it stays within the convex hull of its first and its last
place. If this hull, made a little smaller, has no common interior with B, then no ball thicker than
the touch band lies in both bodies at any time between. The overlap is then within the band, as for
bodies at rest (docs/thickness.md).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck import core
from satcheck.audit.figures.escape import FREE
from satcheck.audit.motion.limits import SLIDES
from satcheck.audit.vectors import scaled
from satcheck.core.conventions import Vector

if TYPE_CHECKING:
    from satcheck.audit.bodies.placed_body import PlacedBody
    from satcheck.audit.motion.moving_pair import MovingPair

# What a body has to keep of its size without the margin. A smaller one may lie in the other body.
LEAST_REST = 0.5


def safe_slide(pair: MovingPair, t: float, end: float) -> float:
    """The time after t for which the bodies overlap by no more than the touch band. end: in the
    same piece of steady motion. 0.0: not proven."""
    velocity = _velocity(pair, t)
    if velocity is None:
        return 0.0
    placed = pair.placed(t)
    margin = 0.5 * pair.tolerance - pair.pad
    for body, other, way in ((placed.a, placed.b, 1.0), (placed.b, placed.a, -1.0)):
        spans = [(end - t) * 0.5**k for k in range(SLIDES)]
        # A body that overlaps the other where it stands is rejected after one test.
        if not _sweeps_free(body, other, scaled(velocity, way * spans[-1]), margin):
            continue
        for span in spans:
            if _sweeps_free(body, other, scaled(velocity, way * span), margin):
                return span
    return 0.0


def _velocity(pair: MovingPair, t: float) -> Vector | None:
    """Of A relative to B, per unit of t; None: a body turns, or has no inside, or both are convex,
    so that their signed distance says more."""
    bodies = pair.pair
    if pair.convex or bodies.curved or not (bodies.a.solid and bodies.b.solid):
        return None
    a, b = pair.track_a.piece_at(t), pair.track_b.piece_at(t)
    if a.degrees or b.degrees:
        return None
    x, y, z = (p - q for p, q in zip(a.velocity, b.velocity, strict=True))
    return x, y, z


def _sweeps_free(body: PlacedBody, other: PlacedBody, step: Vector, margin: float) -> bool:
    """Whether the hull of the body here and after the step, without its outermost `margin`, has no
    common interior with the other body."""
    swept = _smaller(_hull_of_both(body.hull(), step), margin)
    if swept is None:
        return False
    relation = core.mesh_relation(swept, other.surface())
    return relation.proven and relation.relation in FREE


def _hull_of_both(hull: core.Polytope, step: Vector) -> core.Mesh:
    import numpy as np

    corners, triangles = hull.vertices, hull.triangles
    both = core.Mesh(
        np.vstack((corners, corners + np.array(step))),
        np.vstack((triangles, triangles + np.uint32(len(corners)))),
    )
    return both.convex_hull().to_mesh()


def _smaller(hull: core.Mesh, margin: float) -> core.Surface | None:
    """The hull, scaled about its centre. The corner farthest from the centre moves by the margin.
    No plane of a face is farther from the centre, so none moves by more, and every point that lies
    deeper than the margin stays inside. None: the hull is hardly larger than the margin."""
    import numpy as np

    corners = hull.vertices
    centre = corners.mean(axis=0)
    from_centre = corners - centre
    factor = 1.0 - margin / float(np.linalg.norm(from_centre, axis=1).max())
    if factor < LEAST_REST:
        return None
    return core.Surface(core.Mesh(centre + factor * from_centre, hull.triangles), True)
