"""What `satcheck suggest` proposes: pairs that a scene may want to allow, with the evidence."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Interval, Relation, Tool, Value

Why = Literal["adjacent", "always", "contact", "never"]
Names = tuple[str, str]


class Suggestion(Value, frozen=True):
    """One pair that no rule allows, ids in the order of the bodies.

    why: adjacent: a joint connects their links. contact: as placed. always, never: in contact in
    all of the poses, or in none and separated as placed; never proves nothing about other poses.
    links: that carry them; None: not of the only robot. relation: as placed; None: separated in the
    poses too. depth_bounds: contains the depth of an overlap as placed. contacts: in how many of
    the poses they overlap or touch; None: no other poses.
    """

    a: str
    b: str
    why: Why
    links: Names | None = None
    relation: Relation | None = None
    depth_bounds: Interval | None = None
    contacts: Count | None = None


class Unchecked(Value, frozen=True):
    """One pair that no rule allows, and of which the check as placed could not say how it relates:
    it is not suggested. adjacent: a joint connects the links. reason: why it could not."""

    a: str
    b: str
    adjacent: bool
    links: Names | None
    reason: str


class SuggestionsReport(Value, frozen=True, kw_only=True):
    """Pairs that a scene may want to allow, each with its evidence. Lengths in the units of the
    scene.

    poses: how many were checked besides the placement. seed: of the poses; None: they are not
    random, or there are none. held: joints that do not move among the poses. undecided: the number
    of pairs of which something could not be decided. unchecked: those of them that could not be
    checked as placed.
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
