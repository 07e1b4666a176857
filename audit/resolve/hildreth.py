"""The shortest translations, by the sum of their squares, that keep a set of walls.

Method: Clifford Hildreth, "A quadratic programming procedure" (1957): one wall after another, its
two bodies are moved apart (or back) until it is just kept, but never back by more than this wall
has moved them apart so far. For half spaces that is also the method of R. L. Dykstra, "An algorithm
for restricted least squares regression" (1983). Multipliers are kept between solutions: they are a
start from which the next one is near.

Many walls need many sweeps until the last digit is right. After a few the solver therefore aims a
little past each wall, so that all are kept soon.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from satcheck.audit.report import Vector
from satcheck.audit.resolve.wall import Wall
from satcheck.audit.vectors import added, dot, scaled

# Sweeps that aim exactly at the walls.
EXACT_SWEEPS = 100
# Sweeps after which the shortfall must have halved at least, or the walls exclude each other.
PATIENCE = 400
# How far past a wall is aimed then, and how well a wall is kept before, of the longest way.
OVERSHOOT = 1e-6
ROUNDOFF = 1e-15


@dataclass(frozen=True, slots=True)
class Projection:
    """broken: walls that are not kept, the worst first; the others are."""

    offsets: dict[int, Vector]
    broken: tuple[Wall, ...]


def project(walls: Sequence[Wall], held: dict[int, Vector]) -> Projection:
    """The shortest translations of the bodies of these walls; multipliers are updated in place.

    held: bodies that stay where they are, with their translation; a wall has at most one of them.
    """
    solver = _Solver(walls, held)
    return Projection(solver.solve(), tuple(solver.broken()))


class _Solver:
    def __init__(self, walls: Sequence[Wall], held: dict[int, Vector]) -> None:
        self._walls = walls
        self._held = held
        self._at: dict[int, Vector] = {}
        for wall in walls:
            for body in (wall.a, wall.b):
                self._at[body] = held.get(body, (0.0, 0.0, 0.0))
        for wall in walls:
            if wall.multiplier:
                self._push(wall, wall.multiplier)
        self._unit = max((abs(wall.least) for wall in walls), default=0.0)

    def solve(self) -> dict[int, Vector]:
        shortfall = self._shortfall()
        for sweep in range(1, 1 << 20):
            self._sweep(0.0 if sweep <= EXACT_SWEEPS else OVERSHOOT * self._unit, sweep % 2 == 0)
            if sweep % 8 and sweep > 8:
                continue
            if self._shortfall() <= (ROUNDOFF * self._unit if sweep <= EXACT_SWEEPS else 0.0):
                break
            if sweep % PATIENCE == 0:
                if self._shortfall() > 0.5 * shortfall:
                    break
                shortfall = self._shortfall()
        return {body: at for body, at in self._at.items() if body not in self._held}

    def broken(self) -> list[Wall]:
        """Those that rounding does not excuse."""
        least = OVERSHOOT * self._unit
        found = [(self._slack(wall), wall) for wall in self._walls]
        return [wall for slack, wall in sorted(found, key=_slack_of) if slack < -least]

    def _slack(self, wall: Wall) -> float:
        (ax, ay, az), (bx, by, bz) = self._at[wall.a], self._at[wall.b]
        return wall.slack((ax - bx, ay - by, az - bz))

    def _shortfall(self) -> float:
        return max((-self._slack(wall) for wall in self._walls), default=0.0)

    def _sweep(self, overshoot: float, backwards: bool) -> None:
        """Each wall once."""
        at = self._at
        for wall in reversed(self._walls) if backwards else self._walls:
            n = wall.normal
            (ax, ay, az), (bx, by, bz) = at[wall.a], at[wall.b]
            slack = n[0] * (ax - bx) + n[1] * (ay - by) + n[2] * (az - bz) - wall.least - overshoot
            movers = (wall.a not in self._held) + (wall.b not in self._held)
            push = max(-slack / movers, -wall.multiplier)
            if push:
                wall.multiplier += push
                self._push(wall, push)

    def _push(self, wall: Wall, push: float) -> None:
        if wall.a not in self._held:
            self._at[wall.a] = added(self._at[wall.a], scaled(wall.normal, push))
        if wall.b not in self._held:
            self._at[wall.b] = added(self._at[wall.b], scaled(wall.normal, -push))


def _slack_of(entry: tuple[float, Wall]) -> float:
    return entry[0]


def is_kept_by(walls: Sequence[Wall], offset: Vector) -> bool:
    return all(dot(wall.normal, offset) >= wall.least for wall in walls)
