"""The results of a batch beside those of an older one, scene by scene."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from heapq import merge
from itertools import groupby, repeat

from msgspec.structs import replace

from satcheck.audit.difference import finding_changes
from satcheck.audit.summary import tool
from satcheck.batch.stored import Stored, StoredResults
from satcheck.report.assets import AssetVerdict, worst_verdict
from satcheck.report.difference import (
    Difference,
    FindingChange,
    FindingCounts,
    FindingState,
    SceneChange,
    SceneCounts,
    SceneState,
)

_VERDICTS: dict[FindingState, AssetVerdict] = {
    "new": "fail",
    "worse": "fail",
    "undecided": "incomplete",
    "unchecked": "incomplete",
    "better": "pass",
    "gone": "pass",
}


def difference(before: StoredResults, now: StoredResults) -> Difference:
    """Scenes are the same if their files have the same names. Holds what changed in memory."""
    scenes: Counter[str] = Counter()
    findings: Counter[str] = Counter()
    changes: list[SceneChange] = []
    for old, new in _beside(before, now):
        listed = list(_findings(old, new))
        findings.update("unchanged" if each is None else each.state for each in listed)
        change = _change(old, new, [each for each in listed if each is not None])
        changes += [change] if change else []
        scenes[_kind(change)] += 1
    verdicts = [before.least, now.least, *map(_verdict, changes)]
    return Difference(
        tool=tool(),
        verdict=worst_verdict(Counter(verdicts)),
        scenes=SceneCounts(**{name: scenes[name] for name in SceneCounts.__struct_fields__}),
        findings=FindingCounts(
            **{name: findings[name] for name in FindingCounts.__struct_fields__}
        ),
        changes=tuple(changes),
        issues=(*before.issues, *now.issues),
    )


def _beside(
    before: Iterable[Stored], now: Iterable[Stored]
) -> Iterator[tuple[Stored | None, Stored | None]]:
    """The older and the newer result of each scene, in the order of the names."""
    together = merge(zip(before, repeat(0)), zip(now, repeat(1)), key=_files)
    for _, same in groupby(together, key=_files):
        by_run = {k: each for each, k in same}
        yield by_run.get(0), by_run.get(1)


def _files(numbered: tuple[Stored, int]) -> tuple[str, ...]:
    return numbered[0].files


def _findings(old: Stored | None, new: Stored | None) -> Iterator[FindingChange | None]:
    """Those of a scene that was not there are new; a scene that is not there has none."""
    if new is None:
        return iter(())
    report = new.asset.report
    before = replace(report, findings=()) if old is None else old.asset.report
    return finding_changes(before, report)


def _change(
    old: Stored | None, new: Stored | None, findings: list[FindingChange]
) -> SceneChange | None:
    verdicts = [each.asset.verdict if each else None for each in (old, new)]
    if verdicts[0] == verdicts[1] and not findings:
        return None
    one = new or old
    assert one is not None
    state: SceneState = "added" if old is None else "removed" if new is None else "both"
    return SceneChange(one.asset.file, state, verdicts[0], verdicts[1], tuple(findings))


def _kind(change: SceneChange | None) -> str:
    if change is None:
        return "same"
    return "changed" if change.state == "both" else change.state


def _verdict(change: SceneChange) -> AssetVerdict:
    verdicts = Counter(_VERDICTS[each.state] for each in change.findings)
    if change.now in ("error", "incomplete") and change.now != change.before:
        verdicts[change.now] += 1
    return worst_verdict(verdicts)
