"""What each rung cost and got wrong, over all pairs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from bench.accuracy.spread import Spread, spread
from bench.accuracy.stages import SETTLED_EARLY, kind_of
from bench.accuracy.verdicts import OUTCOMES, Outcome, outcome, overlaps

Record = dict[str, Any]
Row = dict[str, Any]
PARTS, EXACT = "parts", "exact"
_MICROSECONDS = 1e6


@dataclass(frozen=True, slots=True)
class Errors:
    """Of the signed distance, without its sign, in sizes of the smaller body."""

    apart: Spread | None
    overlapping: Spread | None


@dataclass(frozen=True, slots=True)
class RungSummary:
    """False proofs: verdicts said to be proven that are wrong. The rest is of the `pairs` on which
    it worked: times in seconds, medians of a pair's runs; steadiness: slowest over fastest
    run."""

    label: str
    outcomes: dict[Outcome, int]
    false_proofs: int
    pairs: int
    cold: Spread | None
    cached: Spread | None
    steadiness: Spread | None
    errors: Errors

    @property
    def judged(self) -> int:
        return sum(self.outcomes[kind] for kind in ("right", "false hit", "miss"))


@dataclass(frozen=True, slots=True)
class Step:
    """From a rung to a finer one, over the pairs on which both have worked.

    longer: CPU time over CPU time, cold. before, after: median error, in sizes of the smaller
    body, of the `compared` pairs of which both errors are known; wrong_*: verdicts.
    """

    start: str
    end: str
    pairs: int
    longer: Spread | None
    compared: int
    before: float | None
    after: float | None
    wrong_before: int
    wrong_after: int


def label_of(row: Row) -> str:
    return row["rung"] if row["threshold"] is None else f"{row['rung']} {row['threshold']:g}"


def labels(records: Sequence[Record]) -> list[str]:
    """In the order of the ladder."""
    return list(dict.fromkeys(label_of(row) for one in records for row in one["pair"]["rungs"]))


def hard(records: Sequence[Record]) -> list[Record]:
    """Pairs that boxes and hulls do not settle: on the others finer rungs have nothing to do."""
    return [one for one in records if kind_of(one) != SETTLED_EARLY]


def worked(row: Row) -> bool:
    """Whether it answered by its own means: a rung of parts that made some."""
    return row["state"] == "answered" and (row["rung"] != PARTS or row["cached"] is not None)


def rows_of(records: Sequence[Record], label: str) -> list[tuple[Record, Row]]:
    return [
        (record, row)
        for record in records
        for row in record["pair"]["rungs"]
        if label_of(row) == label
    ]


def summary(records: Sequence[Record], label: str) -> RungSummary:
    rows = rows_of(records, label)
    found = Counter(outcome(record, row) for record, row in rows)
    mine = [(record, row) for record, row in rows if worked(row)]
    return RungSummary(
        label=label,
        outcomes={kind: found[kind] for kind in OUTCOMES},
        false_proofs=sum(
            row["proven"] and outcome(record, row) in ("false hit", "miss") for record, row in rows
        ),
        pairs=len(mine),
        cold=_times(mine, "cold"),
        cached=_times(mine, "cached"),
        steadiness=spread(
            row["cold"]["high"] / row["cold"]["low"] for _, row in mine if _repeated(row)
        ),
        errors=_errors(mine),
    )


def step(records: Sequence[Record], start: str, end: str) -> Step:
    both = [
        (record, before, after)
        for (record, before), (_, after) in zip(
            rows_of(records, start), rows_of(records, end), strict=True
        )
        if worked(before) and worked(after)
    ]
    errors = [
        (one, other)
        for record, before, after in both
        if (one := relative_error(record, before)) is not None
        and (other := relative_error(record, after)) is not None
    ]
    before, after = (spread(pair[side] for pair in errors) for side in (0, 1))
    wrong_before, wrong_after = (
        sum(outcome(one[0], one[side]) in ("false hit", "miss") for one in both) for side in (1, 2)
    )
    return Step(
        start=start,
        end=end,
        pairs=len(both),
        longer=spread(r for _, one, other in both if (r := _ratio(other, one, "cpu"))),
        compared=len(errors),
        before=None if before is None else before.median,
        after=None if after is None else after.median,
        wrong_before=wrong_before,
        wrong_after=wrong_after,
    )


@dataclass(frozen=True, slots=True)
class Cost:
    """Of a rung, in multiples of what the exact one took on the same pair: CPU time, cold; wall
    time, cached. error: in sizes of the smaller body."""

    label: str
    pairs: int
    cold: Spread
    cached: Spread | None
    error: Spread


def cost(records: Sequence[Record], label: str) -> Cost | None:
    """None where it has never worked, or gives no distance."""
    rows = rows_of(records, label)
    exact = [row for _, row in rows_of(records, EXACT)]
    both = [
        (relative_error(record, row), row, proof)
        for (record, row), proof in zip(rows, exact, strict=True)
        if worked(row) and worked(proof) and row["error"] is not None
    ]
    cold = spread(ratio for _, row, proof in both if (ratio := _ratio(row, proof, "cpu")))
    error = spread(error for error, _, _ in both if error is not None)
    if cold is None or error is None:
        return None
    cached = spread(
        row["cached"]["median"] / proof["cold"]["median"]
        for _, row, proof in both
        if row["cached"] is not None
    )
    return Cost(label, len(both), cold, cached, error)


def relative_error(record: Record, row: Row) -> float | None:
    return None if row["error"] is None else abs(row["error"]) / record["size"]


def seconds(row: Row, kind: str) -> float | None:
    return None if row[kind] is None else row[kind]["median"] / _MICROSECONDS


def _ratio(row: Row, other: Row, kind: str) -> float | None:
    if row[kind] is None or other[kind] is None:
        return None
    ratio: float = row[kind]["median"] / other[kind]["median"]
    return ratio


def _repeated(row: Row) -> bool:
    return row["cold"] is not None and row["cold"]["runs"] > 1


def _times(rows: Iterable[tuple[Record, Row]], kind: str) -> Spread | None:
    return spread(time for _, row in rows if (time := seconds(row, kind)) is not None)


def _errors(rows: Sequence[tuple[Record, Row]]) -> Errors:
    sides: dict[bool, list[float]] = {False: [], True: []}
    for record, row in rows:
        error, together = relative_error(record, row), overlaps(record)
        if error is not None:
            sides[bool(together)].append(error)
    return Errors(spread(sides[False]), spread(sides[True]))


def depth_widths(records: Sequence[Record]) -> Spread | None:
    """Of the proven intervals of the depth, relative to their upper ends; the depth of pairs whose
    overlap is not bounded is not among them."""
    found = [one["pair"]["truth"]["bounds"] for one in records if overlaps(one)]
    return spread((high - low) / -low for low, high in filter(None, found) if low < 0)
