"""The report of `satcheck colliders`: how faithful the colliders of links are to what is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from satcheck.report.report import Finding, Issue, PairCounts
from satcheck.report.settings import StatedConfig
from satcheck.report.values import Interval, Length, Tool, Value, Vector, Verdict

# The rules of findings about colliders, for formats that list findings about two bodies, and verbs.
STICKS_OUT, FALLS_SHORT = "collider-out", "collider-short"
OF_COLLIDERS = {STICKS_OUT: "sticks out", FALLS_SHORT: "falls short"}


class Farthest(Value, frozen=True):
    """A point of the surface of a body, and the nearest one of the other geometry."""

    body: str
    point: Vector
    nearest_body: str
    nearest: Vector


class Reach(Value, frozen=True, kw_only=True):
    """How far one geometry reaches out of the other: the largest distance of a point of its surface
    from the other one, which is 0 inside.

    bounds: contain it. farthest: the point is at least the lower bound away; None: that is 0.
    reason: why the interval is wide; None: it is narrow.
    """

    bounds: Interval
    farthest: Farthest | None = None
    reason: str | None = None


class Opening(Value, frozen=True, kw_only=True):
    """A ball that passes straight through the drawn geometry, and not through the colliders.

    diameter: of the ball, proven. point: on the line of its centre. direction: of the line, a unit
    vector.
    """

    diameter: Length
    point: Vector
    direction: Vector


class ColliderPart(Value, frozen=True, kw_only=True):
    """A link with its drawn bodies and its colliders; where a file states no links, the smallest
    node with both below.

    visuals, colliders: ids of bodies. out: the colliders out of the drawn geometry; None: not
    measured. short: the drawn geometry out of the union of the colliders; None: not measured.
    opening: the largest that was found; None: none was found, which does not prove that there is
    none. verdict: by the limits, and incomplete if they leave it open; None: only one kind of
    geometry is there, and no limit asks for the other one. reason: of a verdict that is no pass,
    and why something is not measured. notes: what else has to be known.
    """

    name: str
    visuals: tuple[str, ...]
    colliders: tuple[str, ...]
    out: Reach | None = None
    short: Reach | None = None
    opening: Opening | None = None
    verdict: Verdict | None = "pass"
    reason: str | None = None
    notes: tuple[str, ...] = ()

    def reaches(self, limits: ColliderLimits) -> Iterator[tuple[str, Reach | None, Length | None]]:
        """Yield a rule of `OF_COLLIDERS`, the reach, and its limit."""
        yield STICKS_OUT, self.out, limits.max_out
        yield FALLS_SHORT, self.short, limits.max_short


class ColliderLimits(Value, frozen=True, kw_only=True):
    """max_out, max_short: limits; None: none is given."""

    max_out: Length | None = None
    max_short: Length | None = None


class CollidersReport(Value, frozen=True, kw_only=True):
    """How faithful colliders are. World frame, lengths in the units of the files.

    verdict: the worst of all parts and of the check of the colliders; incomplete if no part has
    both kinds of geometry. message: says why. parts: the worst first. pairs: of colliders, as a
    check counts them at rest. overlaps: its findings that fail or are undecided. issues: about the
    inputs. config: the options that a config file set; None: no config file took part.
    """

    schema: Literal["satcheck.colliders/1"] = "satcheck.colliders/1"
    tool: Tool
    units: str | None
    settings: ColliderLimits
    verdict: Verdict
    message: str
    parts: tuple[ColliderPart, ...]
    pairs: PairCounts
    overlaps: tuple[Finding, ...]
    issues: tuple[Issue, ...]
    config: StatedConfig | None = None
