"""The sagitta of faceted shapes whose curved surface is known."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
import trimesh
from trimesh import creation

from satcheck.core.sagitta import LEAST_AROUND, Curves, find_curves
from satcheck.core.transform import about

# Rounding: an angle between normals and a width are off by some 1e-15, relatively to the size.
EXACT = 1e-9


def curves_of(mesh: trimesh.Trimesh, precision: float = 0.0, *, solid: bool = True) -> Curves:
    """As placed obliquely."""
    turn = np.array(about((2 / 7, 3 / 7, 6 / 7), (0.6, 0.8))).reshape(3, 3)
    return find_curves(np.array(mesh.vertices) @ turn.T, np.array(mesh.faces), precision, solid)


def prism(outline: Sequence[tuple[float, float]], height: float) -> trimesh.Trimesh:
    """Over a polygon that the origin sees whole."""
    number = len(outline)
    points = [(x, y, z) for z in (0.0, height) for x, y in outline]
    following = [(k, (k + 1) % number) for k in range(number)]
    walls = [
        face for k, m in following for face in ((k, m, m + number), (k, m + number, k + number))
    ]
    caps = [
        face
        for k, m in following
        for face in ((m, k, 2 * number), (k + number, m + number, 2 * number + 1))
    ]
    return trimesh.Trimesh([*points, (0, 0, 0), (0, 0, height)], walls + caps, process=False)


def rounded_box(steps: int) -> trimesh.Trimesh:
    """20 wide, one edge with a radius of 2."""
    angles = [k * math.pi / 2 / steps for k in range(steps + 1)]
    arc = [(8 + 2 * math.cos(a), 8 + 2 * math.sin(a)) for a in angles]
    return prism([(10, -10), *arc, (-10, 10), (-10, -10)], 5.0)


def sagitta(radius: float, turn: float) -> float:
    return radius * (1 - math.cos(turn / 2))


@pytest.mark.parametrize("number", [LEAST_AROUND, 24, 100])
def test_a_cylinder(number: int) -> None:
    (curve,) = curves_of(creation.cylinder(5, 20, sections=number)).curves
    assert curve.facets == number
    assert not curve.concave
    assert curve.turn == pytest.approx(2 * math.pi / number)
    assert curve.radius == pytest.approx(5, rel=EXACT)
    assert curve.sagitta == pytest.approx(sagitta(5, 2 * math.pi / number), rel=EXACT)


def test_strips_of_unequal_widths() -> None:
    """The widest one counts; at its ends the direction is that of the circle."""
    steps = np.cumsum([9.0, 12.0, 8.0, 11.0] * 9)
    outline = [(5 * math.cos(math.radians(a)), 5 * math.sin(math.radians(a))) for a in steps]
    (curve,) = curves_of(prism(outline, 3.0)).curves
    assert curve.sagitta == pytest.approx(sagitta(5, math.radians(12)), rel=1e-3)


def test_triangles_that_alternate_between_two_rims() -> None:
    """No two of them are in a plane."""
    number = 24
    upper = creation.cylinder(5, 20, sections=number)
    vertices = np.array(upper.vertices)
    top = vertices[:, 2] > 0
    turn = math.pi / number
    half = np.array(about((0, 0, 1), (math.cos(turn), math.sin(turn)))).reshape(3, 3)
    vertices[top] = vertices[top] @ half.T
    (curve,) = curves_of(trimesh.convex.convex_hull(vertices)).curves
    assert curve.facets == 2 * number
    assert curve.sagitta == pytest.approx(sagitta(5, 2 * math.pi / number), rel=1e-3)


@pytest.mark.parametrize("height", [8.0, 1.0])
def test_a_cone(height: float) -> None:
    """At its base, across the slope. The tip is no part of a dome."""
    (curve,) = curves_of(creation.cone(5, height, sections=24)).curves
    slope = math.cos(math.atan2(5, height))
    assert curve.sagitta == pytest.approx(slope * sagitta(5, math.pi / 12), rel=0.01)


def least_distance(mesh: trimesh.Trimesh) -> float:
    """Of its triangles' planes from the origin."""
    return float((mesh.face_normals * mesh.triangles[:, 0]).sum(axis=1).min())


