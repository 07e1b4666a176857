"""The trace of one pair: which steps ran, and which could not."""

from __future__ import annotations

from time import perf_counter_ns
from typing import TYPE_CHECKING

from satcheck.report.report import Issue, Stage

if TYPE_CHECKING:
    from satcheck.core import Climb

NANOSECONDS_PER_MICROSECOND = 1000.0


class Trace:
    """Stages in the order they ran, each with the time since the one before."""

    __slots__ = ("_since", "issues", "stages")

    def __init__(self) -> None:
        self.stages: list[Stage] = []
        self.issues: list[Issue] = []
        self._since = perf_counter_ns()

    def record(self, stage: str, result: str, detail: str = "") -> None:
        now = perf_counter_ns()
        elapsed = (now - self._since) / NANOSECONDS_PER_MICROSECOND
        self.stages.append(Stage(stage, result, elapsed, detail))
        self._since = now

    def add_since(self, stage: str, result: str, detail: str, nanoseconds: int) -> None:
        """Records a stage of which this much time ran earlier, elsewhere."""
        self._since -= nanoseconds
        self.record(stage, result, detail)

    def climbed(self, climb: Climb) -> None:
        """Records the rungs of the core, with its texts."""
        self.stages += climb.stages(Stage)

    def add(self, stage: str, result: str, detail: str, nanoseconds: int) -> None:
        """Records a stage that ran elsewhere."""
        elapsed = nanoseconds / NANOSECONDS_PER_MICROSECOND
        self.stages.append(Stage(stage, result, elapsed, detail))

    def complain(self, code: str, body: str | None, message: str) -> None:
        """A warning about this pair; the same one from several pairs is reported once."""
        self.issues.append(Issue(code, "warning", body, None, message))
