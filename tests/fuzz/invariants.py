"""What must hold for every pair of a batch, and the truth in rationals for a sample of it."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satcheck import core
from tests.core.pair_checks import CURVED
from tests.fuzz.pairs import Batch
from tests.fuzz.shapes import Rng, Shapes
from tests.oracles.exact_distance import exact_truth
from tests.oracles.random_shapes import Points

Mask = NDArray[np.bool_]
SEPARATED, TOUCHING, PENETRATING, UNDECIDED = range(4)
SCALES = (2.0**-20, 2.0**9)

# Placing a vertex takes up to 12 roundoffs of the coordinates, a support value and a witness point
# on either side as many again: rounded up to a power of two.
ROUNDOFFS = 64 * float(np.finfo(float).eps) / 2


def contradictions(batch: Batch, rng: Rng) -> Iterator[tuple[str, Mask]]:
    """(what was asked, the rows (n,) that fail)."""
    depth, gap = batch.ask("depth"), batch.ask("distance")
    tolerance = batch.size() * (CURVED if batch.curved else ROUNDOFFS)
    yield "undecided", np.asarray(depth.outcome) == UNDECIDED
    yield "queries disagree", _differs(depth, batch.ask("overlap")) | _differs(depth, gap)
    yield "intervals of two queries are apart", _apart(depth, gap, tolerance)
    yield "outcome against bounds", _against_bounds(depth) | _against_bounds(gap)
    if batch.curved:
        yield "witness points against normal", _crooked(depth, batch.size() * ROUNDOFFS)
        yield "witness points off the shapes", _off_shapes(batch, depth, tolerance)
    else:
        yield "witness points against normal", _witnesses(depth, tolerance)
        yield "witness points off the supports", _off_supports(batch, depth, tolerance)
    swapped = batch.swapped().ask("depth")
    yield "swapped: outcome", _differs(depth, swapped)
    yield "swapped: interval", _apart(depth, swapped, tolerance)
    if not batch.curved:
        reordered = batch.reordered(rng).ask("depth")
        yield "reordered: outcome", _differs(depth, reordered)
        yield "reordered: figures", ~_same_figures(depth, reordered, 1.0)
    for factor in SCALES:
        scaled = batch.ask("depth", factor)
        yield "scaled: outcome", _differs(depth, scaled)
        yield "scaled: figures", ~_same_figures(depth, scaled, factor)
    yield "blocked after the translation", _blocked(batch, depth, tolerance)
    yield "free after less", _free_too_early(batch, depth, tolerance, rng)


def _differs(p: core.PairResults, q: core.PairResults) -> Mask:
    return np.asarray(np.asarray(p.outcome) != np.asarray(q.outcome))


def _apart(p: core.PairResults, q: core.PairResults, tolerance: Points) -> Mask:
    low = np.maximum(p.lower, q.lower)
    return np.asarray(~(low <= np.minimum(p.upper, q.upper) + tolerance))


def _against_bounds(p: core.PairResults) -> Mask:
    lower, distance, upper = (np.asarray(c) for c in (p.lower, p.distance, p.upper))
    outcome = np.asarray(p.outcome)
    ordered = (lower <= distance) & (distance <= upper)
    sign = np.choose(
        outcome,
        [
            (distance >= 0) & (upper > 0),
            (lower <= 0) & (upper >= 0),
            (distance <= 0) & (lower < 0),
            np.ones(len(outcome), bool),
        ],
    )
    return np.asarray(~(ordered & sign))


def _crooked(p: core.PairResults, tolerance: Points) -> Mask:
    """distance * normal = witness_b - witness_a, and the normal is unit."""
    between = np.asarray(p.witness_b) - np.asarray(p.witness_a)
    off = np.abs(np.asarray(p.distance)[:, None] * p.normal - between).max(axis=1)
    long = np.abs(np.linalg.norm(p.normal, axis=1) - 1) > ROUNDOFFS
    return np.asarray(~(off <= tolerance) | long)


def _witnesses(p: core.PairResults, tolerance: Points) -> Mask:
    """The witness points are at most the far end of the interval apart, their distance along the
    normal at least the near end: what is left across the normal follows from Pythagoras."""
    across = np.sqrt(np.abs(np.square(p.upper) - np.square(p.lower)))
    return _crooked(p, tolerance + _width(p) + across)


def _off_shapes(batch: Batch, p: core.PairResults, tolerance: Points) -> Mask:
    """Of curved shapes: each witness point, as a body of its own, is at its shape. That far apart
    along the normal, they are the ends of the overlap then."""
    point = Shapes("point", (np.zeros((1, 3)),))
    off = np.zeros(len(tolerance), bool)
    sides = (
        (batch.a, batch.index_a, batch.pose_a, p.witness_a),
        (batch.b, batch.index_b, batch.pose_b, p.witness_b),
    )
    for shapes, index, pose, witness in sides:
        place = np.zeros_like(pose)
        place[:, :3], place[:, 6] = witness, 1
        there = Batch("witness point", shapes, point, index, np.zeros_like(index), pose, place)
        off |= ~(np.asarray(there.ask("distance").lower) <= tolerance + _width(p))
    return off


def _width(p: core.PairResults) -> Points:
    return np.asarray(p.upper) - np.asarray(p.lower)


def _off_supports(batch: Batch, p: core.PairResults, tolerance: Points) -> Mask:
    """Along the normal nothing of A is beyond its witness point, nothing of B before its own, by
    more than the bounds admit. The normal of a gap is the direction between two rounded points; the
    cosine of its angle with the axis that proves the near end is at least near end / far end. Where
    rounded vertices touch, no axis is proven."""
    off = np.zeros(len(tolerance), bool)
    normal, distance = np.asarray(p.normal), np.asarray(p.distance)
    gap = distance > 0
    turn = np.divide(tolerance, distance, out=np.zeros(len(off)), where=gap)
    cosine = np.divide(p.lower, p.upper, out=np.ones(len(off)), where=gap)
    turn += np.arccos(np.clip(cosine, 0, 1))
    sides = zip(batch.world(), (p.witness_a, p.witness_b), (1, -1), strict=True)
    for vertices, witness, sign in sides:
        reach = np.einsum("nmj,nj->nm", vertices, sign * normal).max(axis=1)
        here = np.einsum("nj,nj->n", np.asarray(witness), sign * normal)
        extent = np.ptp(vertices, axis=1).sum(axis=1)
        off |= ~(np.abs(reach - here) <= tolerance + _width(p) + turn * extent)
    return np.asarray(off & (np.asarray(p.outcome) != TOUCHING))


def _same_figures(p: core.PairResults, q: core.PairResults, factor: float) -> Mask:
    same = np.ones(len(p), bool)
    for name in ("distance", "lower", "upper", "witness_a", "witness_b"):
        mine, yours = np.asarray(getattr(p, name)) * factor, np.asarray(getattr(q, name))
        same &= (mine == yours).reshape(len(p), -1).all(axis=1)
    return np.asarray(same & (np.asarray(p.normal) == np.asarray(q.normal)).all(axis=1))


def _blocked(batch: Batch, p: core.PairResults, tolerance: Points) -> Mask:
    """The translation, lengthened by the bound, has to separate."""
    rows = np.asarray(p.outcome) == PENETRATING
    length = np.asarray(p.lower) - tolerance
    there = batch.moved(np.where(rows, length, 0)[:, None] * p.normal)
    return np.asarray(rows & (np.asarray(there.ask("overlap").outcome) == PENETRATING))


def _free_too_early(batch: Batch, p: core.PairResults, tolerance: Points, rng: Rng) -> Mask:
    """No shorter translation, whatever its direction, changes the outcome."""
    deep = np.asarray(p.outcome) == PENETRATING
    apart = np.asarray(p.outcome) == SEPARATED
    least = np.where(deep, -np.asarray(p.upper), np.where(apart, p.lower, 0)) - 2 * tolerance
    way = rng.normal(size=(len(tolerance), 3))
    way *= (np.maximum(least, 0) / np.linalg.norm(way, axis=1))[:, None]
    there = np.asarray(batch.moved(way).ask("overlap").outcome)
    changed = (deep & (there != PENETRATING)) | (apart & (there != SEPARATED))
    return np.asarray((least > 0) & changed)


def against_truth(batch: Batch, rows: NDArray[np.intp]) -> Iterator[tuple[str, Mask]]:
    """The rows in rationals. Turned pairs are placed by numpy, which rounds in its own way."""
    some = batch.rows(rows)
    result = some.ask("depth")
    slack = some.size() * (ROUNDOFFS if some.turned else 0.0)
    wrong, outside = (np.zeros(len(batch.pose_a), bool) for _ in range(2))
    for i, (a, b) in enumerate(zip(*some.world(), strict=True)):
        truth = exact_truth(a, b)
        clear = not some.turned or abs(truth.low) > slack[i]
        wrong[rows[i]] = clear and core.OUTCOMES[int(result.outcome[i])] != truth.outcome
        low = Fraction(float(result.lower[i])) - Fraction(float(slack[i]))
        high = Fraction(float(result.upper[i])) + Fraction(float(slack[i]))
        outside[rows[i]] = not (low <= truth.low and truth.high <= high)
    yield "wrong outcome", wrong
    yield "truth outside the bounds", outside


def sample(batch: Batch, count: int, rng: Rng) -> NDArray[np.intp]:
    """Rows for the oracle: half of them from those that touch, where there are any."""
    outcome: Any = np.asarray(batch.ask("overlap").outcome)
    touching = np.flatnonzero(outcome == TOUCHING)
    some = rng.permutation(touching)[: count // 2]
    rest = rng.permutation(np.flatnonzero(outcome != TOUCHING))[: count - len(some)]
    return np.concatenate([some, rest])
