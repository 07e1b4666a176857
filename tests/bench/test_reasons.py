"""Why nothing was said, as it is told of many pairs."""

from __future__ import annotations

import pytest

from bench.accuracy.reasons import reasons, why
from tests.bench.made import record, row, silent


@pytest.mark.parametrize(
    ("reason", "told"),
    [
        ("budget", "the budget of the pair was spent, or too little left"),
        ("budget: stopped after 6 s", "stopped at its budget"),
        ("budget: more than 3,000 triangles", "too many triangles"),
        ("no volume: body 'a b': is no solid", "is no solid"),
        ("no volume: a and b: the intersection took too long", "the intersection took too long"),
        (
            "the inside of a was not checked: it is not closed",
            "the inside was not checked: it is not closed",
        ),
        (None, "the volume lies within its own error"),
    ],
)
def test_a_reason_is_told_without_its_pair(reason: str | None, told: str) -> None:
    assert why(reason) == told


def test_every_silence_is_counted_and_no_answer() -> None:
    refused = silent("boolean", "failed", "no volume: body 'x': is no solid")
    found = reasons(
        [
            record(rows={"boolean": refused}),
            record(
                rows={"boolean": refused, "parts 0.1": silent("parts 0.1", "not run", "budget")}
            ),
            record(rows={"boolean": row("boolean", overlap=None)}),
            record(),
        ]
    )
    assert found == {
        ("not run", "the budget of the pair was spent, or too little left"): 1,
        ("refused", "is no solid"): 2,
        ("undecided", "the volume lies within its own error"): 1,
    }
