"""Batches of placed pairs, each made from a seed: random ones, and ones at the edge of contact."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from satcheck import core
from tests.fuzz.shapes import CURVED, KINDS, Rng, Shapes, draw
from tests.oracles.random_shapes import Points

Share = Literal["random", "near", "curved"]
Query = Literal["overlap", "depth", "distance"]
SHARES: tuple[Share, ...] = ("random", "near", "curved")
CONSTRUCTIONS = ("lattice", "feature", "tuned", "coincident", "coplanar")

PAIRS = 4096
SMALLEST = 1e-60  # of coordinates other than 0: scaled, they stay in range
SHAPES = 128


@dataclass(frozen=True, slots=True)
class Batch:
    """n pairs: index_a[i] of `a` at pose_a[i], index_b[i] of `b` at pose_b[i]; poses (n, 7)."""

    name: str
    a: Shapes
    b: Shapes
    index_a: NDArray[np.uint32]
    index_b: NDArray[np.uint32]
    pose_a: Points
    pose_b: Points

    @property
    def curved(self) -> bool:
        return not (self.a.points and self.b.points)

    @property
    def turned(self) -> bool:
        return bool((self.pose_a[:, 3:6] != 0).any() or (self.pose_b[:, 3:6] != 0).any())

    def ask(self, query: Query, factor: float = 1.0, method: Any = "auto") -> core.PairResults:
        """The answers when everything is `factor` times as large."""
        shapes = [*self.a.build(factor), *self.b.build(factor)]
        scale = np.array([factor] * 3 + [1.0] * 4)
        index_b = self.index_b + np.uint32(len(self.a))
        poses = self.pose_a * scale, self.pose_b * scale
        return core.check_pairs(
            shapes, self.index_a, index_b, *poses, query=query, method=method, threads=1
        )

    def swapped(self) -> Batch:
        return Batch(
            self.name, self.b, self.a, self.index_b, self.index_a, self.pose_b, self.pose_a
        )

    def moved(self, offset: Points) -> Batch:
        """A moved by (n, 3)."""
        pose_a = self.pose_a.copy()
        pose_a[:, :3] += offset
        return replace(self, pose_a=pose_a)

    def reordered(self, rng: Rng) -> Batch:
        return replace(self, a=self.a.reordered(rng), b=self.b.reordered(rng))

    def rows(self, rows: NDArray[np.intp]) -> Batch:
        index = self.index_a[rows], self.index_b[rows]
        return Batch(self.name, self.a, self.b, *index, self.pose_a[rows], self.pose_b[rows])

    def world(self) -> tuple[Points, Points]:
        """Vertices (n, most, 3) as placed; where not turned, those that the core sees."""
        sides = ((self.a, self.index_a, self.pose_a), (self.b, self.index_b, self.pose_b))
        a, b = (place(shapes.padded()[index], pose) for shapes, index, pose in sides)
        return a, b

    def size(self) -> Points:
        """(n,) an upper bound of the coordinates that matter: radii plus translations."""
        total = np.zeros(len(self.pose_a))
        sides = ((self.a, self.index_a, self.pose_a), (self.b, self.index_b, self.pose_b))
        for shapes, index, pose in sides:
            radius = [float(np.abs(p).sum(axis=1).max()) for p in shapes.points]
            radius = radius or [3 * max(p) for p in shapes.parameters]
            total += np.array(radius)[index] + np.abs(pose[:, :3]).sum(axis=1)
        return total


def place(points: Points, pose: Points) -> Points:
    """(n, m, 3) at poses (n, 7)."""
    x, y, z, w = (pose[:, 3:] / np.linalg.norm(pose[:, 3:], axis=1)[:, None]).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    rotation = np.moveaxis(np.array(rows), 2, 0)
    return np.asarray(np.einsum("nij,nmj->nmi", rotation, points) + pose[:, None, :3])


def make_batch(share: Share, seed: int, number: int) -> Batch:
    rng = np.random.default_rng([seed, SHARES.index(share), number])
    if share == "near":
        return _near(rng)
    kinds = [*CURVED, "small hulls", "boxes"] if share == "curved" else list(KINDS)
    kind_a = str(rng.choice(list(CURVED) if share == "curved" else kinds))
    kind_b = str(rng.choice(kinds))
    size_a, size_b = _sizes(rng)
    a, b = draw(rng, kind_a, SHAPES, size_a), draw(rng, kind_b, SHAPES, size_b)
    spread = max(size_a, size_b) * rng.uniform(0.3, 1.2)
    batch = _at_random(rng, f"{kind_a} x {kind_b}", a, b, spread, turned=True)
    return _shifted(batch, _offset(rng))


def _sizes(rng: Rng) -> tuple[float, float]:
    """Mostly alike, a fifth of the time up to a million times different."""
    return 1.0, float(10 ** rng.uniform(-6, 6)) if rng.random() < 0.2 else 1.0


def _offset(rng: Rng) -> Points:
    """Mostly none, a fifth of the time 1e6 to 1e9 away."""
    if rng.random() >= 0.2:
        return np.zeros(3)
    return np.asarray(rng.uniform(-1, 1, 3) * 10 ** rng.uniform(6, 9))


def _poses(rng: Rng, spread: float, turned: bool) -> Points:
    pose = np.zeros((PAIRS, 7))
    pose[:, :3] = rng.normal(size=(PAIRS, 3)) * spread
    pose[:, 3:] = rng.normal(size=(PAIRS, 4)) if turned else [0, 0, 0, 1]
    return pose


def _at_random(rng: Rng, name: str, a: Shapes, b: Shapes, spread: float, turned: bool) -> Batch:
    index_a, index_b = (rng.integers(0, len(s), PAIRS, dtype=np.uint32) for s in (a, b))
    poses = _poses(rng, 0.0, turned), _poses(rng, spread, turned)
    return Batch(name, a, b, index_a, index_b, *poses)


def _shifted(batch: Batch, offset: Points) -> Batch:
    shift = np.concatenate([offset, np.zeros(4)])
    return replace(batch, pose_a=batch.pose_a + shift, pose_b=batch.pose_b + shift)


def _near(rng: Rng) -> Batch:
    construction = str(rng.choice(CONSTRUCTIONS))
    size_a, size_b = _sizes(rng)
    kinds = list(KINDS)
    if construction == "lattice":
        kinds, size_b = ["lattice", "decimals"], size_a
    kind_a, kind_b = (str(k) for k in rng.choice(kinds, 2))
    if construction == "lattice":
        kind_b = kind_a
    a, b = draw(rng, kind_a, SHAPES, size_a), draw(rng, kind_b, SHAPES, size_b)
    if construction == "coincident":
        b, kind_b = a.reordered(rng), kind_a
    if construction == "coplanar":
        a, b = (Shapes(s.kind, tuple(p * [1, 1, 0] for p in s.points)) for s in (a, b))
    turned = construction == "tuned" and rng.random() < 0.3
    batch = _at_random(rng, f"{construction}: {kind_a} x {kind_b}", a, b, size_a + size_b, turned)
    if construction == "coincident":
        batch = replace(batch, index_b=batch.index_a)
    translation = _translation(rng, construction, batch)
    pose_b = batch.pose_b.copy()
    pose_b[:, :3] = np.where(np.abs(translation) < SMALLEST, 0, translation)
    offset = _offset(rng)
    if construction == "lattice":
        offset = np.rint(offset)
    return _shifted(replace(batch, pose_b=pose_b), offset)


def _translation(rng: Rng, construction: str, batch: Batch) -> Points:
    """Where B goes (n, 3)."""
    if construction == "lattice":
        steps = rng.integers(-4, 5, (PAIRS, 3))
        return np.asarray(steps / 10.0 if batch.a.kind == "decimals" else steps.astype(float))
    if construction == "coincident":
        unit = float(np.finfo(float).eps)
        return np.asarray(rng.integers(-2, 3, (PAIRS, 3)) * unit * rng.integers(0, 2, (PAIRS, 1)))
    if construction == "feature":
        return _onto_feature(rng, batch)
    found = batch.ask("depth")
    gaps = 10 ** rng.uniform(-17, -3, PAIRS) * rng.choice([-1, 0, 1], PAIRS)
    shift = (gaps - np.asarray(found.distance))[:, None] * np.asarray(found.normal)
    if construction == "coplanar":
        shift[:, 2] = 0
    return np.asarray(batch.pose_b[:, :3] + shift)


def _onto_feature(rng: Rng, batch: Batch) -> Points:
    """The lowest vertex of B onto a mixture of the highest ones of A, along an axis or any way."""
    a, b = batch.a.padded()[batch.index_a], batch.b.padded()[batch.index_b]
    along = rng.normal(size=(PAIRS, 3))
    axes = np.eye(3)[rng.integers(0, 3, PAIRS)] * rng.choice([-1, 1], (PAIRS, 1))
    along = np.where(rng.random((PAIRS, 1)) < 0.5, axes, along)
    height = np.einsum("nmj,nj->nm", a, along)
    top = height >= height.max(axis=1)[:, None] - 1e-12
    weight = rng.integers(0, 3, height.shape) * top
    weight = np.where(weight.any(axis=1)[:, None], weight, top).astype(float)
    target = np.einsum("nm,nmj->nj", weight / weight.sum(axis=1)[:, None], a)
    lowest = np.einsum("nmj,nj->nm", b, along).argmin(axis=1)
    return np.asarray(target - b[np.arange(PAIRS), lowest])
