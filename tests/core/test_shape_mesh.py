"""Meshes of shapes."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from satcheck.core import Surface
from satcheck.core.shape_mesh import mesh_around, mesh_of, sag_of
from satcheck.core.shapes import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Primitive,
    Sphere,
    is_curved,
    support,
)
from satcheck.scene.inspect import examine

BOX = Box((1.0, 2.0, 3.0))
CURVED: dict[Primitive, tuple[float, Callable[..., float], tuple[float, ...]]] = {
    # shape: (volume, the function that is 0 on its surface, half its extents)
    Sphere(0.3): (4 / 3 * math.pi * 0.3**3, lambda x, y, z: math.hypot(x, y, z) - 0.3, (0.3,) * 3),
    Capsule(0.3, 1.1): (
        math.pi * 0.3**2 * (1.1 + 4 / 3 * 0.3),
        lambda x, y, z: math.hypot(x, y, max(0.0, abs(z) - 0.55)) - 0.3,
        (0.3, 0.3, 0.3 + 1.1 / 2),
    ),
    Cylinder(0.7, 1.3): (
        math.pi * 0.7**2 * 1.3,
        lambda x, y, z: max(math.hypot(x, y) - 0.7, abs(z) - 0.65),
        (0.7, 0.7, 0.65),
    ),
    Cone(1.1, 3.0): (
        math.pi * 1.1**2,
        lambda x, y, z: max(math.hypot(x, y) - 1.1 * (1.5 - z) / 3.0, -1.5 - z),
        (1.1, 1.1, 1.5),
    ),
    Ellipsoid((1.0, 2.0, 0.7)): (
        4 / 3 * math.pi * 1.4,
        lambda x, y, z: math.hypot(x, y / 2.0, z / 0.7) - 1.0,
        (1.0, 2.0, 0.7),
    ),
}
SEGMENTS = 64
# A coordinate is made in at most 4 roundings from numbers below 2, a distance to the surface in as
# many again.
ROUNDING = 8 * 2 * 2.0**-53


def test_a_box_is_its_mesh() -> None:
    mesh = mesh_of(BOX)
    assert (mesh.vertex_count, mesh.triangle_count) == (8, 12)
    assert mesh.bounds == ((-0.5, -1.0, -1.5), (0.5, 1.0, 1.5))
    assert examine(mesh).health.volume == 6.0
    assert not is_curved(BOX)


@pytest.mark.parametrize("shape", [BOX, *CURVED], ids=str)
def test_a_mesh_is_closed_outward_and_convex(shape: Primitive) -> None:
    found = examine(mesh_of(shape, SEGMENTS))
    health = found.health
    assert (health.solid, health.manifold, health.oriented, health.inside_out) == (
        True,
        True,
        True,
        False,
    )
    assert health.volume > 0
    assert found.warnings == ()
    assert found.mesh.convexity_defect(0.0) == 0.0
    assert Surface(found.mesh, True).winding_number((0.0, 0.0, 0.0)) == 1


@pytest.mark.parametrize("shape", CURVED, ids=str)
def test_the_vertices_of_a_curved_shape_lie_on_its_surface(shape: Primitive) -> None:
    volume, surface, half = CURVED[shape]
    mesh = mesh_of(shape, SEGMENTS)
    corners = {c for t in range(mesh.triangle_count) for c in mesh.corners(t)}
    assert max(abs(surface(*corner)) for corner in corners) <= ROUNDING
    assert mesh.bounds == (tuple(-c for c in half), half)
    # A facet of a ball spans at most the angle of a segment either way, so its corners are within
    # half a diagonal of its normal, and no facet is nearer to the centre than the cosine of that.
    nearest = math.cos(math.tau / SEGMENTS / math.sqrt(2.0))
    assert nearest**3 < examine(mesh).health.volume / volume < 1.0
    assert is_curved(shape)


def test_more_segments_fill_more_of_it() -> None:
    volumes = [examine(mesh_of(Sphere(1.0), n)).health.volume for n in (8, 16, 32)]
    assert volumes == sorted(volumes)


@pytest.mark.parametrize("segments", [0, 4, 10, -8])
def test_segments_that_miss_the_axes_are_refused(segments: int) -> None:
    with pytest.raises(ValueError, match="multiple of 4"):
        mesh_of(Sphere(1.0), segments)


@pytest.mark.parametrize("segments", [8, 16, 64])
@pytest.mark.parametrize(
    "shape",
    [
        Sphere(2.0),
        Capsule(0.5, 3.0),
        Cylinder(1.5, 4.0),
        Cone(2.0, 1.0),
        Ellipsoid((3.0, 1.0, 0.2)),
    ],
)
def test_the_sag_bounds_how_far_a_shape_is_off_its_mesh(shape: Primitive, segments: int) -> None:
    """Convex bodies one in the other are as far apart as their supports, where that is the most."""
    vertices = np.asarray(mesh_of(shape, segments).vertices)
    directions = np.random.default_rng(1).normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    around = np.array([support(shape, tuple(d)) for d in directions.tolist()])
    off = around - (directions @ vertices.T).max(axis=1)
    assert 0.25 * sag_of(shape, segments) < off.max() <= sag_of(shape, segments)


def test_the_mesh_around_a_shape_is_made_once() -> None:
    """A robot in many poses asks for the same few."""
    assert mesh_around(Cylinder(0.2, 0.7)) is mesh_around(Cylinder(0.2, 0.7))
    assert mesh_around(Cylinder(0.2, 0.8)) is not mesh_around(Cylinder(0.2, 0.7))
