"""The pairs of the benchmark of impacts: what they claim to be."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bench.impact_pairs import ONE, SITUATIONS, impact_pairs
from bench.swept_truth import Meeting, is_convex

PAIRS = list(impact_pairs(1))


@pytest.mark.parametrize("family", [*SITUATIONS, "two triangles"])
def test_float64_holds_every_coordinate_and_the_pieces_are_convex(family: str) -> None:
    pairs = [pair for pair in PAIRS if pair.family == family]
    assert pairs
    for pair in pairs:
        pieces = pair.a + pair.b
        numbers = [c for piece in pieces for point in piece.points for c in point]
        assert all(c / ONE * ONE == c for c in [*numbers, *pair.move])
        assert all(is_convex(piece) for piece in pieces if len(piece.triangles) > 1)


def test_a_little_less_and_a_little_more_changes_the_answer() -> None:
    """Every motion into the other body is a hit; up to it is a touch, and off by a little it is
    free or a hit."""
    found: dict[str, list[Meeting]] = {}
    for pair in PAIRS:
        if pair.family in SITUATIONS:
            found.setdefault(pair.family, []).append(pair.truth())
    for truths in found.values():
        into, up_to = truths[:5], truths[5:10]
        assert all(truth.overlap is not None and 0 < truth.overlap < 1 for truth in into)
        exact, less, more = up_to[:3]
        assert exact == Meeting(Fraction(1), None)
        assert less == Meeting(None, None)
        assert more.overlap is not None
