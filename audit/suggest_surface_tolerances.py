"""Proposes surface tolerances: the distance between facets and the curved surfaces that they
approximate, measured on the meshes alone. A person has to decide whether the facets approximate a
curved surface.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from satcheck.audit.summary import tool
from satcheck.core.sagitta import LEAST_AROUND, LEAST_FACETS, Curve, Curves, find_curves
from satcheck.report.surface_tolerances import (
    BodyTolerance,
    FacetedCurves,
    SurfaceTolerancesReport,
)

if TYPE_CHECKING:
    from satcheck.core.facets import Floats
    from satcheck.report.values import Vector
    from satcheck.scene import Body, Scene

# A proposed tolerance is an estimate, so it is rounded up to this many digits.
DIGITS = 3
# Curves whose radius and sagitta differ by less than this fraction are reported together.
ALIKE = 0.03
# Two placements with the same products of their columns, to this many digits, differ by a rotation.
_GRAM_DIGITS = 6


def surface_tolerances(scene: Scene) -> SurfaceTolerancesReport:
    """The proposals for all readable bodies, in the order of the scene."""
    known: dict[tuple[object, ...], Curves] = {}
    bodies = tuple(_of_body(body, known) for body in scene.bodies)
    proposed = [body.surface_tolerance for body in bodies if body.surface_tolerance is not None]
    one_unit = len({body.units for body in scene.bodies}) == 1
    return SurfaceTolerancesReport(
        tool=tool(),
        units=scene.units,
        surface_tolerance=max(proposed) if proposed and one_unit else None,
        most_degrees=360 / LEAST_AROUND,
        least_facets=LEAST_FACETS,
        bodies=bodies,
    )


def _of_body(body: Body, known: dict[tuple[object, ...], Curves]) -> BodyTolerance:
    if body.shape is not None:
        return BodyTolerance(body.id, None, stated=True, curves=(), left_out=())
    linear, exponent = _linear(body)
    gram = np.round((linear.T @ linear).ravel(), _GRAM_DIGITS)
    key = id(body.file.mesh), exponent, *gram.tolist()
    if key not in known:
        mesh = body.file.mesh
        middle = np.mean(mesh.bounds, axis=0)
        points = (mesh.vertices - middle) @ linear.T
        triangles = mesh.triangles.astype(np.intp)
        if np.linalg.det(linear) < 0:  # a mirrored copy is turned inside out
            triangles = triangles[:, ::-1]
        resolution = body.file.resolution * float(np.linalg.norm(linear, 2))
        known[key] = find_curves(points, triangles, resolution, body.file.health.solid)
    curves = _told(known[key].curves, body, exponent)
    concave = max((curve.sagitta for curve in curves if curve.concave), default=None)
    return BodyTolerance(
        body=body.id,
        surface_tolerance=None if concave is None else _rounded_up(concave),
        stated=False,
        curves=curves,
        left_out=_told(known[key].left_out, body, exponent),
    )


def _linear(body: Body) -> tuple[Floats, int]:
    """(matrix, exponent): the linear part of the placement is matrix * 2**exponent; the entries of
    the matrix are at most 1."""
    if body.transform is None:
        return np.eye(3), 0
    linear = np.array(body.transform).reshape(4, 4)[:3, :3]
    exponent = math.frexp(np.abs(linear).max())[1]
    return np.ldexp(linear, -exponent), exponent


def _told(curves: tuple[Curve, ...], body: Body, exponent: int) -> tuple[FacetedCurves, ...]:
    groups: list[list[Curve]] = []
    for curve in curves:
        group = next((group for group in groups if _are_alike(group[0], curve)), None)
        if group is None:
            groups.append([curve])
        else:
            group.append(curve)
    return tuple(
        FacetedCurves(
            concave=group[0].concave,
            chains=len(group),
            facets=sum(curve.facets for curve in group),
            degrees=math.degrees(group[0].turn),
            radius=math.ldexp(group[0].radius, exponent),
            sagitta=math.ldexp(group[0].sagitta, exponent),
            place=_place(body, group[0].triangle),
        )
        for group in groups
    )


def _are_alike(first: Curve, other: Curve) -> bool:
    lengths = ((first.sagitta, other.sagitta), (first.radius, other.radius))
    close = all(math.isclose(one, two, rel_tol=ALIKE) for one, two in lengths)
    return close and first.concave == other.concave


def _place(body: Body, triangle: int) -> Vector:
    """The middle of the triangle, world."""
    middle = np.mean(body.file.mesh.corners(triangle), axis=0)
    if body.transform is not None:
        placement = np.array(body.transform).reshape(4, 4)
        middle = placement[:3, :3] @ middle + placement[:3, 3]
    x, y, z = middle.tolist()
    return (x, y, z)


def _rounded_up(length: float) -> float:
    step = 10.0 ** (math.floor(math.log10(length)) - DIGITS + 1)
    text = f"{length:.{DIGITS - 1}e}"
    return float(text) if float(text) >= length else float(f"{length + step:.{DIGITS - 1}e}")
