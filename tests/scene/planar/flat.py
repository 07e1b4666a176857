"""Flat bodies for tests: polygons with corners as given."""

from __future__ import annotations

import numpy as np

from satcheck.core import Mesh
from satcheck.scene import Body, MeshFile, Scene
from satcheck.scene.inspect import examine

Corners = list[tuple[float, float]]


def sheet(corners: Corners, triangles: list[tuple[int, int, int]] | None = None) -> Mesh:
    """A mesh in z = 0; without triangles, a fan from the first corner."""
    fan = [(0, k, k + 1) for k in range(1, len(corners) - 1)]
    vertices = [(x, y, 0.0) for x, y in corners]
    return Mesh(np.array(vertices, float), np.array(triangles or fan, dtype=np.uint32))


def body(id_: str, mesh: Mesh, form: str = "off") -> Body:
    examined = examine(mesh)
    file = MeshFile(
        path=f"{id_}.{form}",
        sha256=id_,
        format=form,
        resolution=0.0,
        units=None,
        mesh=examined.mesh,
        health=examined.health,
        issues=(),
    )
    return Body(id_, id_, file)


def scene(*meshes: Mesh) -> Scene:
    names = "abcdefgh"
    bodies = tuple(body(name, mesh) for name, mesh in zip(names, meshes, strict=False))
    return Scene("flat", None, bodies, order=tuple(one.id for one in bodies))
