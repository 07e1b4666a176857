"""Open surfaces: the fills of their holes, and pieces that may surround the other body."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from satcheck.scene.health import MOST_AROUND
from satcheck.verify.bodies import Placed
from satcheck.verify.exact import Rejected
from satcheck.verify.figures import EXACT_WIDTH
from satcheck.verify.open_parts import turns_around


def check_pieces(a: Placed, b: Placed) -> None:
    """Rejects bodies that do not meet if open pieces of one surround the other."""
    for outer, inner in ((a, b), (b, a)):
        if outer.world is None or inner.world is None or outer.pieces is None:
            continue
        world, point = outer.world, inner.world.vertices[0]
        low, high = world.bounds
        is_within = (low <= point).all() and (point <= high).all()
        if is_within and abs(turns_around(world.vertices[outer.pieces], point)) > MOST_AROUND:
            raise Rejected(f"open pieces of {outer.id} surround {inner.id}")


def check_holes(a: Placed, b: Placed, margin: Fraction) -> None:
    """Rejects bodies with holes unless the gap of their boxes is large enough: the fill of a hole
    may be anywhere near."""
    if not (a.holed or b.holed) or a.bounds is None or b.bounds is None:
        return
    (a_low, a_high), (b_low, b_high) = a.bounds, b.bounds
    gaps = np.concatenate([b_low - a_high, a_low - b_high])
    if Fraction(gaps.max()) <= margin * (1 + EXACT_WIDTH):
        raise Rejected("what fills a hole is not certified, and may be where the other body is")
