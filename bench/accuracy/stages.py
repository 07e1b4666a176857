"""Where the time of a plain check goes, and which rung settled it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, median
from typing import Any

from bench.accuracy.spread import Spread, spread
from bench.accuracy.verdicts import OVERLAPS

Record = dict[str, Any]

# What a reader is shown, in the order in which it happens, and the stages that make it up.
GROUPS: dict[str, tuple[str, ...]] = {
    "reading": ("reading",),
    "placing": ("placing",),
    "boxes": ("aabb", "obb"),
    "hulls": ("sat", "hull"),
    "triangles": ("triangles", "containment", "touch-band", "distance", "surface distance"),
    "depth search": ("depth", "search"),
    "verification": ("verify",),
    "report": ("writing",),
}
OTHER = "other"
NOTHING = "nothing"
SETTLED_EARLY, APART, OVERLAPPING = (
    "boxes or hulls settle it",
    "triangles: apart",
    "triangles: overlapping",
)


@dataclass(frozen=True, slots=True)
class StageTimes:
    """Of the pairs of one kind: the mean share of each group in the time of its pair, in the order
    of GROUPS, and the seconds from the files to the report."""

    kind: str
    pairs: int
    shares: Mapping[str, float]
    total: Spread


def settled_by(records: Sequence[Record]) -> dict[str, int]:
    """How often each rung settled the relation in a plain check, and how often none did."""
    return dict(Counter(one["pair"]["default"] or NOTHING for one in records))


def grouped(record: Record) -> dict[str, float]:
    """Seconds a group, medians of the runs."""
    group_of = {stage: group for group, stages in GROUPS.items() for stage in stages}
    spent = dict.fromkeys((*GROUPS, OTHER), 0.0)
    names = {stage for run in record["stages"] for stage in run}
    for name in names:
        seconds = median(run.get(name, 0.0) for run in record["stages"])
        spent[group_of.get(name, OTHER)] += seconds
    return spent


def kind_of(record: Record) -> str:
    picked = record["pair"]["default"]
    if picked not in (None, "exact"):
        return SETTLED_EARLY
    return OVERLAPPING if record["pair"]["truth"]["relation"] in OVERLAPS else APART


def stage_times(records: Sequence[Record]) -> list[StageTimes]:
    """A row a kind; kinds without pairs are left out."""
    made = []
    for kind in (SETTLED_EARLY, APART, OVERLAPPING):
        spent = [grouped(record) for record in records if kind_of(record) == kind]
        totals = [sum(one.values()) for one in spent]
        total = spread(totals)
        if total is None:
            continue
        groups = [name for name in (*GROUPS, OTHER) if any(one[name] for one in spent)]
        shares = {
            name: fmean(one[name] / whole for one, whole in zip(spent, totals, strict=True))
            for name in groups
        }
        made.append(StageTimes(kind, len(spent), shares, total))
    return made


def process(records: Sequence[Record], what: str) -> Spread | None:
    """`wall` and `cpu` seconds, or `megabytes`, of the whole command; a pair counts its median."""
    return spread(median(run[what] for run in record["process"]) for record in records)
