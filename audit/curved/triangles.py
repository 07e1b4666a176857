"""A curved shape against the triangles of a mesh, one by one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from msgspec import Struct
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.curved.shape import CurvedShape
from satcheck.audit.curved.signed import AT_ORIGIN, ORIGIN, Outcome, Signed, Vector, signed

Indices = npt.NDArray[np.int64]
# The graver first.
_OUTCOMES: tuple[Outcome, ...] = ("penetrating", "touching", "separated")


class Nearest(Struct, frozen=True):
    """The triangles of a mesh against a curved shape.

    nearest: the signed distance from the shape to the triangles of which that is known, with the
    witness points of the nearest as far as distances tell: its bounds and its outcome hold for all
    of them. None where all are farther than was looked. triangle: the nearest. crossed: triangles
    that the inside of the shape meets; undecided: there are some of which that is not known.
    """

    nearest: Signed | None
    triangle: int
    crossed: Indices
    touched: tuple[int, ...]
    undecided: bool
    refined: int = 0


def against_triangles(
    curved: CurvedShape,
    mesh: core.Mesh,
    reach: float,
    move: Vector = ORIGIN,
) -> Nearest:
    """The shape, moved, and every triangle whose box is within reach of the shape's."""
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    corners = vertices[triangles]
    low, high = (np.array(end) + np.array(move) for end in curved.bounds())
    gaps = np.maximum(low - corners.max(axis=1), corners.min(axis=1) - high)
    close = np.flatnonzero(gaps.max(axis=1) <= reach)
    if not len(close):
        return Nearest(None, -1, close, (), False)
    placed = replace(curved, pose=curved.moved(move))
    results = _ask([placed.shape, *(core.Hull(corners[k]) for k in close)], placed)
    found = [signed(results[k], curved.slack) for k in range(len(close))]
    refined = _refine(placed, corners[close], found)
    known = [(one, int(k)) for one, k in zip(found, close, strict=True) if one is not None]
    crossed = close[[one is not None and one.outcome == "penetrating" for one in found]]
    touched = tuple(k for one, k in known if one.outcome == "touching" and one.exact)
    if not known:
        return Nearest(None, -1, crossed, touched, True, refined)
    best, triangle = min(known, key=lambda one: one[0].distance)
    of_all = _of_all(best, [one for one, _ in known])
    return Nearest(of_all, triangle, crossed, touched, len(known) < len(found), refined)


def _refine(
    curved: CurvedShape, corners: npt.NDArray[np.float64], found: list[Signed | None]
) -> int:
    """Puts in place what exact arithmetic proves where bounds do not; of how many it was asked."""
    left = {k: one for k, one in enumerate(found) if one is not None and not one.exact}
    if left:
        from satcheck.audit.curved.exact.triangles import refined

        of_left = refined(curved.at(ORIGIN), corners[list(left)], list(left.values()))
        for k, one in zip(left, of_left, strict=True):
            found[k] = one
    return len(left)


def _of_all(best: Signed, known: Sequence[Signed]) -> Signed:
    """The distance is an estimate: the bounds of another triangle may reach lower than those of the
    one that looks nearest."""
    outcome = min((one.outcome for one in known), key=_OUTCOMES.index)
    return replace(
        best,
        lower=min(one.lower for one in known),
        upper=min(one.upper for one in known),
        outcome=outcome,
        exact=_is_exact(outcome, known),
    )


def _is_exact(outcome: Outcome, known: Sequence[Signed]) -> bool:
    """A shape touches triangles when it does one of them, and its inside meets none."""
    those = [one for one in known if one.outcome == outcome]
    if outcome != "touching":
        return all(one.exact for one in those)
    return any(one.exact for one in those) and all(one.lower >= 0 for one in those)


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
