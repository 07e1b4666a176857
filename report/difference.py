"""How the results of a batch differ from those of an older one: `satcheck.difference/1`."""

from __future__ import annotations

from typing import Literal, get_args

from satcheck.report.assets import AssetVerdict
from satcheck.report.baseline import KnownFinding
from satcheck.report.report import Issue
from satcheck.report.values import Count, Tool, Value

SCHEMA: Literal["satcheck.difference/1"] = "satcheck.difference/1"
# new: it fails now, and did not before. worse, better: proven, as intervals of a figure do not
# overlap, or by the relation. undecided: it fails in both and may be worse, or it is undecided now.
# unchecked: it failed before, and its bodies or its question are no longer there. gone: it failed
# before, was checked again, and does not fail.
FindingState = Literal["new", "worse", "undecided", "unchecked", "better", "gone"]
FINDING_STATES: tuple[FindingState, ...] = get_args(FindingState)
SceneState = Literal["added", "removed", "both"]


class FindingChange(Value, frozen=True):
    """A pair of bodies. before, now: its failing finding, with the upper ends of its figures, and
    the lower ends of gaps; None: it has none, or none that is decided."""

    a: str
    b: str
    state: FindingState
    before: KnownFinding | None
    now: KnownFinding | None


class SceneChange(Value, frozen=True):
    """A scene that is new, that is not there any more, or of which the verdict or a finding
    changed. file: its name; of several files, all of them. before, now: its verdicts."""

    file: str
    state: SceneState
    before: AssetVerdict | None
    now: AssetVerdict | None
    findings: tuple[FindingChange, ...]


class SceneCounts(Value, frozen=True, kw_only=True):
    """same: without any change. changed: in both, with a change."""

    added: Count
    removed: Count
    changed: Count
    same: Count


class FindingCounts(Value, frozen=True, kw_only=True):
    """Of failing findings. unchanged: proven to be neither worse nor better."""

    new: Count
    worse: Count
    undecided: Count
    unchecked: Count
    better: Count
    gone: Count
    unchanged: Count


class Difference(Value, frozen=True, kw_only=True):
    """verdict: error: a scene cannot be read, and could be before. fail: a finding is new or worse.
    incomplete: one is undecided or unchecked, a scene is incomplete that was not, or a batch did
    not finish. scenes: those with a change, in the order of their names. issues: about the files
    of results."""

    schema: Literal["satcheck.difference/1"] = SCHEMA
    tool: Tool
    verdict: AssetVerdict
    scenes: SceneCounts
    findings: FindingCounts
    changes: tuple[SceneChange, ...]
    issues: tuple[Issue, ...]
