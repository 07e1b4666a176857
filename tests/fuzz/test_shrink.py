"""A planted contradiction is found in one pair, and stays while the pair gets small."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from satcheck import core
from tests.fuzz import shrink
from tests.fuzz.__main__ import shrink as print_shrunk
from tests.fuzz.invariants import PENETRATING, Mask
from tests.fuzz.pairs import Batch, Share, make_batch
from tests.fuzz.shapes import Rng

# A point inside a hull is inside that of 6 of its points: E. Steinitz (1914).
STEINITZ = 6


def overlaps(batch: Batch) -> Mask:
    return np.asarray(np.asarray(batch.ask("overlap").outcome) == PENETRATING)


def an_overlap(share: Share) -> Batch:
    for number in range(20):
        batch = make_batch(share, 1, number)
        rows = np.flatnonzero(overlaps(batch))
        if rows.size and all(len(points) > STEINITZ for points in batch.a.points):
            return batch.rows(rows[:1])
    raise AssertionError("no batch has an overlap")


@pytest.mark.parametrize("share", ["random", "curved"])
def test_an_overlap_gets_small(share: Share) -> None:
    """As if every overlap were a contradiction."""
    pair = an_overlap(share)
    small = shrink.shrunk(pair, lambda other: bool(overlaps(other)[0]))
    assert overlaps(small)[0]
    assert len(small.pose_a) == len(small.a) == len(small.b) == 1
    assert not any(overlaps(other)[0] for other in shrink._smaller(small))
    for shapes in (small.a, small.b):
        for points in shapes.points:
            assert len(points) <= STEINITZ


def test_the_planted_contradiction_is_the_one_that_stays(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pair = an_overlap("curved")

    def planted(batch: Batch, _: Rng) -> Iterator[tuple[str, Mask]]:
        yield "planted", overlaps(batch)
        yield "nothing", np.zeros(len(batch.pose_a), bool)

    assert shrink.contradictions_of(pair) == set()
    monkeypatch.setattr(shrink, "contradictions", planted)
    assert shrink.contradictions_of(pair) == {"planted"}
    print_shrunk(pair)
    said = capsys.readouterr().out
    assert said.startswith("planted, of which")
    assert core.OUTCOMES[PENETRATING] in said
