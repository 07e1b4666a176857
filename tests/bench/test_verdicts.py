"""Right, wrong, and neither."""

from __future__ import annotations

import pytest

from bench.accuracy.verdicts import agreement, outcome, overlaps
from tests.bench.made import record, row, silent


@pytest.mark.parametrize(
    ("relation", "stated", "known"),
    [
        ("penetrating", None, True),
        ("inside", None, True),
        ("separated", None, False),
        ("touching", None, None),
        (None, None, None),
        (None, True, True),
        # The corpus has found it by other means: it is what the proof is held against.
        ("separated", True, True),
    ],
)
def test_the_corpus_is_believed_before_the_proof(
    relation: str | None, stated: bool | None, known: bool | None
) -> None:
    assert overlaps(record(relation=relation, overlap=stated)) is known


def test_an_answer_is_right_or_wrong_or_neither() -> None:
    together, apart, touching = (record(relation=r) for r in ("inside", "separated", "touching"))
    yes, no, perhaps = (row("hull", overlap=said) for said in (True, False, None))
    assert [outcome(together, one) for one in (yes, no, perhaps)] == ["right", "miss", "undecided"]
    assert [outcome(apart, one) for one in (yes, no)] == ["false hit", "right"]
    assert [outcome(touching, one) for one in (yes, no)] == ["not judged", "not judged"]
    assert outcome(apart, silent("hull", "failed", "a reason")) == "failed"
    assert outcome(apart, silent("hull", "not run", "budget")) == "not run"


def test_contradictions_with_what_is_stated_are_counted() -> None:
    right = [
        record(overlap=True, way_out=1.0),
        record(relation="separated", bounds=(0.5, 0.5), overlap=False, distance=0.5),
        record(relation=None, bounds=None, overlap=True, way_out=1.0),
    ]
    seen = agreement(right)
    assert (seen.verdicts, seen.way_outs, seen.distances) == (2, 1, 1)
    assert (seen.wrong_verdicts, seen.wrong_way_outs, seen.wrong_distances) == (0, 0, 0)
    wrong = [
        record(overlap=False),
        # A way out shorter than the proven depth of 0.99 .. 1.
        record(way_out=0.98),
        record(relation="separated", bounds=(0.5, 0.5), distance=0.51),
    ]
    seen = agreement(wrong)
    assert (seen.wrong_verdicts, seen.wrong_way_outs, seen.wrong_distances) == (1, 1, 1)
