"""How long the runs of a rung took."""

from __future__ import annotations

from statistics import median, quantiles
from typing import Any

from msgspec import Struct


class Times(Struct, frozen=True):
    """Seconds of every run, in the order in which they ran; one at least."""

    runs: tuple[float, ...]

    @property
    def median(self) -> float:
        return median(self.runs)

    def is_below(self, other: Times) -> bool:
        """By more than chance: each median lies outside of the middle half of the other's runs.
        Then a slow moment of the machine makes nothing faster or slower than something else."""
        return self.median < other._quartiles()[0] and self._quartiles()[1] < other.median

    def _quartiles(self) -> tuple[float, float]:
        if len(self.runs) == 1:
            return self.runs[0], self.runs[0]
        first, _, third = quantiles(self.runs, n=4, method="inclusive")
        return first, third

    def to_dict(self) -> dict[str, Any]:
        low, high = min(self.runs), max(self.runs)
        micro = {"median": self.median, "low": low, "high": high}
        return {key: 1e6 * value for key, value in micro.items()} | {"runs": len(self.runs)}
