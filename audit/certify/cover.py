"""A cover of the translations that are shorter than the depth, computed in float64.

The checker proves in integers that it is a cover (`satcheck.verify.depth`). This module assigns to
each cube the pair of triangles whose polytope contains it with the largest margin. It splits a cube
that no polytope contains.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satcheck.report.certificate import Cover
from satcheck.verify import Rejected
from satcheck.verify.depth import (
    LEVELS,
    MOST_CUBES,
    SPLIT,
    Cube,
    children,
    is_outside,
    not_plain,
    root,
)
from satcheck.verify.pairs import Pair
from satcheck.verify.surfaces import near_pairs

Floats = NDArray[np.float64]
# So many pairs of triangles are candidates at most.
MOST_PAIRS = 200_000
# The search is repeated at most this often, without triangles that prove nothing.
MOST_SEARCHES = 4
# A polytope must exceed a cube by this share of the cube, so that rounding cannot uncover it.
ROOM = 1e-6


def cover(pair: Pair, depth: Fraction) -> Cover | None:
    """None: no cover was found within the limits."""
    if depth <= 0 or not (pair.a.world.solid and pair.b.world.solid):
        return None
    try:
        blocks = list(near_pairs(pair.a, pair.b, float(depth), MOST_PAIRS))
    except Rejected:
        return None
    if not blocks:
        return None
    i, j = (np.concatenate([block[side] for block in blocks]) for side in (0, 1))
    search = _Search(_corners(pair, 0, i), _corners(pair, 1, j), depth, pair.a.k)
    for _ in range(MOST_SEARCHES):
        if not search.run():
            return None
        used = sorted({leaf for leaf in search.cubes if leaf != SPLIT})
        unfit_a = not_plain(pair.a, np.unique(i[used]).tolist())
        unfit_b = not_plain(pair.b, np.unique(j[used]).tolist())
        if not unfit_a and not unfit_b:
            break
        search.leave_out(np.isin(i, unfit_a) | np.isin(j, unfit_b))
    else:
        return None
    number = {leaf: place for place, leaf in enumerate(used)} | {SPLIT: SPLIT}
    return Cover(
        tuple((int(i[leaf]), int(j[leaf])) for leaf in used),
        tuple(number[leaf] for leaf in search.cubes),
    )


def _corners(pair: Pair, side: int, triangles: Any) -> Floats:
    world = (pair.a, pair.b)[side].world
    corners: Floats = world.vertices[world.triangles[triangles]]
    return corners


class _Search:
    def __init__(self, s: Floats, t: Floats, depth: Fraction, k: int) -> None:
        """s, t: corners of the triangles of each pair, (n, 3, 3)."""
        e, f = np.roll(s, -1, axis=1) - s, np.roll(t, -1, axis=1) - t
        edges = np.cross(e[:, :, None], f[:, None]).reshape(len(s), 9, 3)
        faces = np.stack((np.cross(e[:, 0], e[:, 1]), np.cross(f[:, 0], f[:, 1])), axis=1)
        normals = np.concatenate((faces, edges), axis=1)
        lengths = np.linalg.norm(normals, axis=2, keepdims=True)
        size = np.linalg.norm(e, axis=2).max(axis=1) * np.linalg.norm(f, axis=2).max(axis=1)
        there = lengths[..., 0] > 1e-12 * size[:, None]
        self.normals = np.where(there[..., None], normals / np.where(lengths > 0, lengths, 1), 0.0)
        on_s = np.einsum("nfk,nck->nfc", self.normals, s)
        on_t = np.einsum("nfk,nck->nfc", self.normals, t)
        away = np.where(there, 0.0, np.inf)
        self.most = on_t.max(axis=2) - on_s.min(axis=2) + away
        self.least = on_t.min(axis=2) - on_s.max(axis=2) - away
        # A facet beyond the ball cuts nothing off. One next to it may come out on either side.
        beyond = float(depth) * (1 - 2.0**-50)
        self.most[self.most >= beyond] = np.inf
        self.least[self.least <= -beyond] = -np.inf
        self.widths = np.abs(self.normals).sum(axis=2)
        parallel = np.linalg.norm(np.cross(*np.moveaxis(self.normals[:, :2], 1, 0)), axis=1) < 1e-9
        self.usable = np.flatnonzero(~parallel & there[:, :2].all(axis=1))
        self.ball = (depth * (1 << k + LEVELS)) ** 2
        self.unit = 2.0 ** -(k + LEVELS)
        self.start = root(depth, k)
        self.cubes: list[int] = []

    def leave_out(self, pairs: Any) -> None:
        """pairs: a mask."""
        self.usable = self.usable[~pairs[self.usable]]

    def run(self) -> bool:
        """In the order in which the checker walks."""
        self.cubes = []
        pending = [(self.start, self.usable)]
        ball = int(self.ball)
        while pending:
            cube, candidates = pending.pop()
            if is_outside(cube, ball + 1):
                continue
            if len(self.cubes) >= MOST_CUBES:
                return False
            leaf, left = self._look(cube, candidates)
            self.cubes.append(leaf)
            if leaf == SPLIT:
                if not left.size or cube[1] & 1:
                    return False
                pending += [(child, left) for child in reversed(children(cube))]
        return True

    def _look(self, cube: Cube, candidates: Any) -> tuple[int, Any]:
        """The pair that holds the cube, or the pairs that may hold parts of it."""
        middle, half = np.array([c * self.unit for c in cube[0]]), cube[1] * self.unit
        along = self.normals[candidates] @ middle
        room = np.minimum(self.most[candidates] - along, along - self.least[candidates])
        widths = self.widths[candidates] * half
        inner = (room - widths).min(axis=1)
        best = int(inner.argmax()) if inner.size else -1
        if best >= 0 and inner[best] > ROOM * half:
            return int(candidates[best]), candidates
        return SPLIT, candidates[(room + widths > 0).all(axis=1)]
