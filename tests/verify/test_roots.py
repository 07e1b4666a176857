"""Signs of sums of square roots, those that are 0 among them."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from satcheck.verify import Rejected
from satcheck.verify.roots import root, sign_of


def test_roots() -> None:
    assert root(Fraction(49, 16), 8) == (Fraction(7, 4), Fraction(7, 4))
    low, high = root(Fraction(2, 3), 64)
    assert low * low < Fraction(2, 3) < high * high
    assert high - low == Fraction(1, 3 << 64)


def test_signs() -> None:
    assert sign_of(Fraction(5), [Fraction(4), Fraction(9)]) == 0
    assert sign_of(Fraction(-5), more=[Fraction(4), Fraction(9)]) == 0
    assert sign_of(Fraction(0), [Fraction(2)], [Fraction(2)]) == 0
    assert sign_of(Fraction(0), [Fraction(2)], [Fraction(3)]) == 1
    assert sign_of(Fraction(3), [Fraction(2), Fraction(3)]) == -1


def test_of_terms_that_nearly_cancel() -> None:
    """c - sqrt(c^2 + d): of the sign of -d, however small that is."""
    rng = random.Random(6)
    for _ in range(200):
        c, d = Fraction(rng.getrandbits(60) + 1), Fraction(rng.choice((-1, 0, 1)), 1 << 900)
        assert sign_of(c, [c * c + d]) == (d < 0) - (d > 0)


def test_what_is_closer_than_that_is_not_told() -> None:
    with pytest.raises(Rejected, match="too close"):
        sign_of(Fraction(0), [Fraction(8)], [Fraction(2), Fraction(2)])
