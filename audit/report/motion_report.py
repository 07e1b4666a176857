"""What is reported about two bodies while they move: plain data, and its one way into JSON values.

t runs from 0 to 1; lengths are in the units of the files.
"""

from __future__ import annotations

from typing import Any, Literal

from msgspec import Struct

Interval = tuple[float, float]
Relation = Literal["separated", "near", "touching", "penetrating", "indeterminate"]


class Place(Struct, frozen=True):
    """How far a body has come, in its motion's own terms: degrees turned, the length moved, or t on
    a path of poses."""

    body: str
    term: Literal["degrees", "length", "t"]
    value: float

    def to_dict(self) -> dict[str, Any]:
        return {"body": self.body, "term": self.term, "value": self.value + 0.0}


class WorstPose(Struct, frozen=True):
    """The deepest pose of bodies that overlap, else the nearest. distance, depth: proven bounds of
    the least distance, or the greatest depth, over the whole motion; the end that is worse is
    bounded, the other is reached at `time`. One of the two is None."""

    time: float
    at: tuple[Place, ...]
    distance: Interval | None = None
    depth: Interval | None = None

    def to_dict(self) -> dict[str, Any]:
        return {
            "time": self.time,
            "at": [place.to_dict() for place in self.at],
            "distance": self.distance and list(self.distance),
            "depth": self.depth and list(self.depth),
        }


class Sweep(Struct, frozen=True):
    """A pair over its whole motion.

    relation: the worst of it. `separated`: no common point at any t; `near`: closer than the
    clearance at some; `touching`: they come as close as the tolerance, or could not be proven not
    to, and overlap by no more than it at any t; `penetrating`: they overlap by more at some t.
    tolerance: the touch band of the sweep. time_of_impact: before its lower end there is no such
    overlap; at its upper end a check of the bodies, posed and rounded to float64, finds one. at:
    the pose there. contact: a t before which they have no common point. reached: up to there
    no overlap is proven. reason: of `indeterminate`, or what
    surfaces alone left open. steps: what it took. proven: False of a hit that boxes or hulls alone
    show, at an accuracy below exact; in JSON the quality of the finding says so.
    """

    relation: Relation
    tolerance: float
    reached: float
    time_of_impact: Interval | None = None
    at: tuple[Place, ...] = ()
    contact: float | None = None
    worst: WorstPose | None = None
    reason: str | None = None
    steps: int = 0
    proven: bool = True

    def to_dict(self) -> dict[str, Any]:
        return {
            "relation": self.relation,
            "time_of_impact": self.time_of_impact and list(self.time_of_impact),
            "at": [place.to_dict() for place in self.at],
            "contact": self.contact,
            "reached": self.reached,
            "worst": self.worst and self.worst.to_dict(),
            "tolerance": self.tolerance,
            "steps": self.steps,
            "reason": self.reason,
        }
