"""The cost of accuracy in time: plain frozen data, `satcheck.tradeoff/1`, and its way into JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.tradeoff.pareto import Times, front
from satcheck.audit.tradeoff.rungs import Rung
from satcheck.report.report import OVERLAPS, Relation, Tool

SCHEMA = "satcheck.tradeoff/1"

State = Literal["answered", "failed", "not run"]


class Figure(Struct, frozen=True):
    """value: the figure a rung gives. low, high: what it leaves open; None: no bound."""

    value: float
    low: float | None
    high: float | None

    @property
    def width(self) -> float | None:
        return None if self.low is None or self.high is None else self.high - self.low


class Truth(Struct, frozen=True):
    """The proof of the exact rung; relation, figure: None where it has not, reason says why.

    pad: what the rounding of a coordinate can make of a length. thickness: 0 where there is no
    overlap; None: not known.
    """

    relation: Relation | None
    figure: Figure | None
    pad: float
    reason: str | None = None
    thickness: Figure | None = None

    def error(self, said: Figure | None) -> float | None:
        """The figure minus the nearest signed distance that is possible; 0.0 within rounding.
        Negative: closer or deeper than the bodies are."""
        return self._off(said, self.figure)

    def thickness_error(self, said: Figure | None) -> float | None:
        """The same of a thickness. Positive: thicker than the overlap is."""
        return self._off(said, self.thickness)

    def _off(self, said: Figure | None, true: Figure | None) -> float | None:
        if said is None or true is None:
            return None
        low, high = true.low, true.high
        if low is None or high is None:
            return None
        nearest = min(max(said.value, low), high)
        error = said.value - nearest
        return 0.0 if abs(error) <= self.pad else error

    def is_right(self, overlap: bool | None, relation: Relation | None) -> bool | None:
        """Return whether an answer agrees. That bodies overlap is what a rung can know: `contains`,
        `inside` and `coincident` are overlaps like any. relation: None where only that is said."""
        if self.relation is None or overlap is None:
            return None
        if overlap != (self.relation in OVERLAPS):
            return False
        return overlap or relation in (None, self.relation)


class Row(Struct, frozen=True, kw_only=True):
    """A rung and what came of it.

    reason: why it failed, was not run, or cannot say. overlap: None where it cannot say. relation:
    None for the Boolean, which knows only whether there is a volume in common; where the inside of
    a body could not be checked, that of the surfaces. proven: it has proven how the bodies relate.
    right: held against the truth; None: one of the two is not known. figure: the signed
    distance. error: see Truth.error. thickness: of an overlap, by what stood for the bodies;
    thickness_error: see Truth; thickness_times: of its search. settled_by: the rung at which its
    climb ended. cold: nothing kept from before; cached: with the parts on disk, or the child
    process running. cpu: of the cold runs, child processes included. on_front: of error against
    time.
    """

    rung: Rung
    state: State
    reason: str | None = None
    overlap: bool | None = None
    relation: Relation | None = None
    proven: bool = False
    right: bool | None = None
    figure: Figure | None = None
    error: float | None = None
    thickness: Figure | None = None
    thickness_error: float | None = None
    thickness_times: Times | None = None
    volume: float | None = None
    volume_error: float | None = None
    settled_by: str | None = None
    cold: Times | None = None
    cached: Times | None = None
    cpu: Times | None = None
    on_front: bool = False

    @property
    def size_of_error(self) -> float | None:
        return None if self.error is None else abs(self.error)

    @property
    def ended_lower(self) -> bool:
        """Its climb ended before its own rung."""
        return self.settled_by not in (None, self.rung.name)

    @property
    def standing(self) -> int:
        """0: proven, 1: a guess that is right or cannot be judged, 2: wrong."""
        if self.right is False:
            return 2
        return 0 if self.proven else 1

    def to_dict(self) -> dict[str, Any]:
        figure = self.figure
        return {
            "rung": self.rung.name,
            "threshold": self.rung.threshold,
            "state": self.state,
            "reason": self.reason,
            "overlap": self.overlap,
            "relation": self.relation,
            "proven": self.proven,
            "right": self.right,
            "signed_distance": None if figure is None else figure.value,
            "bounds": _bounds(figure),
            "width": None if figure is None else figure.width,
            "error": self.error,
            "thickness": None if self.thickness is None else self.thickness.value,
            "thickness_bounds": _bounds(self.thickness),
            "thickness_error": self.thickness_error,
            "thickness_times": _times(self.thickness_times),
            "volume": self.volume,
            "volume_error": self.volume_error,
            "settled_by": self.settled_by,
            "cold": _times(self.cold),
            "cached": _times(self.cached),
            "cpu": _times(self.cpu),
            "pareto": self.on_front,
        }


def _bounds(figure: Figure | None) -> list[float | None] | None:
    return None if figure is None else [figure.low, figure.high]


def _times(times: Times | None) -> dict[str, Any] | None:
    return None if times is None else times.to_dict()


class ClimbEnd(Struct, frozen=True):
    """The rung at which a plain check ends its climb, whether that settles the relation, and what
    each step said."""

    rung: str
    settled: bool
    why: str

    def to_dict(self) -> dict[str, Any]:
        return {"rung": self.rung, "settled": self.settled, "why": self.why}


class PairTradeoff(Struct, frozen=True):
    """default: None where the budget was spent before anything ran."""

    a: str
    b: str
    truth: Truth
    default: ClimbEnd | None
    rows: tuple[Row, ...]

    @property
    def overlap(self) -> bool | None:
        return None if self.truth.relation is None else self.truth.relation in OVERLAPS

    def to_dict(self) -> dict[str, Any]:
        truth = self.truth
        return {
            "a": self.a,
            "b": self.b,
            "truth": {
                "relation": truth.relation,
                "bounds": _bounds(truth.figure),
                "thickness_bounds": _bounds(truth.thickness),
                "reason": truth.reason,
            },
            "default": None if self.default is None else self.default.to_dict(),
            "rungs": [row.to_dict() for row in self.rows],
        }


class Tradeoff(Struct, frozen=True):
    """left_out: how many more pairs have boxes that meet. spent: seconds."""

    tool: Tool
    units: str | None
    repeat: int
    budget: float
    spent: float
    pairs: tuple[PairTradeoff, ...]
    left_out: int

    @property
    def complete(self) -> bool:
        """Every rung of every pair has answered, and the truth is known."""
        return all(
            pair.truth.relation is not None and all(row.state == "answered" for row in pair.rows)
            for pair in self.pairs
        )

    def to_dict(self) -> dict[str, Any]:
        return {
            "schema": SCHEMA,
            "tool": {"name": self.tool.name, "version": self.tool.version},
            "units": self.units,
            "settings": {"repeat": self.repeat, "budget": self.budget},
            "seconds": self.spent,
            "left_out": self.left_out,
            "pairs": [pair.to_dict() for pair in self.pairs],
        }


def choices(rows: Sequence[Row]) -> list[Row]:
    """Without those that climbed no further than a lower rung and say what that says: they are that
    rung again."""
    figures: dict[str | None, Figure | None] = {row.rung.name: row.figure for row in rows}
    return [row for row in rows if not row.ended_lower or row.figure != figures.get(row.settled_by)]


def with_front(rows: Sequence[Row], pad: float) -> tuple[Row, ...]:
    """The rows with their marks. pad: of the truth."""
    compared = choices(rows)
    on_front = {row.rung for row, mark in zip(compared, front(compared, pad), strict=True) if mark}
    return tuple(replace(row, on_front=row.rung in on_front) for row in rows)
