"""Find a free place for one body among others, for when pushing does not help.

Each body is taken as a discrete-orientation polytope: Klosowski et al., "Efficient Collision
Detection Using Bounding Volume Hierarchies of k-DOPs" (1998), with 26 planes. Along a ray of
translations two such polytopes overlap in one interval, so the first point outside of all intervals
is certainly free. A shorter free translation may exist.
"""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import numpy.typing as npt

from satcheck.audit.body import PlacedBody
from satcheck.core.conventions import Vector
from satcheck.core.half_space import plane_of
from satcheck.core.rounding import rounding_pad

Array = npt.NDArray[np.float64]

# One of each opposite pair of directions to the faces, edges and corners of a cube.
AXES = np.array(
    [
        np.array(way) / math.sqrt(sum(map(abs, way)))
        for way in product((-1, 0, 1), repeat=3)
        if way > (0, 0, 0)
    ]
)
RAYS = np.concatenate([AXES, -AXES])
# The cosine of the angle between an axis and a normal that count as parallel.
PARALLEL = 1 - 1e-12


def extents(body: PlacedBody) -> Array:
    """(2, axes): the lowest and the highest projections on the axes. A half space ends along its
    normal alone."""
    along = body.mesh.vertices @ AXES.T
    low, high = along.min(axis=0), along.max(axis=0)
    if body.endless:
        up = AXES @ np.array(plane_of(body.body.transform).unit)
        low, high = np.where(up < -PARALLEL, low, -np.inf), np.where(up > PARALLEL, high, np.inf)
    return np.stack([low, high])


def free_place(body: Array, others: Array, gaps: Array, longest: float) -> Vector | None:
    """Return a translation of the body, of at most `longest`, that keeps a gap from each other one.
    None: no ray has one.

    body: its extents. others: (bodies, 2, axes). gaps: (bodies,).
    """
    reach = np.abs(np.concatenate([body.ravel(), others.ravel()]))
    pad = gaps[:, None] + 2 * rounding_pad(float(reach.max(where=np.isfinite(reach), initial=0.0)))
    # It overlaps another one at s along a ray while below < s * rate < above on each axis.
    below, above = others[:, 0] - pad - body[1], others[:, 1] + pad - body[0]
    ways = [(_first_free(*_blocked(below, above, AXES @ ray)), ray) for ray in RAYS]
    length, ray = min(ways, key=lambda way: way[0])
    if length > longest or math.isinf(length):
        return None
    x, y, z = (length * ray).tolist()
    return x, y, z


def _blocked(below: Array, above: Array, rates: Array) -> tuple[Array, Array]:
    """(starts, ends) of the interval of a ray that each body blocks. rates: how fast a point of the
    ray moves along each axis."""
    level = np.abs(rates) < 1e-12
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = below / rates, above / rates
    meets = (below < 0) & (above > 0)
    start = np.where(level, np.where(meets, -np.inf, np.inf), np.minimum(*ends))
    stop = np.where(level, np.where(meets, np.inf, -np.inf), np.maximum(*ends))
    return start.max(axis=1), stop.min(axis=1)


def _first_free(start: Array, stop: Array) -> float:
    """Return the least s >= 0 outside of all intervals; inf: an interval has no end."""
    blocked = (start < stop) & (stop > 0)
    at = 0.0
    for low, high in sorted(zip(start[blocked].tolist(), stop[blocked].tolist(), strict=True)):
        if low >= at:
            break
        at = max(at, high)
    return at
