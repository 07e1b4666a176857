"""Why a rung gave no answer, counted."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Any

from bench.accuracy.rungs import label_of, labels
from bench.accuracy.verdicts import overlaps

# What a reason says, without what is of one pair alone; the first that matches.
_BUDGET = (
    (re.compile(r"^budget: more than .* triangles$"), "too many triangles"),
    (re.compile(r"^budget: .* was stopped after"), "not begun: coarser parts were stopped"),
    (re.compile(r"^budget: stopped after"), "stopped at its budget"),
    (re.compile(r"^budget$"), "the budget of the pair was spent, or too little left"),
)
_OF_A_PAIR = re.compile(r"^(no volume: )?(body '[^']*':? |[^ ]+ and [^ ]+: )?")
_WORDS = {"failed": "refused", "not run": "not run", "answered": "undecided"}

Key = tuple[str, str, str]


def reasons(records: Sequence[dict[str, Any]]) -> dict[Key, int]:
    """By rung, what became of it, and why; neighbouring rungs with the same count share a row."""
    found: dict[Key, int] = {}
    for label in labels(records):
        rows = [
            (record, row)
            for record in records
            for row in record["pair"]["rungs"]
            if label_of(row) == label
        ]
        counted = Counter(
            (label, _WORDS[row["state"]], why(row["reason"]))
            for record, row in rows
            if row["state"] != "answered"
            or (row["overlap"] is None and overlaps(record) is not None)
        )
        found |= dict(counted.most_common())
    return found


def why(reason: str | None) -> str:
    """The reason as it is told of any pair."""
    if reason is None:
        return "no reason given"
    for pattern, words in _BUDGET:
        if pattern.search(reason):
            return words
    return _OF_A_PAIR.sub("", reason)
