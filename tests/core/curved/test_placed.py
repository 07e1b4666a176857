"""Placing shapes: scaling folded in, poses, boxes around them; what is no such shape is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck.core.curved.placed import curved_shape
from satcheck.core.shape_mesh import mesh_around, mesh_of
from satcheck.core.shapes import Capsule, Cone, Cylinder, Ellipsoid, Primitive, Sphere, support
from tests.core.curved.bodies import moved, tilted

SHAPES: list[Primitive] = [
    Sphere(1.5),
    Capsule(0.5, 2.0),
    Cylinder(1.0, 3.0),
    Cone(1.0, 2.0),
    Ellipsoid((1.0, 2.0, 0.5)),
]


def scaled(a: float, b: float, c: float) -> tuple[float, ...]:
    return (a, 0, 0, 0, 0, b, 0, 0, 0, 0, c, 0, 0, 0, 0, 1)


@pytest.mark.parametrize(
    ("primitive", "by", "expected"),
    [
        (Sphere(2.0), (3.0, 3.0, 3.0), Sphere(6.0)),
        (Sphere(2.0), (1.0, 2.0, 3.0), Ellipsoid((2.0, 4.0, 6.0))),
        (Cylinder(1.0, 2.0), (2.0, 2.0, 5.0), Cylinder(2.0, 10.0)),
        (Cone(1.0, 2.0), (-2.0, 2.0, 5.0), Cone(2.0, 10.0)),
        (Ellipsoid((1.0, 2.0, 3.0)), (2.0, 3.0, 4.0), Ellipsoid((2.0, 6.0, 12.0))),
    ],
)
def test_scaling_is_folded_in(
    primitive: Primitive, by: tuple[float, float, float], expected: Primitive
) -> None:
    assert curved_shape(primitive, scaled(*by)).primitive == expected


@pytest.mark.parametrize(
    ("primitive", "transform"),
    [
        (Capsule(1.0, 2.0), scaled(2.0, 2.0, 1.0)),
        (Cylinder(1.0, 2.0), scaled(2.0, 1.0, 1.0)),
        (Cone(1.0, 2.0), scaled(2.0, 1.0, 1.0)),
        (Sphere(1.0), (1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)),
    ],
)
def test_what_is_no_such_shape_is_refused(
    primitive: Primitive, transform: tuple[float, ...]
) -> None:
    with pytest.raises(ValueError, match=r"shape|scaled"):
        curved_shape(primitive, transform)


@pytest.mark.parametrize("primitive", SHAPES)
def test_the_pose_puts_points_where_the_transform_does(primitive: Primitive) -> None:
    """The box around the placed shape holds the placed mesh, and is no wider than rounding and the
    facets of that mesh make it."""
    for degrees in (0.0, 30.0, 90.0, 123.0, 270.0):
        transform = tilted(degrees, 4.0, 5.0, 6.0)
        mirrored = tuple(-c if k % 4 == 1 and k < 12 else c for k, c in enumerate(transform))
        for placement in (transform, mirrored):
            low, high = curved_shape(primitive, placement).bounds()
            inner_low, inner_high = mesh_of(primitive).transformed(placement).bounds
            for axis in range(3):
                assert low[axis] <= inner_low[axis] <= low[axis] + 0.01
                assert high[axis] - 0.01 <= inner_high[axis] <= high[axis]


@pytest.mark.parametrize("primitive", SHAPES)
def test_support_against_many_points(primitive: Primitive) -> None:
    """Points of the surface reach as far as the support says, up to the mesh's facets."""
    vertices = np.asarray(mesh_of(primitive, 256).vertices)
    rng = np.random.default_rng(2)
    for direction in rng.normal(size=(50, 3)):
        direction /= np.linalg.norm(direction)
        reach = float((vertices @ direction).max())
        exact = support(primitive, tuple(direction))
        facet = 1 - math.cos(math.pi / 128)
        assert reach - 1e-12 <= exact <= reach + 2 * facet * 4


@pytest.mark.parametrize("primitive", SHAPES)
def test_the_mesh_around_a_shape_holds_it(primitive: Primitive) -> None:
    """Every face plane lies beyond the shape's support along its normal."""
    mesh = mesh_around(primitive)
    vertices = np.asarray(mesh.vertices)
    a, b, c = (vertices[np.asarray(mesh.triangles)[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    for normal, corner in zip(normals.tolist(), a.tolist(), strict=True):
        offset = math.fsum(n * p for n, p in zip(normal, corner, strict=True))
        assert support(primitive, tuple(normal)) < offset


def test_nothing_is_rounded_where_nothing_turns() -> None:
    assert curved_shape(Cylinder(1.0, 2.0), moved(0.1, 0.2, 0.3)).slack == 0.0
    assert curved_shape(Sphere(1.0), tilted(30.0, 0.1, 0.2, 0.3)).slack == 0.0
    assert curved_shape(Cylinder(1.0, 2.0), tilted(30.0, 0, 0, 0)).slack > 0.0


def test_a_turned_sphere_is_the_sphere() -> None:
    """Whatever the rotation rounds; another matrix makes of it what it is, exactly."""
    degrees = [k * 7.3 for k in range(50)]
    turned = [curved_shape(Sphere(1.5), tilted(d, 0.1, 0.2, 0.3)) for d in degrees]
    assert {(one.primitive, one.slack) for one in turned} == {(Sphere(1.5), 0.0)}
    assert len({one.image for one in turned}) == 1
    scaled = (3.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    assert curved_shape(Sphere(1.5), scaled).image.columns[0] == (3.0, 0.0, 0.0)
