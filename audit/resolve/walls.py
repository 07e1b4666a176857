"""Walls between bodies, and the shortest translations that keep a set of them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from msgspec import Struct

from satcheck import core
from satcheck.audit.vectors import added, dot, scaled
from satcheck.core.conventions import Vector

BodyPair = tuple[int, int]

ORIGIN: Vector = (0.0, 0.0, 0.0)
# Shares of the longest way that a wall requires. MISSED: a wall that is missed by less does not
# contradict others. NOISE: rounding of a translation.
MISSED = 1e-3
NOISE = 1e-11


class Wall(Struct):
    """normal . (t_a - t_b) >= least, for translations t of the bodies a and b, world frame.

    normal: unit; A moves along it to leave B. multiplier: a length, how strongly the wall pushed A
    and B apart in the last solution (`least_motion`).
    """

    a: int
    b: int
    normal: Vector
    least: float
    multiplier: float = 0.0

    def slack(self, offset: Vector) -> float:
        """The distance by which t_a - t_b = offset keeps the wall; negative: it breaks the wall."""
        return dot(self.normal, offset) - self.least


class Motion(Struct, frozen=True):
    """broken: walls that are not kept, because they exclude each other, the worst first."""

    offsets: dict[int, Vector]
    broken: tuple[Wall, ...]


def least_motion(walls: Sequence[Wall], held: Mapping[int, Vector]) -> Motion:
    """The least motion of the bodies of these walls. It stores the multipliers of the walls for the
    next call.

    held: bodies that stay where they are, with their translation; a wall has at most one of them.
    """
    bodies = sorted({body for wall in walls for body in (wall.a, wall.b)})
    place = {body: k for k, body in enumerate(bodies)}
    fixed = [
        dot(wall.normal, added(held.get(wall.a, ORIGIN), scaled(held.get(wall.b, ORIGIN), -1.0)))
        for wall in walls
    ]
    translations, multipliers = core.least_motion(
        [body not in held for body in bodies],
        [(place[wall.a], place[wall.b]) for wall in walls],
        [wall.normal for wall in walls],
        [wall.least - shift for wall, shift in zip(walls, fixed, strict=True)],
        [wall.multiplier for wall in walls],
    )
    for wall, multiplier in zip(walls, multipliers, strict=True):
        wall.multiplier = multiplier
    unit = max((abs(wall.least) for wall in walls), default=0.0)
    at = {
        body: held.get(body) or _clean(translations[place[body]], NOISE * unit) for body in bodies
    }
    missed = [(wall.slack(added(at[wall.a], scaled(at[wall.b], -1.0))), wall) for wall in walls]
    missed.sort(key=lambda entry: entry[0])
    return Motion(
        {body: at[body] for body in bodies if body not in held},
        tuple(wall for slack, wall in missed if slack < -MISSED * unit),
    )


def _clean(offset: Vector, noise: float) -> Vector:
    x, y, z = (0.0 if abs(c) <= noise else c for c in offset)
    return x, y, z


def connected(walls: Sequence[Wall], movable: Collection[int]) -> list[list[Wall]]:
    """The walls by connected component; bodies that stay connect nothing. In the order of their
    first walls, each with its walls in the order given. Union-find with path halving."""
    parent = {body: body for wall in walls for body in (wall.a, wall.b) if body in movable}

    def root(body: int) -> int:
        while parent[body] != body:
            parent[body] = parent[parent[body]]
            body = parent[body]
        return body

    for wall in walls:
        if wall.a in parent and wall.b in parent:
            parent[root(wall.b)] = root(wall.a)
    components: dict[int, list[Wall]] = {}
    for wall in walls:
        components.setdefault(root(wall.a if wall.a in parent else wall.b), []).append(wall)
    return list(components.values())
