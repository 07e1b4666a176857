"""Contacts of balls: with a mesh, and with each other.

A ball has one contact for each nearest point of the other surface, so it needs no tolerance of
place: its normal is the line to its centre.
"""

from __future__ import annotations

import numpy as np

from satcheck.audit.statics.contacts import NOBODY, Points, extreme, nearest_on_triangles
from satcheck.audit.statics.features import Features
from satcheck.audit.statics.near import Floats


def ball_on_mesh(
    centre: Floats, radius: float, mesh: Features, tolerance: float, rounding: float
) -> Points:
    """The contacts of a ball (A) with a mesh (B), whose surface the centre is outside of."""
    corners = mesh.corners
    reach = radius + tolerance
    low, high = corners.min(axis=1), corners.max(axis=1)
    near = np.flatnonzero(((low <= centre + reach) & (high >= centre - reach)).all(axis=1))
    if not near.size:
        return NOBODY
    foot = nearest_on_triangles(np.broadcast_to(centre, (near.size, 3)), corners[near])
    step = centre - foot
    distance = np.linalg.norm(step, axis=1)
    outside = np.einsum("ci,ci->c", step, mesh.normals[near]) > 0
    kept = (np.abs(distance - radius) <= tolerance) & outside & (distance > 0)
    near, foot, step, distance = near[kept], foot[kept], step[kept], distance[kept]
    n = step / distance[:, None]
    # A foot on an edge or a vertex is nearest only if all faces there lie behind the normal.
    behind = np.ones(near.size, dtype=bool)
    for k in range(near.size):
        shares = np.linalg.norm(foot - foot[k], axis=1) <= rounding
        heights = np.einsum("tci,i->tc", corners[near[shares]] - foot[k], n[k])
        behind[k] = heights.max() <= 2 * rounding
    return extreme(_strict(foot[behind], n[behind], distance[behind] - radius), rounding)


def ball_on_ball(
    centre: Floats, radius: float, other: Floats, other_radius: float, tolerance: float
) -> Points:
    """The contact of two balls, the first of which is A."""
    step = centre - other
    distance = float(np.linalg.norm(step))
    height = distance - radius - other_radius
    if abs(height) > tolerance or distance == 0:
        return NOBODY
    n = step / distance
    at = other + n * (other_radius + 0.5 * height)
    return _strict(at[None], n[None], np.array([height]))


def _strict(at: Floats, normals: Floats, heights: Floats) -> Points:
    return Points(at, normals, heights, np.ones(len(at), dtype=bool))
