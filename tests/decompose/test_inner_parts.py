"""decompose/inner_parts.py: inside the solid without exception, and not much smaller than it."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh, Polytope, Surface, mesh_relation
from satcheck.decompose import decompose
from satcheck.decompose.components import merged
from satcheck.decompose.inner_parts import inner_parts
from tests.decompose.brute_force import surface_samples, winding


def volume(polytope: Polytope) -> float:
    return polytope.to_mesh().topology().volume


@pytest.mark.parametrize("name", ["torus", "l_shape", "u_shape"])
def test_inner_parts_are_inside_the_mesh(name: str, request: pytest.FixtureRequest) -> None:
    mesh: Mesh = request.getfixturevalue(name)
    result = decompose(mesh, threshold=0.1)
    assert len(result.inner) == len(result.parts)
    for part in result.inner:
        assert part is not None
        assert winding(surface_samples(part.to_mesh(), 5), mesh).min() > 0.5
    filled = sum(volume(part) for part in result.inner if part is not None)
    assert filled > 0.85 * mesh.topology().volume


def test_a_part_in_contact_from_inside_loses_next_to_nothing(l_shape: Mesh, box: Mesh) -> None:
    (inner,) = inner_parts([box.convex_hull()], Surface(l_shape, True))
    assert inner is not None
    assert 1.0 - 1e-5 < volume(inner) < 1.0


def test_a_part_outside_the_mesh_has_no_inner_part(l_shape: Mesh, box: Mesh) -> None:
    beyond = box.translated((1.25, 1.25, 0.0)).convex_hull()
    assert inner_parts([beyond], Surface(l_shape, True)) == (None,)


def test_a_part_around_a_cavity_is_not_taken_for_inside(box: Mesh) -> None:
    shell = Mesh(np.asarray(box.vertices) * 9.0, np.asarray(box.triangles))
    inverted = np.ascontiguousarray(np.asarray(box.triangles)[:, ::-1])
    cavity = Mesh(np.asarray(box.vertices) + 4.0, inverted)
    hollow = merged([shell, cavity])
    around = Mesh(np.asarray(box.vertices) * 3.0 + 3.0, np.asarray(box.triangles)).convex_hull()
    (inner,) = inner_parts([around], Surface(hollow, True))
    assert inner is not None  # beside the cavity there is room
    filled_cavity = Surface(Mesh(np.asarray(box.vertices) + 4.0, np.asarray(box.triangles)), True)
    assert mesh_relation(filled_cavity, Surface(inner.to_mesh(), True)).relation == "separated"


def test_negligible_parts_are_skipped(l_shape: Mesh, box: Mesh) -> None:
    crumb = Mesh(np.asarray(box.vertices) * 1e-3 + 0.5, np.asarray(box.triangles)).convex_hull()
    large, small = inner_parts([box.convex_hull(), crumb], Surface(l_shape, True))
    assert large is not None
    assert small is None
