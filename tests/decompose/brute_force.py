"""Distances and insides of meshes by dense sampling: slow, and sharing no code with the product."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satcheck.core import Mesh

Floats = NDArray[np.float64]


def surface_samples(mesh: Mesh, steps: int) -> Floats:
    """A triangular grid of points on every triangle, corners included; each point once."""
    shares = [(i, j, steps - i - j) for i in range(steps + 1) for j in range(steps + 1 - i)]
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    points = np.einsum("gc,tcx->tgx", np.array(shares) / steps, corners).reshape(-1, 3)
    return np.unique(points, axis=0)


def winding(points: Floats, mesh: Mesh) -> Floats:
    """Sum of solid angles over 4 pi.

    Adriaan van Oosterom, Jan Strackee, "The Solid Angle of a Plane Triangle" (1983).
    """
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    totals = []
    for point in points:
        a, b, c = np.moveaxis(corners - point, 1, 0)
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        numerator = (a * np.cross(b, c)).sum(axis=1)
        denominator = la * lb * lc
        for u, v, length in ((a, b, lc), (b, c, la), (c, a, lb)):
            denominator = denominator + (u * v).sum(axis=1) * length
        totals.append(2.0 * np.arctan2(numerator, denominator).sum() / (4.0 * np.pi))
    return np.array(totals)


def surface_distance(points: Floats, mesh: Mesh) -> Floats:
    """From each point to the nearest triangle: over its plane, its edges and its corners."""
    a, b, c = np.moveaxis(np.asarray(mesh.vertices)[np.asarray(mesh.triangles)], 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    distances = []
    for point in points:
        height = ((point - a) * normal).sum(axis=1)
        foot = point - height[:, None] * normal
        above = np.ones(len(a), dtype=bool)
        nearest = np.full(len(a), np.inf)
        for tail, head in ((a, b), (b, c), (c, a)):
            along = head - tail
            above &= (np.cross(along, foot - tail) * normal).sum(axis=1) >= 0.0
            share = ((point - tail) * along).sum(axis=1) / (along * along).sum(axis=1)
            on_edge = tail + np.clip(share, 0.0, 1.0)[:, None] * along
            nearest = np.minimum(nearest, np.linalg.norm(point - on_edge, axis=1))
        distances.append(np.where(above, np.abs(height), nearest).min())
    return np.array(distances)


def solid_distance(points: Floats, mesh: Mesh) -> Floats:
    """0 inside."""
    distances: Floats = np.where(winding(points, mesh) > 0.5, 0.0, surface_distance(points, mesh))
    return distances
