"""Contact of bodies that slide along a line, as a slider in its slot. No direction of the contact
may free them.

While A moves along a line relative to B, it stays within the convex hull of its first and its last
place. The overlap stays within the touch band:

- if the hull, made a little smaller, has no common interior with the solid B. Then no ball thicker
  than the band lies in both bodies at any time, as for bodies at rest (docs/answers.md).
- if the hull overlaps that of B by no more than the band. The translation that ends this overlap
  ends every one on the way. This is asked of convex bodies and of sheets, for example of a spike
  that passes the tip of another one: their faces show no way off.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from satcheck import core
from satcheck.audit.motion.moving_pair import SLID, overlaps
from satcheck.audit.stages.depth import FREE
from satcheck.audit.vectors import scaled
from satcheck.core.conventions import Vector

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from satcheck.audit.body import PlacedBody
    from satcheck.audit.motion.moving_pair import MovingPair

# The hull is tried over the rest of a piece of the motion, and over so many parts of it, each half
# as long as the one before.
SLIDES = 8
# What a body has to keep of its size without the margin. A smaller one may lie in the other body.
LEAST_REST = 0.5


def safe_slide(pair: MovingPair, t: float, end: float) -> float:
    """The time after t for which the bodies overlap by no more than the touch band. end: in the
    same piece of steady motion. 0.0: not proven."""
    velocity = _velocity(pair, t)
    if velocity is None or (not pair.convex and _is_impact(pair, t, end)):
        return 0.0
    placed = pair.placed(t)
    a, b = placed.a, placed.b
    if pair.convex or not placed.both_solid:
        band = pair.tolerance - pair.pad
        return _longest(end - t, lambda s: _hulls_stay(a, b, scaled(velocity, s), band))
    margin = 0.5 * pair.tolerance - pair.pad
    span = _longest(end - t, lambda s: _sweeps_free(a, b, scaled(velocity, s), margin))
    return span or _longest(end - t, lambda s: _sweeps_free(b, a, scaled(velocity, -s), margin))


def _is_impact(pair: MovingPair, t: float, end: float) -> bool:
    """Whether the contact is so short that it counts as the start of an overlap. Most contacts are,
    and a hull costs more than this test."""
    speed = pair.fastest(t)
    soon = min(t + SLID * pair.tolerance / speed, end) if speed > 0.0 else end
    return overlaps(pair.found_at(soon))


def _longest(time: float, is_safe: Callable[[float], bool]) -> float:
    """The longest safe span of those that halve the time; 0.0: none. The shortest is asked first,
    because that rejects bodies which overlap where they stand."""
    spans = [time * 0.5**k for k in range(SLIDES)]
    return next(filter(is_safe, spans), 0.0) if is_safe(spans[-1]) else 0.0


def _velocity(pair: MovingPair, t: float) -> Vector | None:
    """Of A relative to B, per unit of t; None: a body turns, or is curved."""
    if pair.pair.curved:
        return None
    a, b = pair.velocities(t)
    if a is None or b is None:
        return None
    x, y, z = (p - q for p, q in zip(a, b, strict=True))
    return x, y, z


def _hulls_stay(a: PlacedBody, b: PlacedBody, step: Vector, band: float) -> bool:
    """Whether the hull of A here and after the step overlaps the hull of B by no more than the
    band."""
    swept = core.Hull(_both_ends(a.hull().vertices, step))
    lower = core.check_pair(swept, b.hull_shape(), query="depth").lower
    return lower is not None and lower >= -band


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
    faces = np.vstack((triangles, triangles + np.uint32(len(corners))))
    return core.Mesh(_both_ends(corners, step), faces).convex_hull().to_mesh()


def _both_ends(corners: NDArray[np.float64], step: Vector) -> NDArray[np.float64]:
    import numpy as np

    return np.vstack((corners, corners + np.array(step)))


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
