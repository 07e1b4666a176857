"""The report of `satcheck suggest`: pairs that a scene may allow, with the evidence."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Interval, Length, Relation, Tool, Value

Why = Literal["adjacent", "always", "contact", "never"]
Names = tuple[str, str]


class Suggestion(Value, frozen=True):
    """A pair that no rule allows, ids in the order of the bodies.

    why: contact: they overlap as placed, and a rule may limit that. The others are pairs of links
    that a rule may allow. adjacent: a joint connects them. always: in contact in all poses. never:
    in contact in no pose, and separated as placed; this proves nothing about other poses. links: of
    the bodies; None: they do not belong to the only robot. relation: as placed; None: separated in
    the poses too. thickness_bounds, depth_bounds: contain the figures of an overlap as placed.
    max_thickness, max_depth: the limits of a rule: the upper ends and a margin; None: that figure
    has no proven upper end. contacts: the number of poses in which they overlap or touch; None: no
    other poses. asset: the file, of several that are worlds of their own.
    """

    a: str
    b: str
    why: Why
    links: Names | None = None
    relation: Relation | None = None
    thickness_bounds: Interval | None = None
    depth_bounds: Interval | None = None
    max_thickness: Length | None = None
    max_depth: Length | None = None
    contacts: Count | None = None
    asset: str | None = None


class Unchecked(Value, frozen=True):
    """A pair that no rule allows and that is not suggested, because its relation as placed is
    undecided, or its overlap has no figure with a proven upper end. adjacent: a joint connects the
    links. reason: why."""

    a: str
    b: str
    adjacent: bool
    links: Names | None
    reason: str
    asset: str | None = None


class SuggestionsReport(Value, frozen=True, kw_only=True):
    """Pairs that a scene may allow, each with its evidence. Lengths in the units of the scene.

    poses: the number of poses checked besides the placement. seed: of the poses; None: they are not
    random, or there are none. held: joints that do not move among the poses. undecided: the number
    of undecided pairs. unchecked: those of them that are undecided as placed.
    """

    schema: Literal["satcheck.suggestions/1"] = "satcheck.suggestions/1"
    tool: Tool
    units: str | None
    poses: Count = 0
    seed: Count | None = None
    held: tuple[str, ...] = ()
    suggestions: tuple[Suggestion, ...]
    undecided: Count
    unchecked: tuple[Unchecked, ...]
