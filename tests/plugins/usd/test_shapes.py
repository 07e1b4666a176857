"""Shapes with sizes: exact, with their axes and scales."""

from __future__ import annotations

from itertools import combinations
from math import cos, radians, sin
from math import pi as PI
from pathlib import Path

import numpy as np
import pytest

from satcheck.core.shapes import Sphere
from tests.plugins.usd.files import bounds_of, cube, load, said, stage


def shape(kind: str, sizes: str, transform: str = "") -> str:
    placed = ""
    if transform:
        placed = f'{transform}\nuniform token[] xformOpOrder = ["{transform.split()[1]}"]'
    return stage(f'def {kind} "S" {{\n{sizes}\n{placed}\n}}')


@pytest.mark.parametrize(
    ("kind", "sizes", "half"),
    [
        ("Cube", "double size = 3", (1.5, 1.5, 1.5)),
        ("Sphere", "double radius = 3", (3, 3, 3)),
        ("Cylinder", 'double radius = 1\ndouble height = 6\nuniform token axis = "X"', (3, 1, 1)),
        ("Cylinder", 'double radius = 1\ndouble height = 6\nuniform token axis = "Y"', (1, 3, 1)),
        ("Cylinder", 'double radius = 1\ndouble height = 6\nuniform token axis = "Z"', (1, 1, 3)),
        ("Capsule", 'double radius = 1\ndouble height = 6\nuniform token axis = "Y"', (1, 4, 1)),
        ("Cone", "double radius = 1\ndouble height = 6", (1, 1, 3)),
        ("Plane", 'double width = 2\ndouble length = 6\nuniform token axis = "Z"', (1, 3, 0)),
        ("Plane", 'double width = 2\ndouble length = 6\nuniform token axis = "X"', (0, 3, 1)),
        ("Plane", 'double width = 2\ndouble length = 6\nuniform token axis = "Y"', (1, 0, 3)),
        ("Capsule_1", "double radiusTop = 1\ndouble radiusBottom = 1", (1, 1, 1.5)),
    ],
)  # fmt: skip
def test_a_shape_has_its_exact_box(
    tmp_path: Path, kind: str, sizes: str, half: tuple[float, float, float]
) -> None:
    low, high = bounds_of(load(tmp_path, shape(kind, sizes)))["/S"]
    assert high == pytest.approx(half, abs=1e-13)
    assert low == pytest.approx([-x for x in half], abs=1e-13)


@pytest.mark.parametrize(("axis", "place"), [("X", 0), ("Y", 1), ("Z", 2)])
def test_the_apex_of_a_cone_is_at_the_positive_end(tmp_path: Path, axis: str, place: int) -> None:
    text = shape("Cone", f'double radius = 1\ndouble height = 6\nuniform token axis = "{axis}"')
    (body,) = load(tmp_path, text).bodies
    far = [p for p in body.world_mesh().vertices.tolist() if abs(p[place] - 3) < 1e-9]
    assert len(far) == 1


def test_a_sphere_scaled_along_its_axes_is_an_ellipsoid(tmp_path: Path) -> None:
    text = shape("Sphere", "double radius = 1", "double3 xformOp:scale = (1, 2, 3)")
    _, high = bounds_of(load(tmp_path, text))["/S"]
    assert high == pytest.approx((1, 2, 3), rel=1e-12)


def test_rounding_to_float32_does_not_skew_a_shape(tmp_path: Path) -> None:
    """A rotation by 30 degrees about z, and a scale by 1.1, written with seven digits."""
    c, s = (float(f"{1.1 * value:.7g}") for value in (cos(radians(30)), sin(radians(30))))
    matrix = f"( ({c}, {s}, 0, 0), ({-s}, {c + 1e-7}, 0, 0), (0, 0, 1.1, 0), (0, 0, 0, 1) )"
    rotated = f"matrix4d xformOp:transform = {matrix}"
    sizes = "double radius = 1\ndouble height = 6"
    for kind in ("Capsule", "Cylinder", "Cone"):
        (body,) = load(tmp_path, shape(kind, sizes, rotated)).bodies
        assert body.shape is not None
        assert bounds_of(load(tmp_path, shape(kind, sizes, rotated)))["/S"][1] == pytest.approx(
            (1.1, 1.1, 3.3 + 1.1 * (kind == "Capsule")), rel=1e-6
        )


def test_a_float32_rotation_keeps_a_sphere_a_sphere(tmp_path: Path) -> None:
    rotated = "quatf xformOp:orient = (0.7071068, 0, 0, 0.7071068)"
    (body,) = load(tmp_path, shape("Sphere", "double radius = 1", rotated)).bodies
    assert body.shape == Sphere(1.0)


@pytest.mark.parametrize(
    ("kind", "sizes", "why"),
    [
        ("Cone", "double radius = 0", "should be positive"),
        ("Cylinder_1", "double radiusTop = 1\ndouble radiusBottom = 2", "two radii"),
        ("Plane", 'double width = 2\nuniform token axis = "Q"', "axis is 'Q', not X, Y or Z"),
    ],
)
def test_what_is_no_exact_shape_is_not_read(
    tmp_path: Path, kind: str, sizes: str, why: str
) -> None:
    text = shape(kind, sizes, "float3 xformOp:scale = (1, 2, 1)") + cube("Other")
    scene = load(tmp_path, text)
    assert [body.id for body in scene.bodies] == ["/Other"]
    assert why in scene.unreadable[0].issue.message


SHEARED = "matrix4d xformOp:transform = ((1, 0, 0, 0), (1, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))"


@pytest.mark.parametrize(
    ("kind", "sizes", "change", "why", "volume"),
    [
        ("Cylinder", "double radius = 1", "float3 xformOp:scale = (1, 2, 1)", "unevenly", 4 * PI),
        (
            "Capsule",
            "double radius = 1",
            "float3 xformOp:scale = (1, 2, 1)",
            "unevenly",
            14 / 3 * PI,
        ),
        ("Sphere", "double radius = 1", SHEARED, "sheared", 4 / 3 * PI),
    ],
)
def test_an_uneven_shape_is_checked_as_facets_around_it(
    tmp_path: Path, kind: str, sizes: str, change: str, why: str, volume: float
) -> None:
    scene = load(tmp_path, shape(kind, sizes, change))
    (body,) = scene.bodies
    assert why in said(scene)["faceted"]
    points = np.asarray(body.world_mesh().vertices)
    corners = points[np.asarray(body.world_mesh().triangles)]
    enclosed = abs(np.linalg.det(corners).sum()) / 6
    # A shell of the thickness of the tolerance, on a surface smaller than that of a box around it.
    surface = 2 * sum(a * b for a, b in combinations(np.ptp(points, axis=0), 2))
    assert 0 < enclosed - volume < surface * body.facet_tolerance
    assert 0 < body.facet_tolerance < 0.01
