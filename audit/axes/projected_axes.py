"""The axes of a pair as they are tested: merged where they are parallel, in order, with shadows."""

from __future__ import annotations

import numpy as np
from msgspec import Struct

from satcheck.core.axes.candidates import Candidates
from satcheck.core.axes.parallel import first_parallel
from satcheck.core.axes.shadows import Axes, ExactPoints, Floats, Indices, Shadows, shadows
from satcheck.report.axes import AxesWinner, AxisState, CandidateAxis, EarlyOut


class ProjectedAxes(Struct, frozen=True):
    """In the order of testing. rows: of `shadows`, the best of the candidates that are parallel.
    first: of the candidates, the first of them. count: how many they are."""

    candidates: Candidates
    shadows: Shadows
    rows: Indices
    first: Indices
    count: Indices
    gap_bounds: Floats
    states: tuple[AxisState, ...]

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def gaps(self) -> Floats:
        return self.shadows.gap[self.rows]

    def early_out(self) -> EarlyOut:
        axis = next((k + 1 for k, state in enumerate(self.states) if state == "gap"), None)
        tested = len(self) if axis is None else axis
        return EarlyOut(tested, len(self) - tested, axis)

    def winner(self) -> AxesWinner | None:
        """None where an axis is unknown that could change it."""
        best = int(self.gaps.argmax())
        state, length = self.states[best], abs(float(self.gaps[best]))
        if state == "gap":
            return AxesWinner("separating", best + 1, length, None)
        if "unknown" in self.states:
            return None
        if state == "touch":
            return AxesWinner("touching", best + 1, 0.0, None)
        x, y, z = (0.0 - length * self.shadows.direction[self.rows[best]]).tolist()
        return AxesWinner("mtv", best + 1, length, (x, y, z))

    def ranked(self) -> tuple[CandidateAxis, ...]:
        """The largest gap first, then the smallest overlap."""
        order = np.argsort(-self.gaps, kind="stable")
        return tuple(self._axis(int(k)) for k in order)

    def _axis(self, k: int) -> CandidateAxis:
        row, first, shadows = self.rows[k], self.first[k], self.shadows
        x, y, z = (shadows.direction[row] + 0.0).tolist()
        return CandidateAxis(
            number=k + 1,
            kind=self.candidates.kind[first],
            index_a=_number(self.candidates.index_a[first]),
            index_b=_number(self.candidates.index_b[first]),
            candidates=int(self.count[k]),
            direction=(x, y, z),
            shadow_a=_interval(shadows.a[row]),
            shadow_b=_interval(shadows.b[row]),
            gap=float(shadows.gap[row]) + 0.0,
            gap_bounds=_interval(self.gap_bounds[k]),
            state=self.states[k],
        )


def projected(
    candidates: Candidates,
    points: Floats,
    exact: ExactPoints,
    sides: tuple[Indices, Indices],
    closer: float = 0.0,
) -> ProjectedAxes:
    """sides: the points of A and of B. closer: how much smaller any gap may be than that of the
    polygons, because they lie within curves."""
    result = shadows(*sides, Axes(points, candidates.corners), exact)
    first = first_parallel(result.direction, candidates.tolerance)
    leaders, group = np.unique(first, return_inverse=True)
    by_gap = np.lexsort((np.arange(len(group)), -result.gap, group))
    rows = by_gap[np.searchsorted(group[by_gap], np.arange(len(leaders)))]
    bounds = np.column_stack((result.gap - result.off, result.gap + result.off))[rows]
    bounds[:, 0] -= closer
    signs = result.sign[rows]
    if closer:
        undecided = (bounds[:, 0] <= 0) & (bounds[:, 1] >= 0)
        states = [_state(s, sure=not u) for s, u in zip(signs, undecided, strict=True)]
    else:
        states = [_state(sign, sure=True) for sign in signs]
    count = _feature_counts(candidates, group, len(leaders))
    return ProjectedAxes(candidates, result, rows, leaders, count, bounds, tuple(states))


def _feature_counts(candidates: Candidates, group: Indices, groups: int) -> Indices:
    """Return how many faces and pairs of edges each group has; triangles of one face count once."""
    features = np.column_stack((group, candidates.index_a, candidates.index_b))
    features = features[candidates.counted]
    return np.bincount(np.unique(features, axis=0)[:, 0], minlength=groups)


def _state(sign: int, *, sure: bool) -> AxisState:
    if not sure:
        return "unknown"
    return "gap" if sign > 0 else "overlap" if sign < 0 else "touch"


def _number(index: int) -> int | None:
    return None if index < 0 else int(index)


def _interval(values: Floats) -> tuple[float, float]:
    low, high = (values + 0.0).tolist()
    return low, high
