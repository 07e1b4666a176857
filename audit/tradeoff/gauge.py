"""The remaining budget, and the measurements of a rung so far."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from time import monotonic

from satcheck.audit.tradeoff.result import State
from satcheck.audit.tradeoff.rungs import Rung
from satcheck.audit.tradeoff.runs import LadderRun, VolumeRun

SPENT = "budget"


class Budget:
    """Wall-clock seconds for a whole run, and for all runs of one rung on one pair."""

    def __init__(self, seconds: float, per_rung: float = math.inf) -> None:
        self.seconds = seconds
        self.per_rung = per_rung
        self._start = monotonic()

    @property
    def spent(self) -> float:
        return monotonic() - self._start

    @property
    def left(self) -> float:
        return self.seconds - self.spent

    def share(self, waiting: int) -> Budget:
        """Return a share of what is left, for one of so many that wait."""
        return Budget(self.left / waiting, self.per_rung)


@dataclass(slots=True)
class Gauge:
    """The measurements of a rung so far."""

    rung: Rung
    state: State = "not run"
    reason: str | None = SPENT
    answer: LadderRun | VolumeRun | None = None
    cold: list[float] = field(default_factory=list)
    cached: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)
    thickness: list[float] = field(default_factory=list)
    longest: float = 0.0
    spent: float = 0.0
    stopped_after: float | None = None

    @property
    def wants_more(self) -> bool:
        """It has answered, or has not been asked."""
        return self.state == "answered" or self.reason == SPENT

    def left(self, budget: Budget) -> float:
        return min(budget.left, budget.per_rung - self.spent)

    def stop(self, limit: float) -> None:
        """A run did not end within this; what an earlier one has answered stands."""
        self.longest, self.stopped_after = math.inf, limit
        if self.state != "answered":
            self.reason = f"{SPENT}: stopped after {limit:.3g} s"

    def fail(self, reason: str) -> None:
        self.state, self.reason = "failed", reason

    def saw(self, answer: LadderRun | VolumeRun, cold: float, cached: float | None) -> None:
        self.state, self.reason = "answered", None
        self.answer = self.answer or answer
        self.cold.append(cold)
        if isinstance(answer, LadderRun):
            self.cpu.append(answer.cpu)
            if answer.thickness is not None:
                self.thickness.append(answer.thickness.seconds)
        if cached is not None:
            self.cached.append(cached)
