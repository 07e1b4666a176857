"""Signs of sums of square roots, against roots to 128 bits, and where they are 0."""

from __future__ import annotations

import random
from fractions import Fraction

from satcheck.core.curved.exact.lattice import (
    Reach,
    gap_bounds,
    root_bounds,
    sign_of_difference,
    sign_of_gap,
)
from tests.oracles.exact_distance import root


def sign(number: Fraction) -> int:
    return (number > 0) - (number < 0)


def random_reach(rng: random.Random, bits: int) -> Reach:
    p = rng.getrandbits(2 * bits)
    return Reach(
        rng.choice((-1, 1)) * rng.getrandbits(bits), rng.choice((0, p, rng.getrandbits(bits) ** 2))
    )


def test_signs_against_many_digits() -> None:
    rng, seen = random.Random(4), set()
    for _ in range(4000):
        a, b = (random_reach(rng, rng.choice((1, 2, 3, 60))) for _ in range(2))
        (p, _), (s, _) = root(Fraction(a.p)), root(Fraction(b.p))
        # Sums of numbers of 60 bits and their roots that are not 0 are far above 2^-256.
        total, difference = a.q + p + b.q + s, a.q + p - b.q - s
        few = Fraction(1, 1 << 240)
        assert sign_of_gap(a, b) == (0 if abs(total) < few else -sign(total))
        assert sign_of_difference(a, b) == (0 if abs(difference) < few else sign(difference))
        low, high = gap_bounds(a, b)
        assert low - few <= -total <= high + few
        seen.add(sign_of_gap(a, b))
    assert seen == {-1, 0, 1}


def test_roots_that_cancel_though_they_are_irrational() -> None:
    assert sign_of_difference(Reach(3, 2), Reach(3, 2)) == 0
    assert sign_of_difference(Reach(3, 2), Reach(3, 3)) == -1
    assert sign_of_gap(Reach(-2, 2), Reach(1, 0)) == -1
    assert sign_of_gap(Reach(-3, 2), Reach(1, 0)) == 1
    assert sign_of_gap(Reach(-5, 4), Reach(0, 9)) == 0


def test_bounds_of_roots() -> None:
    assert root_bounds(49) == (Fraction(7), Fraction(7))
    low, high = root_bounds(2)
    assert low * low < 2 < high * high
    assert high - low == Fraction(1, 1 << 128)
