"""Which pairs of world boxes are close enough to be asked about.

Method: Jonathan D. Cohen, Ming C. Lin, Dinesh Manocha, Madhav K. Ponamgi, "I-COLLIDE: An
Interactive and Exact Collision Detection System for Large-Scale Environments" (1995), the sweep.
We sort once, along the axis on which the boxes spread most, and keep no coherence: a check sees
one instant. Above a few hundred boxes the sweep runs on arrays.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from satcheck.audit.boxes import Box, box_gap, largest_coordinate
from satcheck.audit.tolerances import rounding_pad

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

# Above this many boxes the import of numpy (about 0.1 s) costs less than the plain sweep.
ARRAY_SWEEP = 400


def close_pairs(boxes: Sequence[Box], asked: Sequence[float]) -> list[tuple[int, int]]:
    """Pairs (i, j), i < j, sorted, whose boxes are at most asked[i] + asked[j] apart.

    Lengths in world units. No close pair is missed: the sweep reaches a rounding further, the gap
    of the boxes then decides, and that is a proven lower bound.
    """
    if len(boxes) < 2:
        return []
    pad = rounding_pad(largest_coordinate(*boxes))
    reach = [length + pad for length in asked]
    axis = _spread_axis(boxes)
    sweep = _sweep_arrays if len(boxes) > ARRAY_SWEEP else _sweep
    candidates = sweep(boxes, reach, axis)
    return sorted(
        (i, j) for i, j in candidates if box_gap(boxes[i], boxes[j]) <= asked[i] + asked[j]
    )


def _spread_axis(boxes: Sequence[Box]) -> int:
    spreads = []
    for axis in range(3):
        centres = [0.5 * low[axis] + 0.5 * high[axis] for low, high in boxes]
        spreads.append(max(centres) - min(centres))
    return spreads.index(max(spreads))


def _sweep(boxes: Sequence[Box], reach: Sequence[float], axis: int) -> list[tuple[int, int]]:
    order = sorted(range(len(boxes)), key=lambda i: boxes[i][0][axis] - reach[i])
    active: list[int] = []
    found = []
    for i in order:
        start = boxes[i][0][axis] - reach[i]
        active = [j for j in active if boxes[j][1][axis] + reach[j] >= start]
        found += [(min(i, j), max(i, j)) for j in active]
        active.append(i)
    return found


def _sweep_arrays(boxes: Sequence[Box], reach: Sequence[float], axis: int) -> list[tuple[int, int]]:
    import numpy as np

    corners = np.asarray(boxes, dtype=np.float64)
    margin = np.asarray(reach, dtype=np.float64)[:, None]
    low, high = corners[:, 0] - margin, corners[:, 1] + margin
    order = np.argsort(low[:, axis], kind="stable")
    low, high = low[order], high[order]
    end = np.searchsorted(low[:, axis], high[:, axis], side="right")
    across = [k for k in range(3) if k != axis]
    found: list[tuple[int, int]] = []
    for i in range(len(boxes)):
        later = slice(i + 1, int(end[i]))
        meets = _meet(low[later], high[later], low[i], high[i], across)
        first = int(order[i])
        found += [(min(first, int(j)), max(first, int(j))) for j in order[later][meets]]
    return found


def _meet(
    low: npt.NDArray[np.float64],
    high: npt.NDArray[np.float64],
    one_low: npt.NDArray[np.float64],
    one_high: npt.NDArray[np.float64],
    axes: list[int],
) -> Any:
    return ((low[:, axes] <= one_high[axes]) & (one_low[axes] <= high[:, axes])).all(axis=1)
