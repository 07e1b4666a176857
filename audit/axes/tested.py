"""The axes of a pair as they are tested, and what they show: by the theorem, for solids and for
outlines."""

from __future__ import annotations

import numpy as np

from satcheck.core.axes.candidates import Candidates, first_parallel
from satcheck.core.axes.shadows import Floats, Indices, Points, shadows
from satcheck.report.axes import (
    AxesWinner,
    AxisKind,
    AxisState,
    CandidateAxis,
    EarlyOut,
    HullRelation,
)

RELATIONS: dict[str, HullRelation] = {
    "separating": "separated",
    "touching": "touching",
    "mtv": "penetrating",
}


def axes_shown(
    candidates: Candidates, points: Points, a: Indices, b: Indices, *, closer: float | None = None
) -> list[CandidateAxis]:
    """The axes in the order of testing; of parallel candidates the one with the largest gap.

    a, b: the points of each body. closer: in a plane, how much smaller any gap may be than that of
    the polygons, because they lie within curves; None: in space.
    """
    result = shadows(points, candidates.axes, a, b)
    first = first_parallel(result.direction, candidates.tolerance)
    order = np.argsort(first, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(first[order])) + 1)
    made = []
    for number, group in enumerate(groups, 1):
        row = group[result.gap[group].argmax()]
        low = result.gap[row] - result.off[row] - (closer or 0.0)
        high = result.gap[row] + result.off[row]
        index_a, index_b = candidates.index[group[0]].tolist()
        features = candidates.index[group[candidates.counted[group]]].tolist()
        x, y, z = (result.direction[row] + 0.0).tolist()
        made.append(
            CandidateAxis(
                number=number,
                kind=_kind(index_a, index_b, planar=closer is not None),
                index_a=None if index_a < 0 else index_a,
                index_b=None if index_b < 0 else index_b,
                candidates=len({*map(tuple, features)}),
                direction=(x, y, z),
                shadow_a=_interval(result.a[row]),
                shadow_b=_interval(result.b[row]),
                gap=float(result.gap[row]) + 0.0,
                gap_bounds=(float(low) + 0.0, float(high) + 0.0),
                state=_state(int(result.sign[row]), known=not closer or low > 0 or high < 0),
            )
        )
    return made


def _kind(index_a: int, index_b: int, *, planar: bool) -> AxisKind:
    if index_b < 0:
        return "edge-a" if planar else "face-a"
    if index_a < 0:
        return "edge-b" if planar else "face-b"
    return "edge-edge"


def _state(sign: int, *, known: bool) -> AxisState:
    if not known:
        return "unknown"
    return "gap" if sign > 0 else "overlap" if sign < 0 else "touch"


def _interval(values: Floats) -> tuple[float, float]:
    low, high = (values + 0.0).tolist()
    return low, high


def winner_of(axes: list[CandidateAxis]) -> AxesWinner | None:
    """None where an axis is unknown that could change it."""
    best = max(axes, key=lambda axis: axis.gap)
    length = abs(best.gap)
    if best.state == "gap":
        return AxesWinner("separating", best.number, length, None)
    if any(axis.state == "unknown" for axis in axes):
        return None
    if best.state == "touch":
        return AxesWinner("touching", best.number, 0.0, None)
    x, y, z = (0.0 - length * part for part in best.direction)
    return AxesWinner("mtv", best.number, length, (x, y, z))


def relation_shown(axes: list[CandidateAxis]) -> HullRelation:
    winner = winner_of(axes)
    return "indeterminate" if winner is None else RELATIONS[winner.kind]


def early_out(axes: list[CandidateAxis]) -> EarlyOut:
    first = next((axis.number for axis in axes if axis.state == "gap"), None)
    stop = first or len(axes)
    return EarlyOut(stop, len(axes) - stop, first)
