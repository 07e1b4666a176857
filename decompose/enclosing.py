"""Grows convex parts until they contain the surface of their mesh, and proves that they do.

The surface is cut into pieces, and each is assigned to a part (`error_bounds.Bodies.assigned`). A
part begins as it is, or as the hull of few of its points, or as a box. Faces above which points lie
are moved outward, by moving their corners: the number of vertices does not grow. The smallest
result counts. All coordinates are 32-bit numbers, as in the files and in physics engines, so that
no later rounding moves a vertex.

The proof: each corner of each piece lies in the hull of the rounded vertices, so the piece does, as
the hull is convex. Exact signs decide for corners of whole triangles, which may lie on the hull.
Corners of pieces that were cut must lie deeper than the roundings of the cuts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import TYPE_CHECKING, Final

import numpy as np

from satcheck.core import Mesh, Polytope, Surface
from satcheck.decompose import errors
from satcheck.decompose.error_bounds import ROUNDINGS, Bodies, Point, highest, planes_of
from satcheck.decompose.errors import Deadline, DecompositionError
from satcheck.decompose.fitting import hull_of, simplified, volume

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# How far faces are first moved beyond what they lack, relative to the largest coordinate: rounding
# to 32 bits moves a vertex by at most sqrt(3) * 2^-24 of it.
_MARGIN: Final = 2.0**-22
_ROUNDS: Final = 16
_BOX: Final = 8  # corners
_STEPS: Final = 64  # for the move of one vertex


def enclosing_parts(
    mesh: Mesh, parts: Sequence[Polytope], vertices: int | None, deadline: Deadline
) -> tuple[Polytope, ...]:
    """Return the parts, grown, which are proven to contain the surface of the mesh.

    vertices: the most of a part; None: any number. Their coordinates are 32-bit numbers. Raises
    DecompositionError if nothing is proven.
    """
    bodies = Bodies(parts, deadline)
    corners: list[list[Point]] = [[] for _ in parts]
    off = [0.0] * len(parts)
    for number, piece, error in bodies.assigned(mesh):
        corners[number] += piece
        off[number] = max(off[number], error)
    grown = []
    for part, own, depth in zip(parts, corners, off, strict=True):
        points = np.unique(np.array(own).reshape(-1, 3), axis=0)
        grown.append(_grown(part, points, vertices, depth, deadline))
    return tuple(grown)


def _grown(
    part: Polytope, corners: Floats, vertices: int | None, off: float, deadline: Deadline
) -> Polytope:
    """The part, grown until it contains points (n, 3): the smallest of those that are proven to do
    so. off: how deep the points have to lie in it."""
    within = np.asarray(part.vertices)
    target = np.concatenate([within, corners])
    if vertices is not None and len(within) > vertices:
        start = _rounded(simplified(target, vertices, deadline).vertices)
    else:
        start = _rounded(within)
    if _contains(start, corners, off, deadline):
        return start
    starts = [start]
    if vertices is None or vertices >= _BOX:
        starts += [_rounded(box) for box in _boxes(target)]
    proven = [_proven(each, target, corners, off, deadline) for each in starts]
    smallest = min(filter(None, proven), key=volume, default=None)
    if smallest is None:
        raise DecompositionError(
            errors.NOT_ENCLOSED,
            "no part in 32-bit numbers is proven to contain its piece of the mesh",
        )
    return smallest


def _proven(
    hull: Polytope, target: Floats, corners: Floats, off: float, deadline: Deadline
) -> Polytope | None:
    """The hull, grown; None: its numbers are too coarse."""
    margin = _MARGIN * float(np.abs(target).max()) + off
    for number in range(_ROUNDS):
        if hull.dimension < 3:
            return None
        hull = _rounded(_pushed(hull, target, margin * 2.0**number, deadline))
        if _contains(hull, corners, off, deadline):
            return hull
    return None


def _boxes(points: Floats) -> Iterator[Floats]:
    """Yield the corners (8, 3) of boxes around points: along the axes, and along the points."""
    for axes in (np.eye(3), np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2]):
        low, high = (points @ axes.T).min(axis=0), (points @ axes.T).max(axis=0)
        yield np.array(list(product(*zip(low, high, strict=True)))) @ axes


def _rounded(points: Floats) -> Polytope:
    """Return the hull of the points in 32-bit numbers."""
    with np.errstate(over="ignore"):
        single = np.asarray(points).astype(np.float32).astype(np.float64)
    if not np.isfinite(single).all():
        raise DecompositionError(errors.NOT_ENCLOSED, "32-bit numbers do not hold the mesh")
    return hull_of(np.unique(single, axis=0))


def _pushed(hull: Polytope, target: Floats, margin: float, deadline: Deadline) -> Floats:
    """Return the vertices (n, 3), moved so that their faces lie beyond the target by the margin."""
    points, triangles = np.asarray(hull.vertices), np.asarray(hull.triangles)
    normals, offsets = planes_of(hull, deadline)
    lacking = highest(normals, target, np.zeros(len(target)), deadline) - offsets + margin
    faces: list[list[int]] = [[] for _ in points]
    for number, triangle in enumerate(triangles.tolist()):
        for vertex in triangle:
            faces[vertex].append(number)
    out = points - points.mean(axis=0)  # beyond each face around a vertex
    moves = np.zeros_like(points)
    for vertex, around in enumerate(faces):
        deadline.check()
        own, wanted, move = normals[around], lacking[around], moves[vertex]
        for _ in range(_STEPS):
            left = wanted - own @ move
            worst = int(left.argmax())
            if left[worst] <= 0.0:
                break
            move += left[worst] * own[worst]
        else:
            heights = own @ out[vertex]
            left = np.maximum(0.0, wanted - own @ move)
            move += np.max(left / np.where(heights > 0.0, heights, np.inf)) * out[vertex]
    return points + moves


def _contains(hull: Polytope, points: Floats, off: float, deadline: Deadline) -> bool:
    """Return whether it is proven that the points lie in the hull: deeper than `off`, if that is
    not 0."""
    if hull.dimension < 3:
        return False
    solid = Surface(hull.to_mesh(), True)
    deep = off + ROUNDINGS * float(
        max(np.abs(hull.vertices).max(), np.abs(points).max(initial=0.0))
    )
    for x, y, z in points.tolist():
        deadline.check()
        around, depth = solid.winding_number((x, y, z)), solid.nearest((x, y, z))[0]
        is_on_it = around is None and depth == 0.0 and off == 0.0
        if not is_on_it and not (around and (depth > deep or off == 0.0)):
            return False
    return True
