"""What a run answered, for a rough comparison: a faster wrong answer is no gain.

The keys of reports and results stand here alone. Where two commits differ in them, read both here.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

ROUNDING = 1e-9
# Reports of many pairs may leave these findings out.
SEPARATED = "separated"


@dataclass(frozen=True, slots=True)
class Answers:
    """digest: of what has to be equal. bounds: the ends of the interval of each number."""

    digest: str
    bounds: Sequence[Sequence[float]] = ()

    def agree(self, other: Answers) -> bool:
        """Equal digests, and intervals that meet: both may be right."""
        return (
            self.digest == other.digest
            and len(self.bounds) == len(other.bounds)
            and all(map(_meet, self.bounds, other.bounds))
        )


Reading = Callable[[bytes], Answers]


def _meet(one: Sequence[float], other: Sequence[float]) -> bool:
    slack = ROUNDING * max(abs(one[0]), abs(other[0]))
    return one[0] <= other[1] + slack and other[0] <= one[1] + slack


def digest(value: object) -> str:
    return hashlib.sha256(json.dumps(value).encode()).hexdigest()[:16]


def of_nothing(_: bytes) -> Answers:
    """For output that may change, such as help."""
    return Answers(digest(None))


def of_report(data: bytes) -> Answers:
    """Verdict, triangles of the bodies, relations; depths and thicknesses as bounds."""
    return _of_reports([json.loads(data)])


def of_results(data: bytes) -> Answers:
    """The reports of a batch."""
    return _of_reports([json.loads(line)["report"] for line in data.splitlines()])


def of_samples(data: bytes) -> Answers:
    """The verdict on random poses, and in how many each pair meets."""
    report = json.loads(data)
    keys = ("a", "b", "overlaps", "touches", "near", "undecided")
    pairs = [[pair[key] for key in keys] for pair in report["pairs"]]
    return Answers(digest([report["summary"]["verdict"], sorted(pairs)]))


def _of_reports(reports: Iterable[Any]) -> Answers:
    facts: list[object] = []
    bounds: list[Sequence[float]] = []
    for report in reports:
        met = [finding for finding in report["findings"] if finding["relation"] != SEPARATED]
        met.sort(key=lambda finding: (finding["a"], finding["b"]))
        facts.append(report["summary"]["verdict"])
        facts.append([body["triangles"] for body in report["bodies"]])
        facts.append([[finding[key] for key in ("a", "b", "relation")] for finding in met])
        for finding in met:
            both = finding["depth_bounds"], finding["thickness_bounds"]
            bounds += [
                [math.inf if end is None else end for end in ends]
                for ends in both
                if ends is not None
            ]
    return Answers(digest(facts), bounds)
