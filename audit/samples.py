"""The check of robots in many poses.

The core first sorts the pairs of all poses (`posed_pairs.py`). A pair that is plainly apart needs
nothing else. A deep overlap counts without figures, and a pair that the fill of a hole decides
counts as undecided, unless the report lists its pose. All other pairs climb the ladder as in a
check of one pose.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.bodies.placed_bodies import BodyCache, place
from satcheck.audit.check import DEFAULT_SETTINGS, check, volume_meter
from satcheck.audit.checked_pairs import examine_pairs
from satcheck.audit.doubtful_sizes import size_of
from satcheck.audit.pair_queue import PairQueue
from satcheck.audit.posed_pairs import APART, DEEP, OPEN, UNDECIDED, PosedPair, PosedPairs, same_way
from satcheck.audit.request.planner import Planner
from satcheck.audit.request.settings import FailOn, Settings
from satcheck.audit.sampled import (
    LISTED_NOTED,
    LISTED_SAMPLES,
    VERDICTS,
    PairTally,
    Sample,
    Samples,
)
from satcheck.audit.severity import fails
from satcheck.report.report import Finding, Issue, Report, Verdict
from satcheck.scene.robot.assembly import posed
from satcheck.scene.robot.pose_batches import PoseBatch, pose_batches, require_joints

if TYPE_CHECKING:
    from satcheck.audit.bodies.pair import Pair
    from satcheck.core.overlap_volume import VolumeMeter
    from satcheck.scene import Scene
    from satcheck.scene.robot import Pose

Progress = Callable[[int, int], None]

# Poses whose placements are in memory at a time, and pairs that climb the ladder together.
BATCH = 2048
TOGETHER = 512


def check_poses(
    scene: Scene,
    poses: Sequence[Pose],
    settings: Settings = DEFAULT_SETTINGS,
    progress: Callable[[int, int], None] | None = None,
) -> Samples:
    """Check the scene in each of these poses of its robots. At least one pose is needed.

    scene: loaded, with `robots`. poses: joint -> values, for instance `scene.robot`'s
    `RandomPoses([robot.robot for robot in scene.robots], count, seed)`, which need no memory, or
    read by `read_poses`. progress(done, total) counts poses. Facts that depend on a mesh alone
    (convexity, parts) are computed once for all poses.

    Settings(depth=False) is much faster and decides only whether bodies meet. A pair in
    `Samples.pairs` that is always in contact has `contacts == number`; a pair that is always
    separated is `settled`.

    Raises SatcheckError for a pose with unknown joints, and what `check` raises.
    """
    if not poses:
        raise ValueError("no pose to check")
    settings = replace(settings, list_pruned=False)
    require_joints(scene, poses)  # all poses are judged before work is done
    cache = BodyCache()
    results = _Results(settings.fail_on, lists_all=len(poses) <= LISTED_SAMPLES)
    checks = _SingleChecks(scene, settings, cache, results)
    with ExitStack() as stack:
        pairs: PosedPairs | None = None
        meter: VolumeMeter | None = None
        for batch in pose_batches(scene, poses, BATCH):
            if batch.first == 1:
                pairs = _sortable(checks, batch)
            if pairs is None:
                for row in range(batch.count):
                    results.add(checks.sample(batch, row))
            else:
                if meter is None and any(pair.request.wants("volume") for pair in pairs.pairs):
                    meter = stack.enter_context(volume_meter(settings))
                _SortedBatch(checks, batch, pairs, meter).count()
            results.keep_first_poses(scene, batch)
            for number in range(batch.first, batch.first + batch.count):
                if progress is not None:
                    progress(number, len(poses))
    return results.samples(checks, len(poses))


class _Results:
    """What the samples so far have added up to."""

    def __init__(self, fail_on: FailOn, *, lists_all: bool) -> None:
        self.fail_on, self.lists_all = fail_on, lists_all
        self.by_verdict: Counter[Verdict] = Counter()
        self.listed: list[Sample] = []
        self.issues: dict[Issue, None] = {}
        self._tallies: dict[tuple[str, str], PairTally] = {}

    @property
    def room(self) -> int:
        """How many more samples with a finding are listed."""
        return LISTED_NOTED - len(self.listed)

    def tally(self, a: str, b: str) -> PairTally:
        return self._tallies.setdefault((a, b), PairTally(a, b))

    def add(self, sample: Sample) -> None:
        self.count(sample.number, sample.verdict, sample.findings)
        if self.lists_all or (sample.findings and self.room > 0):
            self.listed.append(sample)

    def count(self, number: int, verdict: Verdict, findings: Sequence[Finding]) -> None:
        self.by_verdict[verdict] += 1
        for finding in findings:
            self.tally(finding.a, finding.b).count(finding, number, self.fail_on)

    def keep_first_poses(self, scene: Scene, batch: PoseBatch) -> None:
        """States the poses of this batch in which a pair overlaps first."""
        for tally in self._tallies.values():
            if tally.first_overlap is not None and tally.first_pose is None:
                posture = batch.posture(scene, tally.first_overlap - batch.first)
                tally.first_pose = posture.pose()

    def samples(self, checks: _SingleChecks, number: int) -> Samples:
        report = checks.first
        assert report is not None
        assert checks.cache.book is not None
        ids = [body.id for body in report.bodies]
        return Samples(
            tool=report.tool,
            units=report.units,
            settings=report.settings,
            bodies=report.bodies,
            exempt=report.exempt,
            rules=report.rules,
            number=number,
            by_verdict={verdict: self.by_verdict[verdict] for verdict in VERDICTS},
            samples=tuple(self.listed),
            pairs=tuple(self.tally(ids[i], ids[j]) for i, j in checks.cache.book.checked_pairs()),
            counts=report.summary.pairs,
            issues=tuple(self.issues),
        )


class _SingleChecks:
    """Checks of single poses. first: the report of the first one."""

    def __init__(
        self, scene: Scene, settings: Settings, cache: BodyCache, results: _Results
    ) -> None:
        self.scene, self.settings, self.cache, self.results = scene, settings, cache, results
        self.first: Report | None = None

    def sample(self, batch: PoseBatch, row: int) -> Sample:
        scene = posed(self.scene, batch.pose(row))
        report = check(scene, self.settings, cache=self.cache)
        self.first = self.first or report
        posture = scene.posture
        assert posture is not None
        own = {(issue.code, issue.message) for issue in posture.issues}
        of_pose = [issue for issue in report.issues if (issue.code, issue.message) in own]
        others = [issue for issue in report.issues if (issue.code, issue.message) not in own]
        self.results.issues |= dict.fromkeys(others)
        findings = tuple(finding for finding in report.findings if not _is_plain(finding))
        verdict = report.summary.verdict
        return Sample(batch.first + row, posture, verdict, findings, tuple(of_pose))


def _sortable(checks: _SingleChecks, batch: PoseBatch) -> PosedPairs | None:
    """The pairs for the core to sort; None: each pose is checked alone. Checks the first pose, for
    what is the same in all poses."""
    checks.sample(batch, 0)
    scene, settings = posed(checks.scene, batch.pose(0)), checks.settings
    bodies = place(scene, settings, checks.cache)
    if not same_way(scene, settings, bodies):
        return None
    pairs = PosedPairs(scene, bodies, Planner(settings, bodies.book, scene.composed))
    sizes = {k: size_of(body, None) for k, body in bodies.placed.items()}
    return pairs if pairs.pairs and all(_is_small(p, sizes) for p in pairs.pairs) else None


def _is_small(pair: PosedPair, sizes: dict[int, float]) -> bool:
    """Whether the tolerance is below the sizes of both bodies; else a warning says so."""
    return (pair.request.tolerance or 0.0) < min(sizes[pair.i], sizes[pair.j])


def _is_plain(finding: Finding) -> bool:
    """Separated at rest and in motion, without a remark."""
    return finding.relation == "separated" and finding.severity == "none"


class _Row(Struct):
    """One pose with pairs that are not plainly apart, by their numbers. climbs: those that climb
    the ladder; deep, undecided: those that overlap deeply, and those that the fill of a hole
    decides, whose findings nobody reads; by_pair: the findings of those that have climbed. alone:
    the pose needs a check of its own."""

    row: int
    climbs: list[int]
    deep: list[int]
    undecided: list[int]
    by_pair: dict[int, Finding] = {}
    alone: bool = False

    @property
    def is_noted(self) -> bool:
        return bool(self.deep or self.undecided or self.alone) or not all(
            map(_is_plain, self.by_pair.values())
        )

    def findings(self) -> tuple[Finding, ...]:
        return tuple(f for _, f in sorted(self.by_pair.items()) if not _is_plain(f))


class _SortedBatch:
    """Poses whose pairs the core has sorted."""

    def __init__(
        self,
        checks: _SingleChecks,
        batch: PoseBatch,
        pairs: PosedPairs,
        meter: VolumeMeter | None,
    ) -> None:
        self._checks, self._results, self._batch = checks, checks.results, batch
        self._pairs, self._meter = pairs, meter
        self._matrices = batch.matrices(checks.scene)
        self._sorted = pairs.sift(self._matrices)

    def count(self) -> None:
        results = self._results
        met = np.flatnonzero((self._sorted != APART).any(axis=1)).tolist()
        rows = {row: self._row(row) for row in met}
        self._explain_first(rows)
        self._climb(rows.values())
        noted = [row for row in rows.values() if row.is_noted]
        listed = noted if results.lists_all else noted[: results.room]
        for row in listed:
            row.climbs, row.deep, row.undecided = row.deep + row.undecided, [], []
        self._climb(listed)
        is_listed = {row.row for row in listed}
        if results.lists_all:
            is_listed.update(range(self._batch.count))
        else:
            results.by_verdict["pass"] += self._batch.count - len(noted)
        for number in sorted(is_listed.union(row.row for row in noted)):
            row = rows.get(number) or _Row(number, [], [], [])
            if row.alone:
                results.add(self._checks.sample(self._batch, number))
            elif number in is_listed:
                results.add(self._sample(row))
            else:
                self._count_unlisted(row)

    def _row(self, row: int) -> _Row:
        codes = self._sorted[row]
        climbs, deep, undecided = (
            np.flatnonzero(codes == code).tolist() for code in (OPEN, DEEP, UNDECIDED)
        )
        return _Row(row, climbs, deep, undecided)

    @staticmethod
    def _explain_first(rows: Mapping[int, _Row]) -> None:
        """Lets each undecided pair climb once, in the first of these poses, for its reason."""
        explained: set[int] = set()
        for row in rows.values():
            first = set(row.undecided) - explained
            explained |= first
            row.climbs += sorted(first)
            row.undecided = [k for k in row.undecided if k not in first]

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

    def _sample(self, row: _Row) -> Sample:
        posture = self._batch.posture(self._checks.scene, row.row)
        findings = row.findings()
        verdict = self._verdict(row)
        number = self._batch.first + row.row
        issues = tuple(Issue(i.code, i.severity, i.body, i.file, i.message) for i in posture.issues)
        return Sample(number, posture, verdict, findings, issues)

    def _count_unlisted(self, row: _Row) -> None:
        number, findings = self._batch.first + row.row, row.findings()
        self._results.count(number, self._verdict(row), findings)
        for k in row.deep:
            a, b = self._pairs.names[k]
            fails = self._pairs.deep_fails(k)
            self._results.tally(a, b).count_overlap(number, fails=fails)
        for k in row.undecided:
            self._results.tally(*self._pairs.names[k]).count_undecided()

    def _verdict(self, row: _Row) -> Verdict:
        """As a report of this pose has it."""
        if any(map(self._pairs.deep_fails, row.deep)):
            return "fail"
        findings = row.findings()
        if any(fails(finding, self._results.fail_on) for finding in findings):
            return "fail"
        undecided = row.undecided or any(f.undecided is not None for f in findings)
        return "incomplete" if undecided else "pass"
