"""Walls: what two bodies ask of their translations so that they share no interior."""

from __future__ import annotations

from dataclasses import dataclass

from satcheck.audit.report.report import Vector
from satcheck.audit.vectors import dot

BodyPair = tuple[int, int]


@dataclass(slots=True)
class Wall:
    """normal . (t_a - t_b) >= least, for translations t of the bodies a and b, world frame.

    normal: unit; A goes along it to get away from B. multiplier: what the wall pushes A with, and B
    the other way, in the last solution (`least_motion`); a length.
    """

    a: int
    b: int
    normal: Vector
    least: float
    multiplier: float = 0.0

    def slack(self, offset: Vector) -> float:
        """By how much t_a - t_b = offset keeps the wall; negative: breaks it."""
        return dot(self.normal, offset) - self.least
