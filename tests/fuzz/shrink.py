"""A pair that contradicts, made small: fewer vertices, shorter numbers, the contradiction kept."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from tests.fuzz.invariants import against_truth, contradictions
from tests.fuzz.pairs import Batch
from tests.fuzz.shapes import Shapes
from tests.oracles.random_shapes import Points

DIGITS = (0, 1, 2, 4, 8)  # after the point, of numbers about 1
FIRST = np.zeros(1, dtype=np.uint32)
TURN = slice(3, 7)  # of a pose


def contradictions_of(pair: Batch) -> set[str]:
    """What the one row of a batch contradicts."""
    checks = [*contradictions(pair, np.random.default_rng(0))]
    if not pair.curved:
        checks += against_truth(pair, np.array([0]))
    return {what for what, failed in checks if failed[0]}


def shrunk(pair: Batch, fails: Callable[[Batch], bool]) -> Batch:
    """The smallest pair that was found of which `fails` is still true; of one row.

    Takes every smaller pair that fails, and ends where none does.
    """
    pair = replace(
        pair,
        a=_only(pair.a, int(pair.index_a[0])),
        b=_only(pair.b, int(pair.index_b[0])),
        index_a=FIRST,
        index_b=FIRST,
    )
    while True:
        smaller = next((other for other in _smaller(pair) if fails(other)), None)
        if smaller is None:
            return pair
        pair = smaller


def _only(shapes: Shapes, k: int) -> Shapes:
    return replace(shapes, points=shapes.points[k : k + 1], parameters=shapes.parameters[k : k + 1])


def _smaller(pair: Batch) -> Iterator[Batch]:
    for poses in _smaller_poses(pair.pose_a):
        yield replace(pair, pose_a=poses)
    for poses in _smaller_poses(pair.pose_b):
        yield replace(pair, pose_b=poses)
    for shapes in _smaller_shapes(pair.a):
        yield replace(pair, a=shapes)
    for shapes in _smaller_shapes(pair.b):
        yield replace(pair, b=shapes)


def _smaller_poses(pose: Points) -> Iterator[Points]:
    still = pose.copy()
    still[:, TURN] = [0, 0, 0, 1]
    if (still != pose).any():
        yield still
    for short in _shorter(pose):
        if short[:, TURN].any():
            yield short


def _smaller_shapes(shapes: Shapes) -> Iterator[Shapes]:
    for points in shapes.points:
        for k in range(len(points) if len(points) > 1 else 0):
            yield replace(shapes, points=(np.delete(points, k, axis=0),))
        for short in _shorter(points):
            yield replace(shapes, points=(short,))
    for sizes in shapes.parameters:
        for short in _shorter(np.array(sizes)):
            if (short > 0).all():
                yield replace(shapes, parameters=(tuple(short.tolist()),))


def _shorter(numbers: Points) -> Iterator[Points]:
    """Rounded, all at once and one by one, to fewer digits than they have."""
    for digits in DIGITS:
        rounded = np.round(numbers, digits)
        if (rounded == numbers).all():
            return
        yield rounded
        for k in np.flatnonzero((rounded != numbers).ravel()):
            one = numbers.copy()
            one.flat[k] = rounded.flat[k]
            yield one
