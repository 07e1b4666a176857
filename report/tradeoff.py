"""What accuracy costs in time: each rung of the ladder on the same pair, against the exact one."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from satcheck.report.values import Count, Length, Relation, Size, Tool, Value

RungName = Literal["aabb", "obb", "hull", "parts", "exact", "boolean"]
# Of a signed distance; null: no such bound.
Bounds = tuple[float | None, float | None]


class Times(Value, frozen=True):
    """Microseconds of so many runs."""

    median: Length
    low: Length
    high: Length
    runs: Annotated[int, Meta(ge=1)]


class Row(Value, frozen=True, kw_only=True):
    """A rung, and what came of it. A signed distance is a gap > 0, or an overlap < 0, as deep as
    the shortest translation that ends it.

    threshold: of the convex parts. reason: why it failed, was not run, or cannot say. overlap:
    null: it cannot say. relation: null for the Boolean, which knows only whether there is a common
    volume; of the surfaces alone if overlap is null. proven: how the bodies relate is proven.
    right: compared with the truth; null: one of the two is not known. error: the signed distance
    minus the nearest one that the truth allows; negative: closer or deeper than the bodies are.
    settled_by: the rung at which its climb ended. cold: nothing kept from before; cpu: of these
    runs, with child processes (not on Windows). cached: the convex parts are on disk, or the child
    process runs.
    """

    rung: RungName
    threshold: Size | None = None
    state: Literal["answered", "failed", "not run"]
    reason: str | None = None
    overlap: bool | None = None
    relation: Relation | None = None
    proven: bool = False
    right: bool | None = None
    signed_distance: float | None = None
    bounds: Bounds | None = None
    error: float | None = None
    volume: Length | None = None
    volume_error: Length | None = None
    settled_by: RungName | None = None
    cold: Times | None = None
    cached: Times | None = None
    cpu: Times | None = None

    @property
    def label(self) -> str:
        """`hull`, `parts 0.05`."""
        return self.rung if self.threshold is None else f"{self.rung} {self.threshold:g}"


class Truth(Value, frozen=True):
    """What the exact rung proves. relation, bounds: null: it does not; reason says why."""

    relation: Relation | None
    bounds: tuple[float, float] | None
    reason: str | None


class TradeoffReport(Value, frozen=True, kw_only=True):
    """Lengths in `units`, null if the files state none. repeat: runs of each rung. budget: seconds
    that they may take together; seconds: that they took. default: the rung that settles a check by
    `satcheck A B`; null: none does, or there was no time to see."""

    schema: Literal["satcheck.tradeoff/1"] = "satcheck.tradeoff/1"
    tool: Tool
    units: str | None
    repeat: Count
    budget: Size
    seconds: Length
    a: str
    b: str
    truth: Truth
    default: RungName | None
    rungs: tuple[Row, ...]

    @property
    def complete(self) -> bool:
        """Each rung has answered, and the truth is known."""
        answered = all(row.state == "answered" for row in self.rungs)
        return answered and self.truth.relation is not None
