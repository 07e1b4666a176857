"""Random convex shapes: point sets by kind, and curved shapes by their parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from satcheck import core
from tests.oracles.random_shapes import Points, random_hull

Rng = np.random.Generator


def _box(rng: Rng) -> Points:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    return np.asarray(signs * rng.uniform(0.2, 1.0, 3))


def _prism(rng: Rng) -> Points:
    sides = int(rng.integers(3, 13))
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1) * rng.uniform(0.3, 1.0)
    half = rng.uniform(0.1, 1.0)
    return np.concatenate([np.column_stack([ring, np.full(sides, z)]) for z in (-half, half)])


def _lattice(rng: Rng) -> Points:
    return rng.integers(-3, 4, (int(rng.integers(1, 10)), 3)).astype(float)


KINDS: dict[str, Callable[[Rng], Points]] = {
    "tetrahedra": lambda rng: random_hull(rng, 4),
    "small hulls": lambda rng: random_hull(rng, int(rng.integers(5, 17))),
    "large hulls": lambda rng: random_hull(rng, int(rng.integers(17, 65))),
    "boxes": _box,
    "prisms": _prism,
    "flats": lambda rng: random_hull(rng, int(rng.integers(3, 9))) * [1, 1, 0],
    "tilted flats": lambda rng: random_hull(rng, 4)[:3],
    "segments": lambda rng: random_hull(rng, 2),
    "points": lambda rng: random_hull(rng, 1),
    "needles": lambda rng: random_hull(rng, 8) * [*[10.0 ** rng.uniform(-9, -3)] * 2, 1],
    "slivers": lambda rng: random_hull(rng, 8) * [1, 1, 10.0 ** rng.uniform(-12, -3)],
    "lattice": _lattice,
    "decimals": lambda rng: _lattice(rng) / 10,
}


CURVED: dict[str, tuple[Callable[..., Any], int]] = {
    "spheres": (core.Sphere, 1),
    "capsules": (core.Capsule, 2),
    "cylinders": (core.Cylinder, 2),
    "cones": (core.Cone, 2),
    "ellipsoids": (lambda x, y, z: core.Ellipsoid((x, y, z)), 3),
    "box shapes": (lambda x, y, z: core.Box((x, y, z)), 3),
}


@dataclass(frozen=True, slots=True)
class Shapes:
    """Shapes of one kind: point sets, or what a constructor takes."""

    kind: str
    points: tuple[Points, ...] = ()
    parameters: tuple[tuple[float, ...], ...] = ()

    def __len__(self) -> int:
        return len(self.points) or len(self.parameters)

    def build(self, factor: float = 1.0) -> list[core.Shape]:
        """The shapes, grown around the origin of their frames."""
        if self.points:
            return [core.Hull(p * factor) for p in self.points]
        make = CURVED[self.kind][0]
        return [make(*(factor * x for x in p)) for p in self.parameters]

    def reordered(self, rng: Rng) -> Shapes:
        """The same point sets with their points in another order, and one of them twice."""
        mixed = [p[rng.permutation(len(p))] for p in self.points]
        return Shapes(self.kind, tuple(np.concatenate([p, p[:1]]) for p in mixed))

    def padded(self) -> Points:
        """(shapes, most points, 3): short sets repeat their first point."""
        most = max(len(p) for p in self.points)
        sets = [np.concatenate([p, np.repeat(p[:1], most - len(p), axis=0)]) for p in self.points]
        return np.stack(sets)


def draw(rng: Rng, kind: str, count: int, size: float = 1.0) -> Shapes:
    if kind in KINDS:
        return Shapes(kind, tuple(np.asarray(KINDS[kind](rng) * size) for _ in range(count)))
    width = CURVED[kind][1]
    rows = rng.uniform(0.2, 1.0, (count, width)) * size
    return Shapes(kind, (), tuple(tuple(row.tolist()) for row in rows))
