"""What is reported about two bodies while they move: plain data.

t runs from 0 to 1; lengths are in the units of the files.
"""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Interval, Length, Share, Value

SweptRelation = Literal["separated", "near", "touching", "penetrating", "indeterminate"]


class Place(Value, frozen=True):
    """How far a body has come, in its motion's own terms: degrees turned, the length moved, or t on
    a path of poses."""

    body: str
    term: Literal["degrees", "length", "t"]
    value: float


class WorstPose(Value, frozen=True):
    """The deepest pose of bodies that overlap, else the nearest. distance, depth: proven bounds of
    the least distance, or the greatest depth, over the whole motion; the end that is worse is
    bounded, the other is reached at `time`. One of the two is None."""

    time: Share
    at: tuple[Place, ...]
    distance: Interval | None = None
    depth: Interval | None = None


class Sweep(Value, frozen=True, kw_only=True):
    """A pair over its whole motion.

    relation: the worst of it. `separated`: no common point at any t; `near`: closer than the
    clearance at some; `touching`: they come as close as the tolerance, or could not be proven not
    to, and overlap by no more than it at any t; `penetrating`: they overlap by more at some t.
    tolerance: the touch band of the sweep. time_of_impact: before its lower end there is no such
    overlap; at its upper end a check of the bodies, posed and rounded to float64, finds one. at:
    the pose there. contact: a t before which they have no common point. reached: up to there
    no overlap is proven. reason: of `indeterminate`, or what
    surfaces alone left open. steps: what it took. proven: False of a hit that boxes or hulls alone
    show, at an accuracy below exact.
    """

    relation: SweptRelation
    time_of_impact: Interval | None = None
    at: tuple[Place, ...] = ()
    contact: Share | None = None
    reached: Share
    worst: WorstPose | None = None
    tolerance: Length
    steps: Count = 0
    proven: bool = True
    reason: str | None = None
