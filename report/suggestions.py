"""The report of `satcheck suggest`: pairs that a scene may allow, with the evidence."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Interval, Relation, Tool, Value

Why = Literal["adjacent", "always", "contact", "never"]
Names = tuple[str, str]


class Suggestion(Value, frozen=True):
    """A pair that no rule allows, ids in the order of the bodies.

    why: adjacent: a joint connects their links. contact: they touch or overlap as placed. always:
    in contact in all poses. never: in contact in no pose, and separated as placed; this proves
    nothing about other poses. links: of the bodies; None: they do not belong to the only robot.
    relation: as placed; None: separated in the poses too. depth_bounds: contain the depth of an
    overlap as placed. contacts: the number of poses in which they overlap or touch; None: no other
    poses.
    """

    a: str
    b: str
    why: Why
    links: Names | None = None
    relation: Relation | None = None
    depth_bounds: Interval | None = None
    contacts: Count | None = None


class Unchecked(Value, frozen=True):
    """A pair that no rule allows and that is not suggested, because its relation as placed is
    undecided. adjacent: a joint connects the links. reason: why it is undecided."""

    a: str
    b: str
    adjacent: bool
    links: Names | None
    reason: str


class SuggestionsReport(Value, frozen=True, kw_only=True):
    """Pairs that a scene may allow, each with its evidence. Lengths in the units of the scene.

    poses: the number of poses checked besides the placement. seed: of the poses; None: they are not
    random, or there are none. held: joints that do not move among the poses. undecided: the number
    of undecided pairs. unchecked: those of them that are undecided as placed.
    """

    schema: Literal["satcheck.suggestions/1"] = "satcheck.suggestions/1"
    tool: Tool
    units: str | None
    poses: Count
    seed: Count | None
    held: tuple[str, ...]
    suggestions: tuple[Suggestion, ...]
    undecided: Count
    unchecked: tuple[Unchecked, ...]
