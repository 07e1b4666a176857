"""Why a rung gave no answer, counted."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Any

from bench.accuracy.rungs import labels, rows_of
from bench.accuracy.verdicts import overlaps

# What a reason says, without what is of one pair alone; the first that matches.
_BUDGET = (
    (re.compile(r"^budget: more than .* triangles$"), "too many triangles"),
    (re.compile(r"^budget: stopped after"), "stopped at its budget"),
    (re.compile(r"^budget$"), "the budget of the pair was spent, or too little left"),
)
_OF_A_PAIR = re.compile(
    r"^(no volume: )?(body '[^']*':? |[^ ]+ and [^ ]+: )?"
    r"|(?<=the inside) of .+?(?= was not checked)"
)
_WORDS = {"failed": "refused", "not run": "not run", "answered": "undecided"}


def reasons(records: Sequence[dict[str, Any]]) -> dict[tuple[str, str], int]:
    """By what became of it and why: how often a rung gave no answer."""
    return Counter(
        (_WORDS[row["state"]], why(row["reason"]))
        for label in labels(records)
        for record, row in rows_of(records, label)
        if row["state"] != "answered" or _is_undecided(record, row)
    )


def _is_undecided(record: dict[str, Any], row: dict[str, Any]) -> bool:
    return row["overlap"] is None and overlaps(record) is not None


def why(reason: str | None) -> str:
    """The reason as it is told of any pair; a Boolean that cannot tell gives none."""
    if reason is None:
        return "the volume lies within its own error"
    for pattern, words in _BUDGET:
        if pattern.search(reason):
            return words
    return _OF_A_PAIR.sub("", reason)
