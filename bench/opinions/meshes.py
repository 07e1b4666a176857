"""The mesh of a file, as satcheck reads it, and as trimesh does."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from bench.opinions.surface import Mesh, area
from satcheck.scene import load_scene


@lru_cache(maxsize=4)
def read(path: str) -> Mesh:
    """The whole file as one body. Raises ValueError, with the codes, where it is refused."""
    scene = load_scene([path], split="none", allow_outside=True, hashed=False)
    if len(scene.bodies) != 1:
        raise ValueError(", ".join(sorted({issue.code for issue in scene.issues})) or "no body")
    points, corners = scene.bodies[0].file.mesh.to_bytes()
    vertices = np.frombuffer(points, "<f8").reshape(-1, 3)
    return Mesh(vertices, np.frombuffer(corners, "<u4").reshape(-1, 3).astype(np.int64))


@dataclass(frozen=True)
class Extent:
    """What two readers have to agree on: the bounding box of what triangles use, and their area."""

    low: tuple[float, ...]
    high: tuple[float, ...]
    area: float

    def agrees(self, other: Extent) -> bool:
        """To what is left of float32 after a few products."""
        size = float(np.linalg.norm(np.subtract(self.high, self.low)))
        box = np.abs(np.subtract((*self.low, *self.high), (*other.low, *other.high))).max()
        return bool(box <= 1e-4 * size and abs(self.area - other.area) <= 1e-3 * self.area)


def extent(mesh: Mesh) -> Extent:
    used = mesh.vertices[np.unique(mesh.triangles)]
    return Extent(tuple(used.min(axis=0).tolist()), tuple(used.max(axis=0).tolist()), area(mesh))


def read_by_trimesh(path: str) -> Mesh:
    """The whole file, its scene graph applied. Raises whatever trimesh raises."""
    import trimesh

    scene = trimesh.load_scene(path, process=False, skip_materials=True)
    vertices, triangles, count = [np.zeros((0, 3))], [np.zeros((0, 3), np.int64)], 0
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        geometry = scene.geometry[name]
        if isinstance(geometry, trimesh.Trimesh):
            vertices.append(trimesh.transform_points(geometry.vertices, matrix))
            triangles.append(np.asarray(geometry.faces, np.int64) + count)
            count += len(geometry.vertices)
    return Mesh(np.concatenate(vertices), np.concatenate(triangles))
