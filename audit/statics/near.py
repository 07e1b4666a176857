"""Pairs of boxes that are within reach of each other."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

BLOCK = 1 << 18  # pairs compared at once
FEW = 1 << 10  # so few are compared at once without a look at the boxes around them


class TooManyNear(Exception):
    """More pairs are near each other than the caller can use."""


def near_boxes(
    low_a: Floats,
    high_a: Floats,
    low_b: Floats,
    high_b: Floats,
    reach: float,
    most: int | None = None,
) -> tuple[Indices, Indices]:
    """All pairs (i, j) of boxes (n, 3), (m, 3) whose coordinates are within reach on every axis.

    Boxes are halved until a product of two sets is small enough to compare at once. Raises
    TooManyNear for more than `most` pairs.
    """
    found_i: list[Indices] = []
    found_j: list[Indices] = []
    count = 0
    for i, j in _products(low_a, high_a, low_b, high_b, reach):
        gaps = np.maximum(low_a[i][:, None] - high_b[j], low_b[j] - high_a[i][:, None])
        k, m = np.nonzero((gaps <= reach).all(axis=2))
        found_i.append(i[k])
        found_j.append(j[m])
        count += k.size
        if most is not None and count > most:
            raise TooManyNear
    if not found_i:
        nobody = np.empty(0, dtype=np.int64)
        return nobody, nobody
    return np.concatenate(found_i), np.concatenate(found_j)


def _products(
    low_a: Floats, high_a: Floats, low_b: Floats, high_b: Floats, reach: float
) -> Iterator[tuple[Indices, Indices]]:
    pending = [(np.arange(len(low_a)), np.arange(len(low_b)))]
    while pending:
        i, j = pending.pop()
        if not (i.size and j.size):
            continue
        if i.size * j.size <= FEW:
            yield i, j
            continue
        low, high = low_b[j].min(axis=0) - reach, high_b[j].max(axis=0) + reach
        i = i[((low_a[i] <= high) & (high_a[i] >= low)).all(axis=1)]
        if not i.size:
            continue
        low, high = low_a[i].min(axis=0) - reach, high_a[i].max(axis=0) + reach
        j = j[((low_b[j] <= high) & (high_b[j] >= low)).all(axis=1)]
        if i.size * j.size <= BLOCK:
            yield i, j
        elif i.size >= j.size:
            pending += [(half, j) for half in _halves(i, low_a[i] + high_a[i])]
        else:
            pending += [(i, half) for half in _halves(j, low_b[j] + high_b[j])]


def _halves(index: Indices, centres: Floats) -> list[Indices]:
    axis = int(np.argmax(centres.max(axis=0) - centres.min(axis=0)))
    order = np.argsort(centres[:, axis], kind="stable")
    middle = len(index) // 2
    return [index[order[:middle]], index[order[middle:]]]


def cross(u: Floats, v: Floats) -> Floats:
    """Of rows (n, 3); np.cross takes ten times as long for a few of them."""
    product = np.empty(np.broadcast_shapes(u.shape, v.shape))
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        product[..., k] = u[..., i] * v[..., j] - u[..., j] * v[..., i]
    return product
