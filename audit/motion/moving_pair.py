"""Two bodies that move, and the bounds that can be proven from one moment on."""

from __future__ import annotations

import math
from bisect import bisect_right
from contextlib import contextmanager
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.body import PlacedBody, diagonal
from satcheck.audit.draft import Draft
from satcheck.audit.finding import examine
from satcheck.audit.motion.travel import ORIGIN, Travel
from satcheck.audit.pair import TOUCH_FRACTION, Pair
from satcheck.audit.planner import ALWAYS
from satcheck.core.curved.placed import rows_of
from satcheck.core.transform import Transform, placed
from satcheck.report.report import OVERLAPS, Effect
from satcheck.report.request import Request
from satcheck.scene.bodies import IDENTITY

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from satcheck.core.conventions import Vector
    from satcheck.report.report import Finding

    Ask = Callable[..., core.MotionAnswer]
    Shaped = tuple[core.Surface | core.Shape, Transform]


Stretch = tuple[float, float]


class OpenStretches(Struct, frozen=True):
    """The stretches of t in which a pair may meet, each within one piece of steady motion, and how
    many intervals were asked. Elsewhere it is farther apart than the gap."""

    stretches: tuple[Stretch, ...]
    steps: int = 0
    gap: float = math.inf


# The budget and the resolution of a sweep, in steps and shares of t, never in seconds.
# If a step is shorter than this share of the motion, the bodies count as in contact. The first
# overlap is searched down to the same share. It is shorter, down to FINEST_STEP, where the bodies
# move by more than their touch band meanwhile.
SHORTEST_STEP = 2.0**-30
FINEST_STEP = 2.0**-46
# A contact that lasts for more touch bands of motion than this is a contact of its own; a shorter
# one is the start of an overlap.
SLID = 64
# Queries about one pair, and for each piece of its motion: how long it stays free, how large its
# gap is.
STEPS = 4096
STEPS_A_PIECE = 64
# Pairs of boxes and triangles that all these queries may visit: a few seconds.
VISITS = 10_000_000
# Steps of the scene, each about a nanosecond: of a query, of a visit, of a pose that is checked.
STEPS_OF_QUERY, STEPS_OF_VISIT, STEPS_OF_POSE = 50_000, 500, 300_000
# For each triangle of both bodies in that pose.
STEPS_OF_PLACED_TRIANGLE = 100


class Unanswerable(Exception):
    """A query about a moving pair has no answer. The message is for the report."""


class BudgetSpent(Unanswerable):
    """The queries about a pair exceed the budget of a sweep."""

    def __init__(self) -> None:
        super().__init__("the budget of the sweep was spent")


