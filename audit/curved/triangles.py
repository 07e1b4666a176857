"""A curved shape against the triangles of a mesh, one by one."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from satcheck import core
from satcheck.audit.curved.shape import CurvedShape
from satcheck.audit.curved.signed import AT_ORIGIN, ORIGIN, Signed, Vector, signed
from satcheck.core.frozen import frozen, replace


@frozen
class Nearest:
    """The triangles of a mesh against a curved shape.

    nearest: the least signed distance from the shape to a triangle; None where all are farther than
    was looked. crossed: triangles that the inside of the shape meets; undecided: those of which
    that is not known.
    """

    nearest: Signed | None
    triangle: int
    crossed: npt.NDArray[np.int64]
    undecided: bool


def against_triangles(
    curved: CurvedShape, mesh: core.Mesh, reach: float, move: Vector = ORIGIN
) -> Nearest:
    """The shape, moved, and every triangle whose box is within reach of the shape's."""
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    corners = vertices[triangles]
    low, high = (np.array(end) + np.array(move) for end in curved.bounds())
    gaps = np.maximum(low - corners.max(axis=1), corners.min(axis=1) - high)
    close = np.flatnonzero(gaps.max(axis=1) <= reach)
    if not len(close):
        return Nearest(None, -1, close, False)
    placed = replace(curved, pose=curved.moved(move))
    results = _ask([placed.shape, *(core.Hull(corners[k]) for k in close)], placed)
    found = [signed(results[k], curved.slack) for k in range(len(close))]
    known = [one for one in found if one is not None]
    crossed = close[[one is not None and one.outcome == "penetrating" for one in found]]
    if not known:
        return Nearest(None, -1, crossed, True)
    best = min(range(len(found)), key=lambda k: math.inf if found[k] is None else found[k].distance)  # type: ignore[union-attr]
    return Nearest(found[best], int(close[best]), crossed, len(known) < len(found))


def _ask(shapes: list[core.Shape], curved: CurvedShape) -> core.PairResults:
    """The first shape, placed, against each of the others, which are in the world."""
    count = len(shapes) - 1
    return core.check_pairs(
        shapes,
        np.zeros(count, dtype=np.uint32),
        np.arange(1, count + 1, dtype=np.uint32),
        np.tile(np.array(curved.pose), (count, 1)),
        np.tile(np.array(AT_ORIGIN), (count, 1)),
        query="depth",
    )
