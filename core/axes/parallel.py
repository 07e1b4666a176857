"""Which of many axes are one axis, because they are parallel within the precision of the input."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satcheck.core.axes.shadows import Floats, Indices

# In no special position to the axes of any model: projections on it tell most directions apart.
_GENERIC = np.array([0.5384, 0.3217, 0.7789])


def first_parallel(unit: Floats, tolerance: Floats) -> Indices:
    """For each axis the first one to which it is parallel, itself if there is none before it.

    unit: (n, 3). tolerance: (n,), radians: how far each may be off. A direction and its opposite
    are one axis.
    """
    generic = _GENERIC / np.linalg.norm(_GENERIC)
    key = (unit * generic).sum(axis=1) ** 2
    order = np.argsort(key, kind="stable")
    ranked = key[order]
    # The square of a cosine changes by at most twice the angle.
    reach = 2 * (tolerance + tolerance.max(initial=0.0)) + 1e-15
    low = np.searchsorted(ranked, key - reach, side="left")
    high = np.searchsorted(ranked, key + reach, side="right")
    first: NDArray[np.int64] = np.full(len(unit), -1)
    for k in range(len(unit)):
        if first[k] >= 0:
            continue
        near = order[low[k] : high[k]]
        near = near[first[near] < 0]
        sine = np.linalg.norm(np.cross(unit[near], unit[k]), axis=1)
        first[near[sine <= tolerance[near] + tolerance[k]]] = k
        first[k] = k
    return first
