"""Yes or no, held against what the corpus says, or, where it says nothing, what is proven."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

OVERLAPS = ("penetrating", "contains", "inside", "coincident")
Outcome = Literal["right", "false hit", "miss", "undecided", "not judged", "failed", "not run"]
OUTCOMES: tuple[Outcome, ...] = (
    "right",
    "false hit",
    "miss",
    "undecided",
    "not judged",
    "failed",
    "not run",
)


def overlaps(record: dict[str, Any]) -> bool | None:
    """Whether the bodies of a record have a common interior; None: nobody knows, or they touch, and
    neither answer is wrong."""
    stated: bool | None = record["case"]["stated"]["overlap"]
    if stated is not None:
        return stated
    proven = record["pair"]["truth"]["relation"]
    return None if proven in (None, "touching") else proven in OVERLAPS


def outcome(record: dict[str, Any], row: dict[str, Any]) -> Outcome:
    """What became of a rung on a pair."""
    if row["state"] != "answered":
        return "failed" if row["state"] == "failed" else "not run"
    said, true = row["overlap"], overlaps(record)
    if said is None:
        return "undecided"
    if true is None:
        return "not judged"
    if said == true:
        return "right"
    return "false hit" if said else "miss"


@dataclass(frozen=True, slots=True)
class Agreement:
    """What is proven beside what a corpus states that others have computed, or a hand.

    verdicts, way_outs, distances: pairs of which both are known; wrong_*: that contradict. A way
    out that is known is contradicted by a larger lower bound of the depth, a distance by bounds
    that leave it out by more than `tolerance` of the size of the smaller body.
    """

    verdicts: int
    wrong_verdicts: int
    way_outs: int
    wrong_way_outs: int
    distances: int
    wrong_distances: int


# Of the size: by so much are distances off that others computed in float64 with other rounding.
TOLERANCE = 1e-9


def agreement(records: Sequence[dict[str, Any]]) -> Agreement:
    verdicts = [
        (record["pair"]["truth"]["relation"] in OVERLAPS) == record["case"]["stated"]["overlap"]
        for record in records
        if record["case"]["stated"]["overlap"] is not None
        and record["pair"]["truth"]["relation"] is not None
    ]
    way_outs = [
        -record["pair"]["truth"]["bounds"][1] <= stated + TOLERANCE * record["size"]
        for record in records
        if (stated := _stated_depth(record)) is not None and record["pair"]["truth"]["bounds"]
    ]
    distances = [
        low - TOLERANCE * record["size"] <= stated <= high + TOLERANCE * record["size"]
        for record in records
        if (stated := record["case"]["stated"]["distance"]) is not None
        and (bounds := record["pair"]["truth"]["bounds"])
        for low, high in [bounds]
    ]
    return Agreement(
        len(verdicts),
        verdicts.count(False),
        len(way_outs),
        way_outs.count(False),
        len(distances),
        distances.count(False),
    )


def _stated_depth(record: dict[str, Any]) -> float | None:
    stated = record["case"]["stated"]
    depth: float | None = stated["way_out"] if stated["depth"] is None else stated["depth"]
    return depth
