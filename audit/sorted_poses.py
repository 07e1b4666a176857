"""Poses whose pairs the core has sorted (`posed_pairs.py`), and what they add to the samples.

Findings are made only for pairs that the core leaves open, and for poses that the report lists.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.checked_pairs import examine_pairs
from satcheck.audit.pair_queue import PairQueue
from satcheck.audit.posed_pairs import APART, DEEP, OPEN, UNDECIDED, PosedPairs
from satcheck.audit.sample_results import SingleChecks, is_plain
from satcheck.report.report import Finding, Issue, Verdict
from satcheck.report.samples import SampledPose
from satcheck.report.verdict import fails
from satcheck.scene.robot.pose_batches import PoseBatch

if TYPE_CHECKING:
    from satcheck.audit.bodies.pair import Pair
    from satcheck.audit.posed_pairs import Codes, Numbers
    from satcheck.core.overlap_volume import VolumeMeter

# Pairs that climb the ladder together.
TOGETHER = 512


def sorted_and_counted(
    checks: SingleChecks,
    batches: Iterator[PoseBatch],
    pairs: PosedPairs,
    meter: VolumeMeter | None,
) -> Iterator[PoseBatch]:
    """While one batch is counted, the core sorts the pairs of the next one in a second thread. With
    one job it does not."""
    waiting: _SortedBatch | None = None
    with ThreadPoolExecutor(1) as beside:
        for batch in batches:
            matrices = batch.matrices(checks.scene)
            sorting = beside.submit(pairs.sift, matrices)
            if checks.settings.jobs == 1:
                wait([sorting])
            if waiting is not None:
                yield waiting.count()
            waiting = _SortedBatch(checks, batch, matrices, sorting, pairs, meter)
        if waiting is not None:
            yield waiting.count()


class _Row(Struct):
    """One pose. climbs: the pairs that climb the ladder, by their numbers; by_pair: the findings of
    those that have climbed. others: whether other pairs overlap or are undecided. alone: the pose
    needs a check of its own."""

    row: int
    climbs: list[int]
    others: bool
    by_pair: dict[int, Finding] = {}
    alone: bool = False

    @property
    def is_noted(self) -> bool:
        return self.others or self.alone or not all(map(is_plain, self.by_pair.values()))

    def findings(self) -> tuple[Finding, ...]:
        return tuple(f for _, f in sorted(self.by_pair.items()) if not is_plain(f))


class _SortedBatch:
    """Poses whose pairs the core has sorted."""

    def __init__(
        self,
        checks: SingleChecks,
        batch: PoseBatch,
        matrices: Numbers,
        sorting: Future[Codes],
        pairs: PosedPairs,
        meter: VolumeMeter | None,
    ) -> None:
        self._checks, self._results, self._batch = checks, checks.results, batch
        self._matrices, self._sorting = matrices, sorting
        self._pairs, self._meter = pairs, meter

    def count(self) -> PoseBatch:
        results = self._results
        self._sorted = _with_reasons(self._sorting.result())
        climbing = np.flatnonzero((self._sorted == OPEN).any(axis=1)).tolist()
        rows = {row: self._row(row) for row in climbing}
        self._climb(rows.values())
        listed = self._listed(rows)
        self._climb(listed.values())
        self._count_sorted(sorted({*range(self._batch.count)} - {*rows, *listed}))
        for number, row in sorted((rows | listed).items()):
            if row.alone:
                results.add(self._checks.sample(self._batch, number))
            elif number in listed:
                results.add(self._sample(row))
            else:
                self._count_unlisted(row)
        return self._batch

    def _row(self, row: int) -> _Row:
        codes = self._sorted[row]
        others = bool(((codes == DEEP) | (codes == UNDECIDED)).any())
        return _Row(row, np.flatnonzero(codes == OPEN).tolist(), others)

    def _listed(self, rows: Mapping[int, _Row]) -> dict[int, _Row]:
        """The poses to list, with all pairs that still have to climb. rows: those that have."""
        if self._results.lists_all:
            numbers = list(range(self._batch.count))
        else:
            sorted_out = ((self._sorted == DEEP) | (self._sorted == UNDECIDED)).any(axis=1)
            noted = {*np.flatnonzero(sorted_out).tolist()}
            noted |= {number for number, row in rows.items() if row.is_noted}
            numbers = sorted(noted)[: self._results.room]
        listed = {}
        for number in numbers:
            row = rows.get(number) or self._row(number)
            others = np.flatnonzero(self._sorted[number] != APART).tolist()
            listed[number] = replace(row, climbs=[k for k in others if k not in row.by_pair])
        return listed

    def _climb(self, rows: Iterable[_Row]) -> None:
        """Makes the findings of the pairs that climb."""
        climbing: list[tuple[_Row, int, Pair]] = []
        for row in rows:
            try:
                pairs = self._pairs.at(self._matrices, row.row, row.climbs, self._meter)
            except (ValueError, OverflowError):  # the check of this pose says what is wrong
                row.alone = True
                continue
            climbing += [(row, n, pair) for n, pair in zip(row.climbs, pairs, strict=True)]
            if len(climbing) >= TOGETHER:
                self._examine(climbing)
                climbing = []
        self._examine(climbing)

    def _examine(self, climbing: Sequence[tuple[_Row, int, Pair]]) -> None:
        queue = PairQueue(self._checks.settings.jobs)
        checked = examine_pairs([pair for *_, pair in climbing], queue)
        for (row, number, _), pair in zip(climbing, checked, strict=True):
            row.by_pair[number] = pair.finding
            self._results.issues |= dict.fromkeys(pair.issues)

    def _sample(self, row: _Row) -> SampledPose:
        posture = self._batch.posture(self._checks.scene, row.row)
        findings = row.findings()
        verdict = self._verdict(findings)
        number = self._batch.first + row.row
        issues = tuple(Issue(i.code, i.severity, i.body, i.file, i.message) for i in posture.issues)
        return SampledPose(number, posture.pose(), verdict, findings, issues)

    def _count_unlisted(self, row: _Row) -> None:
        """A pose with findings."""
        number, findings = self._batch.first + row.row, row.findings()
        for finding in findings:
            a, b = finding.a, finding.b
            self._results.tally(a, b).count(finding, number, self._results.fail_on)
        self._count_sorted([row.row], self._verdict(findings))

    def _count_sorted(self, rows: Sequence[int], rest: Verdict = "pass") -> None:
        """Poses as the core has sorted their pairs. rest: their verdict without these pairs."""
        codes, names, failing = self._sorted[rows], self._pairs.names, self._pairs.deep_fails
        deep, undecided = codes == DEEP, codes == UNDECIDED
        for k in np.flatnonzero(deep.any(axis=0)).tolist():
            met = np.flatnonzero(deep[:, k])
            first = self._batch.first + rows[met[0]]
            self._results.tally(*names[k]).count_overlaps(len(met), first, fails=bool(failing[k]))
        for k in np.flatnonzero(undecided.any(axis=0)).tolist():
            self._results.tally(*names[k]).undecided += int(undecided[:, k].sum())
        failed = (deep & failing).any(axis=1) | (rest == "fail")
        incomplete = ~failed & (undecided.any(axis=1) | (rest == "incomplete"))
        counts = self._results.by_verdict
        counts["fail"] += int(failed.sum())
        counts["incomplete"] += int(incomplete.sum())
        counts["pass"] += int((~failed & ~incomplete).sum())

    def _verdict(self, findings: Sequence[Finding]) -> Verdict:
        """As a report with these findings has it."""
        if any(fails(finding, self._results.fail_on) for finding in findings):
            return "fail"
        return "incomplete" if any(f.undecided is not None for f in findings) else "pass"


def _with_reasons(codes: Codes) -> Codes:
    """Opens each undecided pair in the first of these poses where it is undecided, so that the
    ladder gives the reason."""
    undecided = codes == UNDECIDED
    pairs = np.flatnonzero(undecided.any(axis=0))
    opened = codes.copy()
    opened[undecided[:, pairs].argmax(axis=0), pairs] = OPEN
    return opened
