"""What is made of a body is made when a pair asks for it, and what its mesh shares is made once."""

from __future__ import annotations

import math
from unittest.mock import Mock

import pytest

from satcheck import decompose
from satcheck.audit.bodies import BodyCache
from satcheck.audit.body import PlacedBody, SharedMesh, world_bounds
from satcheck.audit.check import check
from satcheck.audit.settings import Settings
from satcheck.scene import Body, Scene, load_scene
from tests.audit import shapes

QUICK = Settings(depth=False, tolerance=0.0)


def turned(angle, x=0.0, mirror=1.0):
    """About z, then along x."""
    c, s = math.cos(angle), math.sin(angle)
    return (mirror * c, -s, 0.0, x, mirror * s, c, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def file_of(folder, mesh):
    (path,) = shapes.write(folder, part=mesh)
    return load_scene([path]).bodies[0].file


def crowd(file, count, step):
    """Brackets in a row, each turned further, every other one mirrored."""
    return tuple(
        Body(f"b{k:03}", "", file, turned(0.3 * k, step * k, (-1.0) ** k)) for k in range(count)
    )


def mesh_of(scene, settings=QUICK):
    cache = BodyCache()
    report = check(scene, settings, cache=cache)
    (mesh,) = cache.meshes.values()
    return report, mesh


def test_one_hierarchy_for_a_mesh_whatever_the_number_of_bodies(tmp_path):
    bodies = crowd(file_of(tmp_path, shapes.bracket()), 40, 4.0)
    report, mesh = mesh_of(Scene("", None, bodies))
    triangles = [f for f in report.findings if any(s.stage == "triangles" for s in f.plan)]
    assert mesh.geometry.hierarchies == 1
    assert mesh.geometry.refits == len({name for found in triangles for name in (found.a, found.b)})
    assert len(triangles) > 20
    assert mesh.decomposition.known is None


def test_nothing_is_built_for_bodies_that_their_boxes_keep_apart(tmp_path):
    bodies = crowd(file_of(tmp_path, shapes.bracket()), 20, 50.0)
    report, mesh = mesh_of(Scene("", None, bodies))
    assert report.summary.pairs.pruned == report.summary.pairs.total
    assert (mesh.geometry.hierarchies, mesh.geometry.refits) == (0, 0)


def test_a_body_where_its_file_puts_it_shares_the_surface_of_the_file(tmp_path):
    file = file_of(tmp_path, shapes.bracket())
    mesh = SharedMesh(file, QUICK)
    body = PlacedBody(Body("a", "", file), mesh)
    assert body.surface() is mesh.geometry.surface()
    assert body.hull() is mesh.geometry.hull()
    assert body.hull_shape() is mesh.geometry.hull_shape()
    assert body.mesh is file.mesh
    assert (mesh.geometry.hierarchies, mesh.geometry.refits) == (1, 0)


def test_what_was_let_go_is_made_again_and_is_the_same(tmp_path):
    file = file_of(tmp_path, shapes.bracket())
    mesh = SharedMesh(file, QUICK)
    body = PlacedBody(Body("a", "", file, turned(1.0, 3.0)), mesh)
    before = body.surface()
    assert body.surface() is before
    body.release()
    assert body.surface() is not before
    assert (body.surface().mesh.vertices == before.mesh.vertices).all()
    assert (mesh.geometry.hierarchies, mesh.geometry.refits) == (1, 2)


def test_parts_are_made_once_for_a_mesh(tmp_path, monkeypatch):
    bodies = crowd(file_of(tmp_path, shapes.bracket()), 4, 3.0)
    settings = Settings(depth=False, accuracy="parts", cache=False)
    made = Mock(wraps=decompose.decompose)
    monkeypatch.setattr(decompose, "decompose", made)
    mesh_of(Scene("", None, bodies), settings)
    assert made.call_count == 1


def test_bounds_of_all_bodies_at_once(tmp_path):
    file = file_of(tmp_path, shapes.bracket())
    bodies = [*crowd(file, 5, 3.0), Body("still", "", file)]
    bodies.insert(2, Body("gone", "", file, (1e50, *turned(0.0)[1:])))
    found = world_bounds(bodies, 1)
    assert found.pop(2) is None
    bodies.pop(2)
    assert found == [body.world_mesh().bounds for body in bodies]


@pytest.mark.parametrize("far", [1e50, math.inf])
def test_a_body_that_cannot_be_placed_is_refused(tmp_path, far):
    file = file_of(tmp_path, shapes.bracket())
    with pytest.raises((ValueError, OverflowError)):
        PlacedBody(Body("a", "", file, turned(0.0, far)), SharedMesh(file, QUICK))
