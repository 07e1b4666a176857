"""The order of findings and of assets for people: the worst first, pairs of the same parts
together."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from heapq import nsmallest
from math import inf
from typing import TYPE_CHECKING, TypeVar

from satcheck.cli.formats.words import is_hit
from satcheck.report.assets import ASSET_VERDICTS
from satcheck.report.report import OVERLAPS, SEVERITIES

if TYPE_CHECKING:
    from satcheck.report.assets import Asset
    from satcheck.report.report import Finding, Relation, Severity

_MILDER: tuple[Relation, ...] = ("indeterminate", "touching", "near", "separated")


_T = TypeVar("_T")


def severity(finding: Finding) -> Severity:
    """A finding that a baseline holds, unchanged, is a note."""
    return "note" if finding.baseline_state == "unchanged" else finding.severity


def is_listed(finding: Finding) -> bool:
    """Whether there is something to see."""
    return finding.severity != "none" or finding.undecided is not None


def worst_first(findings: Iterable[Finding]) -> list[Finding]:
    """By severity, then the thicker overlap, then the deeper one, then the earlier hit."""
    return sorted(findings, key=rank)


def groups_of(
    findings: Iterable[Finding], alone: Collection[str] = frozenset()
) -> list[list[Finding]]:
    """Findings that are the worst first: of one severity, all pairs between two parts in a group,
    which stands where its worst finding stands. alone: ids of bodies that are parts of their
    own."""
    groups: dict[tuple[str, frozenset[str]], list[Finding]] = {}
    for finding in findings:
        ids = finding.a, finding.b
        parts = frozenset(id_ if id_ in alone else _part(id_) for id_ in ids)
        groups.setdefault((severity(finding), parts), []).append(finding)
    return list(groups.values())


def rank(finding: Finding) -> tuple[float, ...]:
    """The lower the worse."""
    return (SEVERITIES.index(severity(finding)), *_size(finding))


def asset_rank(asset: Asset) -> tuple[float, ...]:
    """The lower the worse: by verdict, then by the worst finding."""
    worst = min(map(rank, asset.report.findings), default=(inf,))
    return (ASSET_VERDICTS.index(asset.verdict), *worst)


def worst_of(
    things: Iterable[_T], top: int | None, rank: Callable[[_T], tuple[float, ...]]
) -> list[_T]:
    """The worst ones, at most `top`, from things that may be too many for the memory. Equals keep
    their order."""
    return sorted(things, key=rank) if top is None else nsmallest(top, things, key=rank)


def _size(finding: Finding) -> tuple[int, float, float]:
    """An overlap is no thicker than deep, so its depth stands for a thickness that is unknown."""
    if finding.at_rest in OVERLAPS:
        deep = inf if finding.depth is None else finding.depth
        thick = deep if finding.thickness is None else finding.thickness
        return (0, -thick, -deep)
    if is_hit(finding):
        return (1, _first_time(finding), 0.0)
    gap = inf if finding.distance is None else finding.distance
    return (2 + _MILDER.index(finding.at_rest), gap, 0.0)


def _first_time(hit: Finding) -> float:
    impact = hit.motion and hit.motion.time_of_impact
    return impact[1] if impact else 0.0


def _part(id_: str) -> str:
    """`gripper` of `gripper/left`: the node or the link that the body belongs to."""
    return id_.rpartition("/")[0] or id_
