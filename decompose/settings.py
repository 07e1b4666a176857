"""The settings of a decomposition, the limits of its parts, and those that engines document."""

from __future__ import annotations

from typing import Final

from msgspec import Struct

from satcheck.decompose.errors import BAD_SETTING, DecompositionError

LEAST_VERTICES: Final = 4  # of a solid
_SEED_LIMIT: Final = 1 << 32  # CoACD's seed is a C unsigned int


class DecompositionSettings(Struct, frozen=True):
    """CoACD's parameters.

    threshold: the concavity at which it stops splitting, in CoACD's own measure, 0 < t <= 1. Parts
        stick out of a mesh by about 0.3 * threshold * the diagonal of its bounding box.
    seed: of its random search.
    mcts_iterations, mcts_nodes, resolution: effort of the search for cuts. These values take about
        half the time of CoACD's defaults (150, 20, 2000) at equal quality.
    """

    threshold: float = 0.05
    seed: int = 0
    mcts_iterations: int = 60
    mcts_nodes: int = 10
    resolution: int = 1000

    def __post_init__(self) -> None:
        # CoACD aborts above 1 and never returns at or below 0.
        if not 0.0 < self.threshold <= 1.0:
            raise DecompositionError(
                BAD_SETTING,
                f"the decomposition threshold is {self.threshold:g}; it must be above 0 and "
                "at most 1",
            )
        if not 0 <= self.seed < _SEED_LIMIT:
            raise DecompositionError(
                BAD_SETTING,
                f"the decomposition seed is {self.seed}; it must be from 0 to {_SEED_LIMIT - 1}",
            )


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
    "bullet": Engine(None, 100, "the manual", "URDF, OBJ"),
    "isaac": Engine(
        32,
        33,
        "PhysX on GPUs: 64 polygons, 32 around a vertex; 32 hulls by default",
        "URDF, OBJ, STL, GLB",
    ),
    "mujoco": Engine(None, 31, "MJX: fewer than 32", "URDF, OBJ, STL"),
    "unity": Engine(None, 129, "255 triangles", "OBJ; URDF, GLB by packages"),
    "unreal": Engine(64, 32, "its mesh editor", "GLB, OBJ"),
}