class MovingPair:
    """World frame. tolerance: half width of the touch band, at least the rounding of poses. pad:
    the rounding of a gap. framed: the frame of both bodies turns in the world. hulls_apart: whether
    the hulls alone have answered all queries so far. obstacle: the triangles of A and B that ended
    the last way between surfaces; -1: none. Raises Unanswerable if the rounding would make
    the band wide for bodies of this size.
    """

    def __init__(self, pair: Pair, travel: Travel, found: OpenStretches) -> None:
        self.pair, self.posed, self._travel = pair, partial(travel.posed, pair), travel
        self._sides = travel.sides(pair)
        self.framed = any(len(joints) < len(travel.above[k]) for k, joints in self._sides)
        self.pad = sum(travel.pad(k) for k, _ in self._sides)
        size = min(diagonal(pair.a.bounds), diagonal(pair.b.bounds))
        if not travel.band(pair) <= max(pair.tolerance, TOUCH_FRACTION * size):
            raise Unanswerable(
                f"the motion is so long that rounding moves the bodies by {self.pad:.3g}"
            )
        self.tolerance = travel.band(pair)
        self.times: list[float] = travel.times.tolist()
        self.stretches, self.free_gap, self.steps = found.stretches, found.gap, found.steps
        self._most_steps = found.steps + STEPS + STEPS_A_PIECE * (len(self.times) - 2)
        self.convex = all(body.curved is not None or body.convex for body in (pair.a, pair.b))
        self._known: dict[int, tuple[float, float]] = {}  # of pieces
        self.hulls_apart = True
        self.obstacle = -1, -1
        self.visits = 0

    def fastest(self, t: float) -> float:
        """An upper bound of the speed of a point of A relative to B, in the piece of t, per unit of
        t."""
        return self._rates(t)[0]

    def _rates(self, t: float) -> tuple[float, float]:
        """That bound, and the largest effect of rounding on the rate at which a gap closes."""
        piece = min(bisect_right(self.times, t), len(self.times) - 1)
        if piece not in self._known:
            ends = self.times[piece - 1], self.times[piece]
            (v, p), (w, q) = (self._travel.in_piece(side, *ends) for side in self._sides)
            self._known[piece] = v + w, p + q
        return self._known[piece]

    def shortest_step(self, t: float) -> float:
        """The share of the motion down to which times are told apart, in the piece of t."""
        speed = self.fastest(t)
        share = self.tolerance / speed if speed > 0.0 else math.inf
        return max(min(share, SHORTEST_STEP), FINEST_STEP)

    def is_step(self, step: float, t: float, end: float) -> bool:
        """Return whether a step from t on is long enough to be one, or reaches the end."""
        return t + step >= end or step >= self.shortest_step(t)

    def path_length(self, start: float, end: float) -> float:
        """An upper bound of the way of a point of A relative to B from start to end."""
        times = [start, *(time for time in self.times if start < time < end)]
        return max(map(self.fastest, times)) * (end - start)

    def soon(self, t: float, end: float, bands: float) -> float:
        """Return when the bodies may have moved by so many touch bands since t; at most the end."""
        speed = self.fastest(t)
        return min(t + bands * self.tolerance / speed, end) if speed > 0.0 else end

    def velocity(self, t: float) -> Vector | None:
        """Return that of A relative to B, in the piece of t; None: a body turns, or is curved."""
        at = self._travel.at_one(t)
        of_a, of_b = ([at.joint(j) for j in joints] for _, joints in self._sides)
        if self.pair.curved or any(own.rate[0] for own in (*of_a, *of_b)):
            return None
        slides = [own.slide[0] for own in of_a] + [-own.slide[0] for own in of_b]
        x, y, z = map(float, sum(slides, start=ORIGIN))
        return x, y, z

    def apart(self, t: float, end: float, offset: Vector = ORIGIN, gap: float = 0.0) -> float:
        """The time after t, up to `end`, for which the surfaces are farther apart than `gap` if A
        is moved by `offset`. end: in the same pieces as t."""
        hulls = self._asked(core.safe_time, t, offset, level=gap, limit=end - t)
        if self.convex or hulls.value >= end - t or not self.pair.may("exact"):
            return hulls.value
        self.hulls_apart = False
        result = self._asked(core.safe_time, t, offset, surfaces=True, level=gap, limit=end - t)
        self.obstacle = result.triangle_a, result.triangle_b
        return max(hulls.value, result.value)

    def shallow(self, t: float, end: float) -> float:
        """The time for which the hulls, and so the bodies, overlap by no more than the
        tolerance."""
        return self._asked(core.safe_time, t, level=-self.tolerance, limit=end - t).value

    def least_gap(self, start: float, end: float, floor: float = 0.0) -> tuple[float, float]:
        """(lower, upper) of the signed distance of two convex bodies, or of the distance of other
        surfaces. lower holds at all times from start to end, which lie in the same pieces; upper
        holds in the middle. floor: if the distance is below it, lower may be any bound >= 0."""
        middle = 0.5 * (start + end)
        window = max(middle - start, end - middle)
        if self.convex:
            result = self._asked(core.least_gap, middle, window=window)
            return result.value, result.upper + self.pad
        result = self._asked(core.least_gap, middle, surfaces=True, window=window, floor=floor)
        return max(result.value, 0.0), result.upper + self.pad

    def least_hull_gap(self, start: float, end: float) -> float:
        """A lower bound of the signed distance of the hulls. Its negative is an upper bound of
        their depth."""
        middle = 0.5 * (start + end)
        window = max(middle - start, end - middle)
        return self._asked(core.least_gap, middle, window=window).value

    def placed(self, t: float) -> Pair:
        """The pair as placed at t, with the touch band of the sweep, and only its relation
        requested."""
        try:
            a, b = (self._travel.moved(k, t) for k, _ in self._sides)
        except (ValueError, OverflowError) as error:
            raise Unanswerable(f"a body cannot be placed at t = {t:.6g}: {error}") from None
        return replace(
            self.pair,
            a=a,
            b=b,
            request=Request({"overlap": ALWAYS}, tolerance=self.tolerance),
            meter=None,
            peers=None,
            moves=None,
        )

    def found_at(
        self, t: float, clearance: float | None = None, tolerance: float | None = None
    ) -> Finding:
        """The finding at t, exact for the poses rounded to float64. clearance: it has to keep.
        tolerance: instead of the touch band of the sweep."""
        placed = self.placed(t)
        by: dict[Effect, str] = {"overlap": ALWAYS}
        if clearance:
            by["distance"] = ALWAYS
        width = self.tolerance if tolerance is None else tolerance
        request = Request(by, tolerance=width, clearance=clearance)
        return self.found(replace(placed, request=request))

    def found(self, placed: Pair) -> Finding:
        """The finding of the pair as placed at some t."""
        with self.counting(placed):
            draft = Draft(placed)
            finding = examine(draft)
            self.pair.sweep_steps += draft.steps + draft.work
        return finding

    @contextmanager
    def counting(self, placed: Pair) -> Iterator[None]:
        """Count what is done with the pair as placed. Raises BudgetSpent."""
        self._spend(STEPS_OF_POSE + STEPS_OF_PLACED_TRIANGLE * self.pair.triangles)
        before = placed.moved_steps
        yield
        self.pair.sweep_steps += placed.moved_steps - before

    def _spend(self, steps: int) -> None:
        if self.pair.sweep_wants_more:
            raise BudgetSpent
        self.pair.sweep_steps += steps

    def _asked(
        self,
        ask: Ask,
        t: float,
        offset: Vector = ORIGIN,
        *,
        surfaces: bool = False,
        **bounds: float,
    ) -> core.MotionAnswer:
        """Ask about the hulls of the bodies, or about their surfaces. Curved shapes stand for
        both."""
        self.steps += 1
        if self.steps > self._most_steps or self.visits >= VISITS:
            raise BudgetSpent
        self._spend(STEPS_OF_QUERY)
        (a, frame_a), (b, frame_b) = (
            (body.surface(), IDENTITY) if surfaces and not body.curved else _shape_of(body)
            for body in (self.pair.a, self.pair.b)
        )
        side_a, side_b = self._sides
        span = bounds.get("limit", bounds.get("window", 0.0))
        moving_a = self._travel.moving(side_a, t, span, offset, frame_a)
        moving_b = self._travel.moving(side_b, t, span, ORIGIN, frame_b)
        if surfaces:
            bounds["work"] = VISITS - self.visits
        answer = ask(a, moving_a, b, moving_b, pad=self.pad, slack=self._rates(t)[1], **bounds)
        if surfaces:
            self.visits += answer.visits
            self.pair.sweep_steps += STEPS_OF_VISIT * answer.visits
        return answer


def holed(pair: Pair) -> list[str]:
    """Return the bodies with holes whose fill may matter. Sheets have no inside, and with
    --allow-open every open part is a sheet."""
    if pair.settings.allow_open:
        return []
    bodies = (body.body for body in (pair.a, pair.b))
    return [body.id for body in bodies if body.file.health.holes and not body.open]


def overlaps(finding: Finding) -> bool:
    """Proven, and not shown to be within the touch band."""
    return finding.relation in OVERLAPS and finding.exact_relation is not None


def _shape_of(body: PlacedBody) -> Shaped:
    """The hull of a body, or its curved shape, with its placement."""
    if body.curved is None:
        return body.hull_shape(), IDENTITY
    turn = tuple(chain.from_iterable(rows_of(body.curved.turn)))
    return body.curved.shape, placed(turn, body.curved.centre)
