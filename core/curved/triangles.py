"""A curved shape against the triangles of a mesh, one by one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from msgspec import Struct
from msgspec.structs import replace

from satcheck.core import Hull, Mesh, PairResults, check_pairs
from satcheck.core.curved.exact.pair import refined
from satcheck.core.curved.placed import CurvedShape
from satcheck.core.curved.signed import AT_ORIGIN, Outcome, Signed, signed

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]
# The triangles about the middle of a shape that are compared first: one that meets its inside may
# decide.
FEW = 32
# The graver outcome comes first.
_OUTCOMES: tuple[Outcome, ...] = ("penetrating", "touching", "separated")


class Nearest(Struct, frozen=True):
    """The result of a curved shape against the triangles of a mesh.

    nearest: the signed distance from the shape to the triangles with a known distance. Its bounds
    and its outcome hold for all of them; its witness points are those of the nearest one by
    estimated distance. None: all triangles are out of reach. triangle: the nearest. crossed:
    triangles that meet the inside of the shape. undecided: for some triangles this is unknown.
    compared, refined: the number of triangles, and of those decided in exact arithmetic.
    """

    nearest: Signed | None
    triangle: int
    crossed: Indices
    touched: tuple[int, ...]
    undecided: bool
    compared: int = 0
    refined: int = 0


def against_triangles(
    curved: CurvedShape, mesh: Mesh, reach: float, most: int | None = None
) -> Nearest:
    """Compares the shape with every triangle whose box is within reach of the box of the shape; of
    more than `most` such triangles, only with so many about its middle."""
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    low, high = (np.array(end) for end in curved.bounds())
    gaps = np.maximum(low - corners.max(axis=1), corners.min(axis=1) - high)
    close = np.flatnonzero(gaps.max(axis=1) <= reach)
    if not len(close):
        return Nearest(None, -1, close, (), False)
    if most is not None and len(close) > most:
        middles = corners[close].mean(axis=1) - np.array(curved.centre)
        far = np.einsum("ij,ij->i", middles, middles)
        close = np.sort(close[np.argsort(far, kind="stable")[:most]])
    results = _solve(curved, corners[close])
    distances = [signed(results[k], curved.slack) for k in range(len(close))]
    count = _refine(curved, corners[close], distances)
    known = [(d, int(k)) for d, k in zip(distances, close, strict=True) if d is not None]
    crossed = close[[d is not None and d.outcome == "penetrating" for d in distances]]
    touched = tuple(k for d, k in known if d.outcome == "touching" and d.exact)
    if not known:
        return Nearest(None, -1, crossed, touched, True, len(close), count)
    nearest, triangle = min(known, key=lambda pair: pair[0].distance)
    of_all = _of_all(nearest, [d for d, _ in known])
    is_open = len(known) < len(distances)
    return Nearest(of_all, triangle, crossed, touched, is_open, len(close), count)


def _solve(curved: CurvedShape, corners: Floats) -> PairResults:
    count = len(corners)
    return check_pairs(
        [curved.shape, *map(Hull, corners)],
        np.zeros(count, dtype=np.uint32),
        np.arange(1, count + 1, dtype=np.uint32),
        np.tile(np.array(curved.pose), (count, 1)),
        np.tile(np.array(AT_ORIGIN), (count, 1)),
        query="depth",
    )


def _refine(curved: CurvedShape, corners: Floats, distances: list[Signed | None]) -> int:
    """Replaces distances that are not exact by results of exact arithmetic. Returns their
    number."""
    left = {k: d for k, d in enumerate(distances) if d is not None and not d.exact}
    if left:
        exact = refined(curved.image, corners[list(left)], list(left.values()))
        for k, distance in zip(left, exact, strict=True):
            distances[k] = distance
    return len(left)


def _of_all(nearest: Signed, known: Sequence[Signed]) -> Signed:
    """Bounds for all triangles. The distance itself is an estimate: another triangle may have a
    smaller lower bound than the nearest one."""
    outcome = min((d.outcome for d in known), key=_OUTCOMES.index)
    return replace(
        nearest,
        lower=min(d.lower for d in known),
        upper=min(d.upper for d in known),
        outcome=outcome,
        exact=_is_exact(outcome, known),
    )


def _is_exact(outcome: Outcome, known: Sequence[Signed]) -> bool:
    """Whether the outcome for all triangles is exact. A shape touches if it touches one triangle
    and its inside meets none."""
    same = [d for d in known if d.outcome == outcome]
    if outcome != "touching":
        return all(d.exact for d in same)
    return any(d.exact for d in same) and all(d.lower >= 0 for d in same)
