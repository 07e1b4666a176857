"""Bounds over many triangles, and triangles that bound nothing."""

from __future__ import annotations

import math

import numpy as np

from satcheck import core
from satcheck.core.curved.exact.pair import refined
from satcheck.core.curved.placed import CurvedShape, curved_shape
from satcheck.core.curved.signed import AT_ORIGIN, signed
from satcheck.core.curved.triangles import against_triangles
from satcheck.core.shapes import Cone
from tests.core.curved.bodies import tilted

SIDES = 6


def fan(curved: CurvedShape, rng: np.random.Generator) -> core.Mesh:
    """Six triangles about a corner that hangs 1e-13 to 1e-11 over the shape, open away from it."""
    way = rng.normal(size=3)
    far = core.Hull(np.array([5.0 * way / np.linalg.norm(way)]))
    found = core.check_pair(curved.shape, far, curved.pose, AT_ORIGIN, query="distance")
    normal, foot = np.array(found.normal), np.array(found.witness_a)
    across = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    across /= np.linalg.norm(across)
    corner = foot + normal * 10.0 ** rng.uniform(-13.0, -11.0)
    ring = [
        corner
        + 2.0 * (math.cos(angle) * across + math.sin(angle) * np.cross(normal, across))
        + rng.uniform(0.02, 1.0) * normal
        for angle in np.arange(SIDES) * (2.0 * math.pi / SIDES)
    ]
    faces = [(0, 1 + k, 1 + (k + 1) % SIDES) for k in range(SIDES)]
    return core.Mesh(np.array([corner, *ring]), np.array(faces, dtype=np.uint32))


def test_bounds_hold_for_all_triangles() -> None:
    rng = np.random.default_rng(5)
    misled = 0
    for degrees in range(1, 90, 2):
        curved = curved_shape(Cone(1.0, 2.0), tilted(degrees, 0.0, 0.0, 0.0))
        mesh = fan(curved, rng)
        alone = [
            signed(
                core.check_pair(
                    curved.shape,
                    core.Hull(np.asarray(mesh.vertices)[face]),
                    curved.pose,
                    AT_ORIGIN,
                    query="depth",
                ),
                curved.slack,
            )
            for face in mesh.triangles
        ]
        known = [one for one in alone if one is not None]
        assert len(known) == SIDES
        corners = np.asarray(mesh.vertices)[mesh.triangles]
        left = [k for k, one in enumerate(known) if not one.exact]
        if left:
            of_left = refined(curved.image, corners[left], [known[k] for k in left])
            known = [of_left[left.index(k)] if k in left else one for k, one in enumerate(known)]
        nearest = against_triangles(curved, mesh, 0.1).nearest
        assert nearest is not None
        assert nearest.lower == min(one.lower for one in known)
        assert nearest.upper == min(one.upper for one in known)
        apart = all(one.outcome == "separated" for one in known)
        assert (nearest.outcome == "separated") == apart
        misled += min(known, key=lambda one: one.distance).lower > nearest.lower
    assert misled > 0
