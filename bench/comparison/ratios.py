"""Turns, ratios and their spread, and the table: arithmetic without a clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from statistics import median
from typing import Any, Literal

from bench.accuracy.spread import Spread, spread
from bench.comparison.answers import Answers

# A row is slower or faster when the ratios of all its rounds are beyond these.
SLOWER, FASTER = 1.05, 0.95
# With fewer rounds, chance alone would do that to some of forty rows.
FEWEST_ROUNDS = 5
OLD, NEW = 0, 1
SIDES = ("OLD", "NEW")

Clock = Literal["cpu", "wall"]


@dataclass(frozen=True, slots=True)
class Sample:
    """One measurement of a row on one side, in seconds."""

    cpu: float
    wall: float
    answers: Answers


@dataclass(frozen=True, slots=True)
class Failure:
    reason: str


Outcome = Sample | Failure


def turns(round_: int) -> tuple[int, int]:
    """Which side comes first and which second: OLD NEW, NEW OLD, OLD NEW ..."""
    return (OLD, NEW) if round_ % 2 == 0 else (NEW, OLD)


@dataclass(slots=True)
class Line:
    """The outcomes of a row, OLD and NEW of a round at the same index."""

    bench: str
    name: str
    outcomes: tuple[list[Outcome], list[Outcome]] = field(default_factory=lambda: ([], []))

    @property
    def failures(self) -> list[str]:
        """A reason for each side that failed in any round."""
        return [
            f"{side}: {failed[0].reason}"
            for side, outcomes in zip(SIDES, self.outcomes, strict=True)
            if (failed := [each for each in outcomes if isinstance(each, Failure)])
        ]

    @property
    def differs(self) -> bool:
        """An answer of NEW contradicts that of OLD in a round."""
        return any(not old.answers.agree(new.answers) for old, new in self.pairs())

    def pairs(self) -> list[tuple[Sample, Sample]]:
        """OLD and NEW of each round in which both have a figure."""
        return [
            (old, new)
            for old, new in zip(*self.outcomes, strict=True)
            if isinstance(old, Sample) and isinstance(new, Sample)
        ]

    def seconds(self, side: int, clock: Clock) -> list[float]:
        return [getattr(pair[side], clock) for pair in self.pairs()]

    def ratios(self, clock: Clock) -> Spread | None:
        """NEW / OLD of the rounds; None where a side failed."""
        if self.failures:
            return None
        old, new = (self.seconds(side, clock) for side in (OLD, NEW))
        return spread(b / a for a, b in zip(old, new, strict=True))


def judged(lines: Sequence[Line], clock: Clock) -> dict[str, list[str]]:
    """The names of the rows by what is to be said of them."""
    found: dict[str, list[str]] = {
        "slower": [],
        "faster": [],
        "answers differ": [],
        "failed": [],
    }
    for line in lines:
        name = f"{line.bench}: {line.name}"
        ratio = line.ratios(clock)
        if ratio is None:
            found["failed"].append(name)
            continue
        if ratio.low > SLOWER and ratio.count >= FEWEST_ROUNDS:
            found["slower"].append(name)
        if ratio.high < FASTER and ratio.count >= FEWEST_ROUNDS:
            found["faster"].append(name)
        if line.differs:
            found["answers differ"].append(name)
    return found


def table(lines: Sequence[Line], clock: Clock) -> str:
    unit = "CPU ms" if clock == "cpu" else "wall ms"
    rows = [
        f"| bench | row | OLD, {unit} | NEW, {unit} | NEW / OLD | from | to | rounds | |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    return "\n".join([*rows, *(_row(line, clock) for line in lines)])


def _row(line: Line, clock: Clock) -> str:
    ratio = line.ratios(clock)
    if ratio is None:
        cells = ["-"] * 6
        note = "; ".join(line.failures)
    else:
        old, new = (1e3 * median(line.seconds(side, clock)) for side in (OLD, NEW))
        cells = [f"{old:.4g}", f"{new:.4g}", f"{ratio.median:.3f}"]
        cells += [f"{ratio.low:.3f}", f"{ratio.high:.3f}", str(ratio.count)]
        note = "answers differ" if line.differs else ""
    return f"| {line.bench} | {line.name} | {' | '.join(cells)} | {note} |"


def summary(lines: Sequence[Line], clock: Clock) -> str:
    """A line for each thing that is to be said of rows, "none" included."""
    found = judged(lines, clock)
    return "\n".join(f"{what}: {', '.join(names) or 'none'}" for what, names in found.items())


def record(line: Line) -> dict[str, Any]:
    """For JSON: the seconds of each round, or why there are none."""
    made: dict[str, Any] = {"bench": line.bench, "row": line.name, "differs": line.differs}
    for side, outcomes in zip(SIDES, line.outcomes, strict=True):
        made[side] = [
            {"cpu": each.cpu, "wall": each.wall}
            if isinstance(each, Sample)
            else {"failure": each.reason}
            for each in outcomes
        ]
    return made
