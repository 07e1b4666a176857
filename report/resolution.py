"""The report of `satcheck resolve`: translations that end the overlaps of a scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from satcheck.report.report import Issue, PairCounts
from satcheck.report.values import Count, Length, Relation, Tool, Value, Vector, Verdict

ResolutionVerdict = Literal["resolved", "unresolved", "incomplete"]


class Move(Value, frozen=True):
    """A moved body. translation: in the world. length: of the translation."""

    body: str
    translation: Vector
    length: Length


class Left(Value, frozen=True):
    """An unresolved pair, and the reason. relation: of the bodies as placed, or the worst of the
    motion if the motion is the problem."""

    a: str
    b: str
    relation: Relation
    reason: str


class ResolutionSummary(Value, frozen=True, kw_only=True):
    """verdict: of the check of the moved scene. resolved: everything was checked, and no pair
    fails. incomplete: no pair is known to fail, but not everything could be checked.

    conflicts: pairs that did not pass a check before: they overlapped beyond what rules allow, were
    closer than their clearance (gaps), or met a hole that leaves open whether they overlap (open).
    remaining: pairs of the moved scene that do not pass. flush: pairs that overlap by no more than
    the tolerance, which counts as touching. moved, pinned: bodies. total_motion: the sum of the
    lengths of all translations. rounds: how often overlapping bodies were pushed.
    """

    verdict: ResolutionVerdict
    conflicts: Count
    gaps: Count
    open: Count
    remaining: Count
    flush: Count
    moved: Count
    pinned: Count
    total_motion: Length
    largest_motion: Length
    rounds: Count


class MovedCheck(Value, frozen=True):
    """The check of the moved scene, in short. by_relation: only the relations that occur."""

    verdict: Verdict
    pairs: PairCounts
    by_relation: Mapping[Relation, Count]


class ResolutionReport(Value, frozen=True, kw_only=True):
    """Translations that end the overlaps of a scene. World frame, lengths in the units of the
    files.

    units: as the scene declares them. output: the file that the moved scene was written to; `check`
    is about that file; None: no file was written. moves: in the order of the scene. pinned: bodies
    that had to stay: static, or pinned.
    """

    schema: Literal["satcheck.resolution/1"] = "satcheck.resolution/1"
    tool: Tool
    units: str | None
    output: str | None
    summary: ResolutionSummary
    moves: tuple[Move, ...]
    pinned: tuple[str, ...]
    left: tuple[Left, ...]
    check: MovedCheck
    issues: tuple[Issue, ...]