@pytest.mark.parametrize("made", [creation.icosphere(2, 3), creation.uv_sphere(3, (24, 24))])
def test_a_sphere(made: trimesh.Trimesh) -> None:
    """Facets of it are curved in two directions."""
    (curve,) = curves_of(made).curves
    assert curve.sagitta == pytest.approx(3 - least_distance(made), rel=0.01)
    assert curve.radius == pytest.approx(3, rel=0.01)


def test_a_torus() -> None:
    """Most at its outer rim, where both directions add up. Its inner half is a saddle."""
    torus = creation.torus(5, 1, major_sections=48, minor_sections=24)
    concave, convex = curves_of(torus).curves
    outer = sagitta(6, 2 * math.pi / 48) + sagitta(1, 2 * math.pi / 24)
    assert convex.sagitta == pytest.approx(outer, rel=0.02)
    assert (concave.concave, convex.concave) == (True, False)
    assert concave.sagitta == pytest.approx(sagitta(4, 2 * math.pi / 48), rel=0.02)
    assert concave.facets + convex.facets == 48 * 24


@pytest.mark.parametrize("steps", [3, 4, 8])
def test_a_rounded_edge(steps: int) -> None:
    """The faces beside it do not count as facets of it."""
    (curve,) = curves_of(rounded_box(steps)).curves
    assert curve.facets == steps
    assert curve.sagitta == pytest.approx(sagitta(2, math.pi / 2 / steps), rel=EXACT)


def test_an_ellipse() -> None:
    mesh = creation.cylinder(1, 4, sections=96)
    mesh.apply_scale((3, 1, 1))
    (curve,) = curves_of(mesh).curves
    # As far as a stretched circle is off its chords: where the stretch is across them.
    assert curve.sagitta == pytest.approx(3 * sagitta(1, 2 * math.pi / 96), rel=0.03)


def test_a_rounded_edge_that_runs_into_a_ball() -> None:
    """The strips of a capsule are straight, however far the facets at their ends turn."""
    curves = curves_of(creation.capsule(50, 1, count=(24, 24))).curves
    strips = [curve for curve in curves if curve.facets == 24]
    assert [curve.sagitta for curve in strips] == [pytest.approx(sagitta(1, math.pi / 12))]


def test_a_hole_has_more_material_than_the_curve() -> None:
    """A tube, inside and outside; a sheet of its form has no inside."""
    tube = creation.annulus(3, 5, 2, sections=40)
    hole, outside = curves_of(tube).curves
    assert (hole.concave, outside.concave) == (True, False)
    assert hole.sagitta == pytest.approx(sagitta(3, math.pi / 20), rel=EXACT)
    assert outside.sagitta == pytest.approx(sagitta(5, math.pi / 20), rel=EXACT)
    assert [curve.concave for curve in curves_of(tube, solid=False).curves] == [True, True]


@pytest.mark.parametrize("number", [6, 8])
def test_a_prism_is_left_out(number: int) -> None:
    curves = curves_of(creation.cylinder(5, 20, sections=number))
    assert not curves.curves
    (left_out,) = curves.left_out
    assert left_out.facets == number
    assert left_out.sagitta == pytest.approx(sagitta(5, 2 * math.pi / number), rel=EXACT)


def test_a_low_pyramid_of_eight_sides_is_left_out() -> None:
    curves = curves_of(creation.cone(5, 1, sections=8))
    assert not curves.curves
    assert [curve.facets for curve in curves.left_out] == [8]


@pytest.mark.parametrize(
    "mesh",
    [
        creation.box((1, 2, 3)),
        creation.cone(5, 1, sections=4),  # a hipped roof
        prism([(10, -5), (10, 5), (0, 8), (-10, 5), (-10, -5)], 30.0),  # a gabled house
        rounded_box(1),  # a chamfer
        rounded_box(2),
    ],
)
def test_few_faces_are_no_curve(mesh: trimesh.Trimesh) -> None:
    assert curves_of(mesh) == Curves((), ())


def test_rounded_coordinates() -> None:
    mesh = creation.cylinder(5, 20, sections=64)
    rounded = np.array(mesh.vertices).astype(np.float32).astype(np.float64)
    (curve,) = find_curves(rounded, np.array(mesh.faces), 8 * 2.0**-24, True).curves
    # A chord is off by two roundings, and its sagitta in the same proportion, twice.
    chord = 10 * math.sin(math.pi / 64)
    assert curve.facets == 64
    assert curve.sagitta == pytest.approx(sagitta(5, math.pi / 32), rel=8 * 8 * 2.0**-24 / chord)
