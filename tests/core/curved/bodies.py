"""Bodies that are primitive shapes or meshes, for questions about them."""

from __future__ import annotations

import math

import numpy as np

from satcheck.audit import Finding, Settings, check
from satcheck.core import Mesh
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Box, Primitive
from satcheck.scene import Body, Scene
from satcheck.scene.inspect import shape_file
from tests.scene.planar.flat import body as mesh_body

Transform = tuple[float, ...]


def moved(x: float, y: float, z: float) -> Transform:
    return (1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1)


def tilted(degrees: float, x: float, y: float, z: float) -> Transform:
    """Turned about the x axis, then moved."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (1, 0, 0, x, 0, c, -s, y, 0, s, c, z, 0, 0, 0, 1)


def shape(id_: str, primitive: Primitive, transform: Transform | None = None) -> Body:
    return Body(id_, id_, shape_file(primitive, "test"), transform, shape=primitive)


def l_bracket() -> Mesh:
    """Two arms along x and z, 4 long, 1 thick, 4 wide in y: concave at x = z = 1."""
    outline = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 4.0), (0.0, 4.0)]
    count = len(outline)
    vertices = [(x, y, z) for y in (-2.0, 2.0) for x, z in outline]
    caps = [(0, 1, 2), (0, 2, 3), (0, 3, 5), (3, 4, 5)]
    walls = [
        face
        for k in range(count)
        for j in [(k + 1) % count]
        for face in ((k, k + count, j + count), (k, j + count, j))
    ]
    faces = caps + [(c + count, b + count, a + count) for a, b, c in caps] + walls
    return Mesh(np.array(vertices), np.array(faces, dtype=np.uint32))


def bracket(id_: str = "bracket") -> Body:
    return mesh_body(id_, l_bracket())


def hollow_box() -> Body:
    """4 wide outside, 2 inside."""
    outer, inner = mesh_of(Box((4.0, 4.0, 4.0))), mesh_of(Box((2.0, 2.0, 2.0)))
    vertices = np.concatenate((outer.vertices, inner.vertices))
    faces = np.concatenate((outer.triangles, inner.triangles[:, ::-1] + outer.vertex_count))
    return mesh_body("hollow", Mesh(vertices, faces.astype(np.uint32)))


def ask(a: Body, b: Body, *, depth: bool = True, **settings: object) -> Finding:
    scene = Scene("shapes", None, (a, b), order=(a.id, b.id))
    asked = Settings(depth=depth, **settings)  # type: ignore[arg-type]
    (finding,) = check(scene, asked).findings
    return finding
