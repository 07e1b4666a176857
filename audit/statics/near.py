"""Pairs of boxes that are within reach of each other, and cross products."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from satcheck import core

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

TAKEN = 1 << 18  # pairs that come from the core together


class TooManyNear(Exception):
    """More pairs are near each other than the caller can use."""


def near_boxes(
    a: tuple[Floats, Floats],
    b: tuple[Floats, Floats] | None,
    reach: float,
    most: float = math.inf,
) -> tuple[Indices, Indices]:
    """Return all pairs (i, j) of a box of `a` and one of `b` that are no farther apart than this.

    a, b: the lower and the upper corners of boxes, each (n, 3); None: those of `a`, each pair once.
    Raises TooManyNear for more than `most` pairs.
    """
    ends = a if b is None else tuple(map(np.concatenate, zip(a, b, strict=True)))
    low, high = (list(map(tuple, end.tolist())) for end in ends)
    count = len(a[0])
    kinds = [int(b is not None and k >= count) for k in range(len(low))]
    exempt = [] if b is None else [(0, 0), (1, 1)]
    boxes = list(zip(low, high, strict=True))
    close = core.ClosePairs(boxes, [0.5 * reach] * len(boxes), kinds, exempt)
    found = [np.empty((0, 2), dtype=np.int64)]
    while taken := close.take(TAKEN):
        found.append(np.array(taken, dtype=np.int64))
        if sum(map(len, found)) > most:
            raise TooManyNear
    i, j = np.concatenate(found).T
    return i, j if b is None else j - count


def cross(u: Floats, v: Floats) -> Floats:
    """Of rows (n, 3); np.cross takes ten times as long for a few of them."""
    product = np.empty(np.broadcast_shapes(u.shape, v.shape))
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        product[..., k] = u[..., i] * v[..., j] - u[..., j] * v[..., i]
    return product
