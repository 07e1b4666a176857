"""A curved shape against the triangles of a mesh, one by one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from satcheck import core
from satcheck.audit.curved.shape import CurvedShape
from satcheck.audit.curved.signed import AT_ORIGIN, ORIGIN, Outcome, Signed, Vector, signed
from satcheck.core.frozen import frozen, replace

Indices = npt.NDArray[np.int64]
NONE: Indices = np.empty(0, dtype=np.int64)
# The graver first.
_OUTCOMES: tuple[Outcome, ...] = ("penetrating", "touching", "separated")


@frozen
class Nearest:
    """The triangles of a mesh against a curved shape.

    nearest: the signed distance from the shape to the triangles of which that is known, with the
    witness points of the nearest as far as distances tell: its bounds and its outcome hold for all
    of them. None where all are farther than was looked. triangle: the nearest. crossed: triangles
    that the inside of the shape meets; undecided: there are some of which that is not known.
    """

    nearest: Signed | None
    triangle: int
    crossed: Indices
    undecided: bool


def against_triangles(
    curved: CurvedShape,
    mesh: core.Mesh,
    reach: float,
    move: Vector = ORIGIN,
    without: Indices = NONE,
) -> Nearest:
    """The shape, moved, and every triangle whose box is within reach of the shape's, but for those
    that are left out."""
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    corners = vertices[triangles]
    low, high = (np.array(end) + np.array(move) for end in curved.bounds())
    gaps = np.maximum(low - corners.max(axis=1), corners.min(axis=1) - high)
    close = np.setdiff1d(np.flatnonzero(gaps.max(axis=1) <= reach), without)
    if not len(close):
        return Nearest(None, -1, close, False)
    placed = replace(curved, pose=curved.moved(move))
    results = _ask([placed.shape, *(core.Hull(corners[k]) for k in close)], placed)
    found = [signed(results[k], curved.slack) for k in range(len(close))]
    known = [(one, int(k)) for one, k in zip(found, close, strict=True) if one is not None]
    crossed = close[[one is not None and one.outcome == "penetrating" for one in found]]
    if not known:
        return Nearest(None, -1, crossed, True)
    best, triangle = min(known, key=lambda one: one[0].distance)
    return Nearest(
        _of_all(best, [one for one, _ in known]), triangle, crossed, len(known) < len(found)
    )


def _of_all(best: Signed, known: Sequence[Signed]) -> Signed:
    """The distance is an estimate: the bounds of another triangle may reach lower than those of the
    one that looks nearest."""
    outcome = min((one.outcome for one in known), key=_OUTCOMES.index)
    return replace(
        best,
        lower=min(one.lower for one in known),
        upper=min(one.upper for one in known),
        outcome=outcome,
        exact=all(one.exact for one in known if one.outcome == outcome),
    )


def cancelling(mesh: core.Mesh, chosen: Sequence[int]) -> Indices:
    """Those of the triangles that lie in each other, corner on corner, as often one way round as
    the other: no winding number changes across them, and no material ends there."""
    vertices = np.asarray(mesh.vertices)
    keys: dict[int, tuple[tuple[float, ...], ...]] = {}
    turns: Counter[tuple[tuple[float, ...], ...]] = Counter()
    for index in chosen:
        corners = [tuple(c + 0.0 for c in p) for p in vertices[mesh.triangles[index]].tolist()]
        order = sorted(range(3), key=lambda k: corners[k])
        keys[index] = tuple(corners[k] for k in order)
        turns[keys[index]] += 1 if order in ([0, 1, 2], [1, 2, 0], [2, 0, 1]) else -1
    return np.array([index for index in chosen if turns[keys[index]] == 0], dtype=np.int64)


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
