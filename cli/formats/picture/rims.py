"""The rim of the hole that leaves a pair undecided."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from satcheck import core

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

    from satcheck.core import Mesh
    from satcheck.report.report import Finding
    from satcheck.scene import Body

    Floats = npt.NDArray[np.float64]

_BY_HOLES = ("relation", "inside")


class Rim(NamedTuple):
    """lines: closed, each repeats its start, (n, 3). which: `hole 2 of 3`, or `the hole`."""

    body: str
    which: str
    diameter: float
    lines: list[Floats]

    @property
    def centre(self) -> Floats:
        points = np.concatenate(self.lines)
        middle: Floats = (points.min(axis=0) + points.max(axis=0)) / 2
        return middle

    @property
    def normal(self) -> Floats:
        """Of the largest area that the rim goes around, of any length."""
        turns: Floats = sum(
            (np.cross(line[:-1] - line[0], line[1:] - line[0]).sum(axis=0) for line in self.lines),
            np.zeros(3),
        )
        return turns


def deciding_rim(
    finding: Finding, pair: list[Body], surface: Callable[[Body], core.Surface]
) -> Rim | None:
    """None: no hole decides how the bodies relate. pair: as placed. surface: of one as placed."""
    if finding.undecided not in _BY_HOLES or not any(body.file.health.holes for body in pair):
        return None
    meshes = [body.world_mesh() for body in pair]
    hole = core.mesh_relation(*map(surface, pair)).hole
    if hole is None:
        return None
    side = 0 if hole.of_a else 1
    which = "the hole" if hole.count == 1 else f"hole {hole.number + 1} of {hole.count}"
    rims = [Rim(pair[side].id, which, hole.diameter, lines) for lines in _holes(meshes[side])]
    at = np.array(hole.centre)
    return min(rims, key=lambda rim: float(np.linalg.norm(rim.centre - at)), default=None)


def _holes(mesh: Mesh) -> list[list[Floats]]:
    """The rims of each hole. Those that share a vertex are of one."""
    holes: list[tuple[set[int], list[list[int]]]] = []
    for loop in _loops(_boundary(np.asarray(mesh.triangles, dtype=np.int64), mesh.vertex_count)):
        own = [hole for hole in holes if not hole[0].isdisjoint(loop)]
        holes = [hole for hole in holes if hole[0].isdisjoint(loop)]
        corners = set(loop).union(*(hole[0] for hole in own))
        holes.append((corners, [loop, *(one for hole in own for one in hole[1])]))
    points = np.asarray(mesh.vertices)
    return [[points[loop] for loop in loops] for _, loops in holes]


def _boundary(triangles: npt.NDArray[np.int64], count: int) -> npt.NDArray[np.int64]:
    """The edges that triangles run more often in one direction than in the other, (n, 2)."""
    edges = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    low, high = edges.min(axis=1), edges.max(axis=1)
    keys, edge = np.unique(low * count + high, return_inverse=True)
    surplus = np.bincount(edge.reshape(-1), np.where(edges[:, 0] == low, 1, -1), len(keys))
    ends = np.stack(np.divmod(keys, count), axis=1)[surplus != 0]
    forward = surplus[surplus != 0] > 0
    boundary: npt.NDArray[np.int64] = np.where(forward[:, None], ends, ends[:, ::-1])
    return boundary


def _loops(edges: npt.NDArray[np.int64]) -> list[list[int]]:
    """Closed walks along all edges; each repeats its start."""
    following: dict[int, list[int]] = {}
    for start, end in edges.tolist():
        following.setdefault(start, []).append(end)
    loops = []
    for start, ends in following.items():
        while ends:
            loop = [start]
            while following.get(loop[-1]):
                loop.append(following[loop[-1]].pop())
            loops.append(loop)
    return loops
