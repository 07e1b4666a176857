"""A pair of bodies and its request: what to compute, how far to climb the ladder, which tools."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck.audit.body import PlacedBody, diagonal, largest_coordinate
from satcheck.audit.settings import ACCURACIES, THICKNESS_SHARE, Accuracy, Settings
from satcheck.core.conventions import axes_of
from satcheck.core.steps import step_in_words
from satcheck.report.request import Request

if TYPE_CHECKING:
    from satcheck.core.peers import Peers, VolumeMeter
    from satcheck.report.sweep import Sweep


# The most steps of the climbs of a scene, about five seconds, and more for each triangle of its
# bodies. Scenes of real bodies take far fewer: 20,000 bodies of the bench, with 16,000 pairs, 3,500
# for a pair; chain links in contact 90,000. The largest known are those of bolts that fill their
# holes, with the facets of a tessellator: up to 60,000 for a triangle of two such bodies. A bolt
# meets about three.
STEPS_OF_SCENE = 5_000_000_000
STEPS_OF_TRIANGLE = 200_000
# The same for a triangle of a mesh of which the scene has other bodies, and for a curved shape.
STEPS_OF_COPIED_TRIANGLE, STEPS_OF_SHAPE = 50_000, 5_000_000
MOST_STEPS = 2**63
# The most steps of the relations of moved bodies, in which a way out of a pair is verified, and
# more for each triangle.
STEPS_OF_MOVES, STEPS_OF_MOVED_TRIANGLE = 1_000_000_000, 200_000

# The steps that any sweep may take.
STEPS_OF_SWEEP = 1_000_000
# The most of the only pair of a scene: a spike that slides along a face takes five billion.
STEPS_OF_LONE_SWEEP = 6_000_000_000

# The default touch band is at most this fraction of the smaller body's box diagonal. The touch band
# of a part that is 1/4000 of its assembly still has the full precision of float32 coordinates.
TOUCH_FRACTION = 1e-3

_RANK = {rung: place for place, rung in enumerate(ACCURACIES)}


class Moves(Struct, frozen=True):
    """Two bodies that move relative to each other. sweep: gives the result of their motion, from
    the pair as placed. clear: they may not touch on the way, unless they touch as placed."""

    sweep: Callable[[Pair], Sweep]
    clear: bool = False


class Pair(Struct, eq=False):
    """tolerance: half width of the touch band, world units. gap_limit: a larger gap needs no
    figure, because it is neither near nor in the touch band.

    By default the tolerance is the sum of the input precisions of both bodies. It is limited, so
    that coarse coordinates far from the origin do not hide a whole body. It is at least the
    deviation of polygons from the curves that they replace. off: how far the surfaces of A and B
    may be off: half the tolerance, or the surface tolerance of the body if that is more. closer:
    with --planar, how much closer (or deeper) the bodies may be than their polygons, which lie
    within them; else 0.0. moves: the relative motion of the bodies; None: they do not move.
    alone: no other pair needs these bodies. work: the most steps of a search of the depth; 0: those
    of the settings. steps: the most of the climb, beside those that any pair may take. moved_steps:
    spent on the relations of moved bodies; sweep_steps: on the sweep; explain_steps: on whether
    surfaces that may be off explain the overlap.
    """

    a: PlacedBody
    b: PlacedBody
    settings: Settings
    request: Request
    meter: VolumeMeter | None = None
    peers: Peers | None = None
    moves: Moves | None = None
    alone: bool = False
    work: int = 0
    steps: int = MOST_STEPS
    moved_steps: int = 0
    sweep_steps: int = 0
    explain_steps: int = 0
    tolerance: float = 0.0  # __post_init__ sets these four
    gap_limit: float = 0.0
    off: tuple[float, float] = (0.0, 0.0)
    closer: float = 0.0

    def __post_init__(self) -> None:
        self.work = self.work or self.settings.work
        asked = self.request.tolerance
        self.tolerance = tolerance = self._resolution() if asked is None else asked
        own_a, own_b = self.a.surface_tolerance, self.b.surface_tolerance
        self.off = max(0.5 * tolerance, own_a), max(0.5 * tolerance, own_b)
        if self.settings.planar:
            self.closer = self.a.body.file.deviation + self.b.body.file.deviation
        self.gap_limit = max((self.request.clearance or 0.0) + self.closer, tolerance)
        if self.settings.distance:
            self.gap_limit = math.inf

    def _resolution(self) -> float:
        plane = self.settings.planar
        if plane is None:
            size = min(self.a.diagonal, self.b.diagonal)
        else:
            axes = axes_of(plane)
            size = min(diagonal(body.bounds, axes) for body in (self.a, self.b))
        written = min(self.a.resolution + self.b.resolution, TOUCH_FRACTION * size)
        return max(written, self.a.body.file.deviation + self.b.body.file.deviation)

    @property
    def steps_for_moves(self) -> int:
        """Return how many steps the relations of moved bodies may still take."""
        most = STEPS_OF_MOVES + STEPS_OF_MOVED_TRIANGLE * self.triangles
        return max(most - self.moved_steps, 0)

    @property
    def sweep_wants_more(self) -> bool:
        """Return whether the sweep has taken as many steps as it may, of the only pair of a scene,
        too."""
        most = STEPS_OF_LONE_SWEEP + STEPS_OF_TRIANGLE * self.triangles
        return self.sweep_steps >= min(self.steps, most) + STEPS_OF_SWEEP

    @property
    def thickness_work(self) -> int:
        """Return the most steps of a search of the thickness."""
        return math.ceil(THICKNESS_SHARE * self.work)

    @property
    def excuses(self) -> bool:
        """Return whether surfaces may be off by more than the touch band."""
        return max(self.off) > 0.5 * self.tolerance

    @property
    def wants_distance(self) -> bool:
        """The size of the gap is needed, not only whether it is within the touch band."""
        return self.request.wants("distance") or self.closer > self.tolerance

    def may(self, rung: Accuracy) -> bool:
        """Return whether --accuracy lets this pair climb to the rung."""
        return _RANK[rung] <= _RANK[self.settings.accuracy]

    @property
    def largest_coordinate(self) -> float:
        return largest_coordinate(self.a.bounds, self.b.bounds)

    @property
    def curved(self) -> bool:
        """At least one body is a curved shape. Its mesh is only inscribed."""
        return self.a.curved is not None or self.b.curved is not None

    @property
    def on_half_space(self) -> bool:
        """A body is a half space. In a check in a plane it is the prism over its outline."""
        return self.a.endless or self.b.endless

    @property
    def open_on_purpose(self) -> bool:
        """Return whether every open mesh of the pair is meant to be open."""
        if self.settings.allow_open:
            return True
        bodies = self.a.body, self.b.body
        return any(body.open for body in bodies) and all(
            body.open or body.file.health.solid for body in bodies
        )

    @property
    def triangles(self) -> int:
        """The number of triangles of both bodies, in their files."""
        return self.a.shared.triangles + self.b.shared.triangles

    @property
    def both_solid(self) -> bool:
        return self.a.solid and self.b.solid

    @property
    def both_convex(self) -> bool:
        """The convex answer is the whole answer."""
        return self.a.convex and self.b.convex

    @contextmanager
    def searching(self, figure: str) -> Iterator[Callable[[float, float, float], None]]:
        """Show `depth of kettle and snowflake: 0.488 to 0.51, 12 % of the budget`, while it lasts,
        for whoever waits for a pair that takes long. Gives what a search of the core calls with its
        interval and the share of its budget that is spent."""
        with step_in_words() as say:

            def progress(lower: float, upper: float, share: float) -> None:
                interval = f"{max(lower, 0.0):.3g} to {max(upper, 0.0):.3g}"
                spent = f"{100 * share:.0f} % of the budget"
                say(f"{figure} of {self.a.id} and {self.b.id}: {interval}, {spent}")

            yield progress
