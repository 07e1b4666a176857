"""The pairs of a scene whose robots take many poses: which of them are plainly apart, which overlap
deeply, which depend on the fill of a hole, and which have to climb the ladder.

The core sorts them without placing a body (`core/native/motion/sift.hpp`).
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from math import inf
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck import core
from satcheck.audit.bodies import PlacedBodies
from satcheck.audit.body import PlacedBody, world_bounds
from satcheck.audit.pair import TOUCH_FRACTION, Pair
from satcheck.core.conventions import Vector
from satcheck.core.steps import is_careful
from satcheck.report.judge import Judgement, by_rule
from satcheck.report.report import SEVERITIES
from satcheck.scene.bodies import IDENTITY, resolution_in_world
from satcheck.scene.half_spaces import holds, reach_in_world

if TYPE_CHECKING:
    from satcheck.audit.settings import Settings
    from satcheck.core.peers import VolumeMeter
    from satcheck.core.transform import Transform
    from satcheck.scene import Body, Scene

# How the core sorts a pair.
OPEN, APART, DEEP, UNDECIDED = 0, 1, 2, 3
NO_END = 2**64 - 1  # steps
# The stretch of the placement of a link differs from pose to pose by less than this factor.
_TURNED = 1 + 1e-9
_LAST_ROW = (0.0, 0.0, 0.0, 1.0)
# Of the diagonal of the box of a body in one pose. Its box in any pose has a diagonal of at least
# 1 / sqrt(3) of that, so that `TOUCH_FRACTION` does not limit a tolerance below this.
_PLAINLY_FINE = 0.5 * TOUCH_FRACTION

Numbers = NDArray[np.float64]
Codes = NDArray[np.uint8]
Flags = NDArray[np.bool_]


class PosedPairs:
    """Pairs whose bodies take many poses. bodies: in the order of the matrices, as placed in any of
    the poses. deep_fails: whether a deep overlap of each pair is a failure."""

    def __init__(self, bodies: Sequence[PlacedBody], pairs: Sequence[Pair]) -> None:
        self._bodies, self.pairs, self._settings = bodies, pairs, pairs[0].settings
        place = {body.id: k for k, body in enumerate(bodies)}
        self._places = [(place[pair.a.id], place[pair.b.id]) for pair in pairs]
        least = SEVERITIES.index(self._settings.fail_on)
        deep = [by_rule(Judgement("error"), pair.request).severity for pair in pairs]
        self.deep_fails = np.array([SEVERITIES.index(severity) <= least for severity in deep], bool)

    def sift(
        self, matrices: Numbers, margins: Numbers | None = None, steps: int = NO_END
    ) -> tuple[Codes, int]:
        """Return OPEN, APART, DEEP or UNDECIDED, shape (poses, pairs), and the steps that it took.

        matrices: as those of `PoseBatch`, of all bodies. margins: of the shape of the result; pairs
        are APART only if they are farther apart by this much, those with NaN stay OPEN, and none is
        DEEP. steps: the most; beyond them pairs stay OPEN, too."""
        resolutions = [self._resolution(k, matrices) for k in range(len(self._bodies))]
        bounds = []
        for pair, (a, b) in zip(self.pairs, self._places, strict=True):
            tolerance = pair.request.tolerance
            if tolerance is None:
                deviations = (self._bodies[body].body.file.deviation for body in (a, b))
                tolerance = max(resolutions[a] + resolutions[b], sum(deviations))
            off = max(self._bodies[body].surface_tolerance for body in (a, b))
            gap_limit = max(pair.request.clearance or 0.0, tolerance)
            never = pair.request.limited or margins is not None
            depth = inf if never else max(0.5 * tolerance, off)
            # A crossing proves no thickness, and closed bodies with a thin overlap may touch.
            closed = all(self._bodies[body].solid for body in (a, b))
            crossing = inf if never or off or (closed and tolerance > 0) else tolerance
            bounds.append((a, b, gap_limit, depth, crossing))
        posed = [body.posed for body in self._bodies]
        codes, spent = core.sift(posed, bounds, matrices, self._settings.jobs, margins, steps)
        if any(body.endless for body in self._bodies):
            codes = self._open_beyond_reach(codes, matrices)
        return codes, spent

    def _open_beyond_reach(self, codes: Codes, matrices: Numbers) -> Codes:
        """Opens pairs with a half space whose block does not stand for it there."""
        codes, balls = codes.copy(), [ball_around(body) for body in self._bodies]
        for column, places in enumerate(self._places):
            for floor, other in (places, places[::-1]):
                if not self._bodies[floor].endless:
                    continue
                _, reach = reach_in_world(self._bodies[floor].body)
                centre, radius = balls[other]
                rows = matrices[:, other].reshape(-1, 3, 4)
                at = rows[:, :, :3] @ np.array(centre) + rows[:, :, 3]
                apart = np.linalg.norm(at - matrices[:, floor, 3::4], axis=1)
                codes[~(apart + radius <= reach), column] = OPEN
        return codes

    def _resolution(self, k: int, matrices: Numbers) -> float:
        """An upper bound of the precision of the coordinates of a body in all of these poses."""
        body = self._bodies[k]
        stretch = body.stretch * _TURNED
        farthest = float(np.abs(matrices[:, k, 3::4]).max())
        file = body.body.file
        step = (3 * stretch * body.shared.largest + farthest) * file.placement_step
        return file.resolution * stretch + step

    def deep_tolerances(self, matrices: Numbers, asked: Flags) -> Numbers:
        """Return the tolerances of these pairs, which are DEEP, shape (poses, pairs); NaN where the
        sort does not prove all that a finding has: a figure is asked for, or one of the bodies may
        hold the other."""
        tolerances = np.full(asked.shape, np.nan)
        resolutions = np.full(matrices.shape[:2], np.nan)
        for k in np.flatnonzero(asked.any(axis=0)).tolist():
            self._set_tolerances(tolerances[:, k], matrices, asked[:, k], k, resolutions)
        rows, numbers = np.nonzero(~np.isnan(tolerances))
        sides = np.array(self._places)[numbers]
        columns = (rows, sides[:, 0], sides[:, 1], tolerances[rows, numbers])
        cases = list(zip(*(column.tolist() for column in columns), strict=True))
        proven = core.neither_holds([body.posed for body in self._bodies], cases, matrices)
        tolerances[rows, numbers] = np.where(proven, tolerances[rows, numbers], np.nan)
        return tolerances

    def _set_tolerances(
        self, own: Numbers, matrices: Numbers, asked: Flags, number: int, resolutions: Numbers
    ) -> None:
        """Set the tolerances of a pair where they are asked for, and where it need not be placed.
        resolutions: of bodies, shape (poses, bodies); NaN where they are not known yet."""
        pair, sides = self.pairs[number], list(self._places[number])
        if pair.on_half_space or not pair.request.by.keys() <= {"overlap", "distance"}:
            return
        if pair.request.tolerance is not None:
            own[asked] = pair.request.tolerance
            return
        for k in sides:
            body, largest = self._bodies[k].body, self._bodies[k].shared.largest
            for row in np.flatnonzero(asked & np.isnan(resolutions[:, k])).tolist():
                transform = _transform_at(body, matrices[row, k])
                stretch = 1.0 if transform is None else core.largest_stretch(transform)
                resolutions[row, k] = resolution_in_world(body.file, transform, largest, stretch)
        written = resolutions[:, sides[0]] + resolutions[:, sides[1]]
        plain = asked & (written <= _PLAINLY_FINE * min(pair.a.diagonal, pair.b.diagonal))
        deviation = pair.a.body.file.deviation + pair.b.body.file.deviation
        own[plain] = np.maximum(written, deviation)[plain]

    def at(
        self,
        matrices: Numbers,
        row: int,
        numbers: Collection[int],
        meter: VolumeMeter | None = None,
    ) -> list[Pair]:
        """These pairs in one of the poses. Raises ValueError or OverflowError if a body cannot be
        placed there."""
        needed = sorted({k for number in numbers for k in self._places[number]})
        moved = [_moved(self._bodies[k].body, matrices[row, k]) for k in needed]
        bounds = world_bounds(moved, 1)
        placed = {
            k: PlacedBody(body, self._bodies[k].shared, box)
            for k, body, box in zip(needed, moved, bounds, strict=True)
        }
        pairs = []
        for number in numbers:
            a, b = (placed[k] for k in self._places[number])
            for floor, other in ((a, b), (b, a)):
                if floor.endless and not holds(floor.body, other.bounds):
                    raise ValueError(f"{other.id} lies beyond the reach of the half space")
            pairs.append(Pair(a, b, self._settings, self.pairs[number].request, meter))
        return pairs


def ball_around(body: PlacedBody) -> tuple[Vector, float]:
    """Return a ball that holds a body, in coordinates of its file, as large as the placement makes
    it."""
    centre, radius = body.posed.around
    return centre, radius * body.largest_stretch * _TURNED


def _moved(body: Body, rows: Numbers) -> Body:
    transform = _transform_at(body, rows)
    return body if transform is body.transform else replace(body, transform=transform)


def _transform_at(body: Body, rows: Numbers) -> Transform | None:
    transform = (*rows.tolist(), *_LAST_ROW)
    return body.transform if transform == (body.transform or IDENTITY) else transform


def same_way(scene: Scene, settings: Settings, bodies: PlacedBodies) -> bool:
    """Return whether every pose asks the same question of every pair: nothing moves while it is
    checked, nothing is projected, no body has to stand, and every body can be used and compared."""
    special = bodies.unusable or scene.motions or scene.body_rules or any(bodies.endless_pairs())
    everywhere = not special and settings.planar is None
    extras = settings.certificate or settings.cross_check
    alike = len(set(bodies.units.values())) == 1
    return everywhere and alike and settings.accuracy == "exact" and not (extras or is_careful())
