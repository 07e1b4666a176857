"""The check of robots in many poses.

The core first sorts the pairs of all poses (`posed_pairs.py`). A pair that is plainly apart needs
nothing else. A deep overlap counts without figures, and a pair that the fill of a hole decides
counts as undecided, unless the report lists its pose. All other pairs climb the ladder as in a
check of one pose.

Findings are made only for pairs that the core leaves open, for poses that the report lists, and for
the first pose of a batch in which a pair is undecided. A pair climbs the ladder only if the sort
does not say all that its finding has.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck.audit.bodies import place
from satcheck.audit.check import DEFAULT_SETTINGS, volume_meter
from satcheck.audit.checked_pairs import examine_pairs
from satcheck.audit.finding import deep_overlap
from satcheck.audit.pair import Pair
from satcheck.audit.planner import Planner
from satcheck.audit.posed_pairs import APART, DEEP, OPEN, UNDECIDED, PosedPairs, same_way
from satcheck.audit.sample_results import LISTED_SAMPLES, SampleResults, is_plain
from satcheck.audit.settings import Settings, require_settings
from satcheck.audit.summary import size_of
from satcheck.report.report import Finding, Issue, Verdict
from satcheck.report.samples import SamplesReport
from satcheck.report.verdict import fails
from satcheck.scene import Scene
from satcheck.scene.robot import Pose
from satcheck.scene.robot.postures import PoseBatch, pose_batches

if TYPE_CHECKING:
    from satcheck.audit.posed_pairs import Codes
    from satcheck.core.peers import VolumeMeter

Progress = Callable[[int, int], None]

# Poses that the core sorts together. Their placements are in memory at a time.
BATCH = 2048
# Pairs that climb the ladder together.
TOGETHER = 512


def check_poses(
    scene: Scene,
    poses: Sequence[Pose],
    settings: Settings = DEFAULT_SETTINGS,
    progress: Callable[[int, int], None] | None = None,
) -> SamplesReport:
    """Check the scene in each of these poses of its robots. At least one pose is needed.

    scene: loaded, with `robots`. poses: joint -> values, for instance `scene.robot`'s
    `RandomPoses([robot.robot for robot in scene.robots], count, seed)`, which need no memory, or
    read by `read_poses`. progress(done, total) counts poses. Facts that depend on a mesh alone
    (convexity, parts) are computed once for all poses.

    Settings(depth=False) is much faster and decides only whether bodies meet. A pair that is always
    in contact has as many `contacts` as there are poses; a pair that is always separated is
    `settled`.

    Raises SatcheckError for a pose with unknown joints, and what `check` raises.
    """
    if not poses:
        raise ValueError("no pose to check")
    require_settings(settings)
    settings = replace(settings, list_pruned=False, depth=settings.depth or False)
    results = SampleResults(scene, settings, lists_all=len(poses) <= LISTED_SAMPLES)
    batches = pose_batches(scene, poses, BATCH)
    first = next(batches)  # all poses are judged before work is done
    pairs, batches = _sortable(results, first), chain((first,), batches)
    with ExitStack() as stack:
        if pairs is not None:
            by_volume = any(pair.request.wants("volume") for pair in pairs.pairs)
            meter = stack.enter_context(volume_meter(settings)) if by_volume else None
        for batch in batches:
            if pairs is not None:
                _SortedBatch(results, batch, pairs, meter).count()
            else:
                for row in range(batch.count):
                    results.add(batch, row)
            results.keep_first_poses(batch)
            for number in range(batch.first, batch.first + batch.count):
                if progress is not None:
                    progress(number, len(poses))
    return results.report(len(poses))


def _sortable(results: SampleResults, batch: PoseBatch) -> PosedPairs | None:
    """The pairs for the core to sort, if all poses have the same question; None: each pose is
    checked alone."""
    scene, settings = batch.posed(0), results.settings
    bodies = place(scene, settings, results.cache)
    if not same_way(scene, settings, bodies):
        return None
    planner = Planner(settings, bodies.book, scene.composed)
    pairs = [
        Pair(bodies.placed[i], bodies.placed[j], settings, planner.request(i, j))
        for i, j in sorted(bodies.book.checked_pairs())
    ]
    sizes = {body.id: size_of(body) for body in bodies.placed.values()}
    # A tolerance of the size of a body gets a warning, from the check of its pose.
    small = all((p.request.tolerance or 0.0) < min(sizes[p.a.id], sizes[p.b.id]) for p in pairs)
    if not (pairs and small):
        return None
    results.describe(batch, scene)
    return PosedPairs(list(bodies.placed.values()), pairs)


class _SortedBatch:
    """Poses whose pairs the core has sorted. found: the findings of each pose so far, by the
    numbers of the pairs; deep: those that the sort proves and counts. alone: poses that need a
    check of their own."""

    def __init__(
        self,
        results: SampleResults,
        batch: PoseBatch,
        pairs: PosedPairs,
        meter: VolumeMeter | None,
    ) -> None:
        self._results, self._batch = results, batch
        self._pairs, self._meter = pairs, meter
        self._matrices = batch.matrices
        self._sorted, _ = pairs.sift(self._matrices)
        self._noted = (self._sorted == DEEP) | (self._sorted == UNDECIDED)
        self._found: dict[int, dict[int, Finding]] = {}
        self._deep: dict[int, dict[int, Finding]] = {}
        self._alone: set[int] = set()

    def count(self) -> None:
        """Add what the poses say to the results."""
        self._find((self._sorted == OPEN) | _first_undecided(self._sorted))
        listed = self._listed()
        proven = self._find_deep((self._sorted == DEEP) & listed[:, None])
        self._find(self._noted & listed[:, None] & ~proven)
        verdicts = self._verdicts()
        listed[list(self._alone)] = True
        for row in np.flatnonzero(listed).tolist():
            if row in self._alone:
                self._results.add(self._batch, row)
            else:
                found, issues = self._findings(row), self._batch.issues(row)
                told = [Issue(i.code, i.severity, i.body, i.file, i.message) for i in issues]
                self._results.listed.append(
                    self._results.sample(self._batch, row, verdicts[row], found, told)
                )

    def _listed(self) -> NDArray[np.bool_]:
        """Whether each pose is listed."""
        if self._results.lists_all:
            return np.ones(self._batch.count, bool)
        noted = self._noted.any(axis=1)
        noted[[*self._alone, *(row for row in self._found if self._findings(row))]] = True
        listed = np.zeros(self._batch.count, bool)
        listed[np.flatnonzero(noted)[: self._results.room]] = True
        return listed

    def _find_deep(self, asked: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Makes the findings of deep overlaps of which the sort proves all, and returns where."""
        tolerances = self._pairs.deep_tolerances(self._matrices, asked)
        proven: NDArray[np.bool_] = ~np.isnan(tolerances)
        for number in np.flatnonzero(proven.any(axis=0)).tolist():
            finding = self._results.told(deep_overlap(self._pairs.pairs[number]))
            for row in np.flatnonzero(proven[:, number]).tolist():
                tolerance = float(tolerances[row, number])
                self._deep.setdefault(row, {})[number] = replace(finding, tolerance=tolerance)
        return proven

    def _find(self, asked: NDArray[np.bool_]) -> None:
        """Makes the other findings of these pairs."""
        climbing: list[tuple[int, int, Pair]] = []
        for row in np.flatnonzero(asked.any(axis=1)).tolist():
            found = self._found.setdefault(row, {})
            numbers = [k for k in np.flatnonzero(asked[row]).tolist() if k not in found]
            try:
                pairs = self._pairs.at(self._matrices, row, numbers, self._meter)
            except (ValueError, OverflowError):  # the check of this pose says what is wrong
                self._alone.add(row)
                continue
            climbing += [(row, k, pair) for k, pair in zip(numbers, pairs, strict=True)]
            if len(climbing) >= TOGETHER:
                self._climb(climbing)
                climbing = []
        self._climb(climbing)

    def _climb(self, climbing: Sequence[tuple[int, int, Pair]]) -> None:
        pairs = [pair for *_, pair in climbing]
        checked = examine_pairs(pairs, self._results.settings.jobs)
        for (row, number, _), pair in zip(climbing, checked, strict=True):
            self._found[row][number] = self._results.told(pair.finding)
            self._results.issues |= dict.fromkeys(pair.issues)

    def _findings(self, row: int) -> tuple[Finding, ...]:
        found = self._found.get(row, {}) | self._deep.get(row, {})
        return tuple(found[k] for k in sorted(found) if not is_plain(found[k]))

    def _verdicts(self) -> dict[int, Verdict]:
        """Return the verdict on each pose that needs no check of its own, all of them counted: by
        their findings, and by the sort for deep overlaps and for pairs without one."""
        codes, results = self._sorted.copy(), self._results
        codes[list(self._alone)] = APART
        for row, found in self._found.items():
            codes[row, list(found)] = APART
        failed = ((codes == DEEP) & self._pairs.deep_fails).any(axis=1).tolist()
        undecided = (codes == UNDECIDED).any(axis=1).tolist()
        for row in sorted(self._found.keys() - self._alone):
            for finding in self._found[row].values():
                results.count(finding, self._batch.first + row)
                failed[row] |= fails(finding, results.settings.fail_on)
                undecided[row] |= finding.undecided is not None
        for k in np.flatnonzero(((codes == DEEP) | (codes == UNDECIDED)).any(axis=0)).tolist():
            of, deep = self._pairs.pairs[k], np.flatnonzero(codes[:, k] == DEEP)
            pair = results.tally(of.a.id, of.b.id)
            if deep.size:
                first, fails_by = self._batch.first + int(deep[0]), bool(self._pairs.deep_fails[k])
                pair.count_overlaps(len(deep), first, fails=fails_by)
            pair.undecided += int((codes[:, k] == UNDECIDED).sum())
        verdicts: dict[int, Verdict] = {
            row: "fail" if failed[row] else "incomplete" if undecided[row] else "pass"
            for row in range(self._batch.count)
            if row not in self._alone
        }
        results.by_verdict.update(verdicts.values())
        return verdicts


def _first_undecided(codes: Codes) -> NDArray[np.bool_]:
    """Whether a pair is undecided in a pose for the first time. Its finding gives the reason."""
    undecided: NDArray[np.bool_] = codes == UNDECIDED
    pairs = np.flatnonzero(undecided.any(axis=0))
    first = np.zeros_like(undecided)
    first[undecided[:, pairs].argmax(axis=0), pairs] = True
    return first
