"""The limits of convex parts, and those that physics engines document."""

from __future__ import annotations

from typing import Final

from msgspec import Struct

LEAST_VERTICES: Final = 4  # of a solid


class Limits(Struct, frozen=True):
    """parts: the most parts of a mesh, 1 or more. vertices: the most vertices of a part, 4 or more.
    None: any number. enclose: the parts have to contain the surface of the mesh."""

    parts: int | None = None
    vertices: int | None = None
    enclose: bool = False


class Engine(Struct, frozen=True):
    """What the documentation of an engine says about convex meshes. parts, vertices: see `Limits`.
    why: where the figures are from. files: those of `decompose` that the engine reads."""

    parts: int | None
    vertices: int
    why: str
    files: str


# A hull of v vertices has at most 2 v - 4 triangles, and at most v - 1 meet in a vertex.
ENGINES: Final = {
    "bullet": Engine(None, 100, "the manual: at most 100 vertices", "URDF, OBJ"),
    "isaac": Engine(
        32,
        33,
        "PhysX on a GPU: 64 vertices, 64 polygons, 32 around a vertex; 32 hulls by default",
        "URDF, OBJ, STL, GLB",
    ),
    "mujoco": Engine(None, 31, "MJX: fewer than 32 vertices", "URDF, OBJ, STL"),
    "unity": Engine(None, 129, "convex colliders: 255 triangles", "URDF and GLB by packages, OBJ"),
    "unreal": Engine(64, 32, "the mesh editor: 64 hulls of 32 vertices", "GLB, OBJ"),
}
