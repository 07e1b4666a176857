"""The check of robots in many poses.

The core first sorts the pairs of all poses (`posed_pairs.py`). A pair that is plainly apart needs
nothing else. A deep overlap counts without figures, and a pair that the fill of a hole decides
counts as undecided, unless the report lists its pose. All other pairs climb the ladder as in a
check of one pose.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from itertools import chain

from msgspec.structs import replace

from satcheck.audit.bodies import place
from satcheck.audit.check import DEFAULT_SETTINGS, volume_meter
from satcheck.audit.pair import Pair
from satcheck.audit.planner import Planner
from satcheck.audit.posed_pairs import PosedPairs, same_way
from satcheck.audit.sample_results import LISTED_SAMPLES, SampleResults
from satcheck.audit.settings import Settings
from satcheck.audit.sorted_poses import sorted_and_counted
from satcheck.audit.summary import size_of
from satcheck.report.samples import SamplesReport
from satcheck.scene import Scene
from satcheck.scene.robot import Pose
from satcheck.scene.robot.postures import PoseBatch, pose_batches

Progress = Callable[[int, int], None]

# Poses that the core sorts together. The placements of two batches are in memory at a time.
BATCH = 2048


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
    settings = replace(settings, list_pruned=False, depth=settings.depth or False)
    results = SampleResults(settings, lists_all=len(poses) <= LISTED_SAMPLES)
    batches = pose_batches(scene, poses, BATCH)
    first = next(batches)  # all poses are judged before work is done
    pairs, batches = _sortable(results, first), chain((first,), batches)
    with ExitStack() as stack:
        if pairs is not None:
            by_volume = any(pair.request.wants("volume") for pair in pairs.pairs)
            meter = stack.enter_context(volume_meter(settings)) if by_volume else None
            batches = sorted_and_counted(results, batches, pairs, meter)
        for batch in batches:
            for row in range(batch.count) if pairs is None else ():
                results.add(batch, row)
            results.keep_first_poses(batch)
            for number in range(batch.first, batch.first + batch.count):
                if progress is not None:
                    progress(number, len(poses))
    return results.report(len(poses))


def _sortable(results: SampleResults, batch: PoseBatch) -> PosedPairs | None:
    """The pairs for the core to sort; None: each pose is checked alone. Checks the first pose, for
    what is the same in all poses."""
    results.check(batch, 0)
    scene, settings = batch.posed(0), results.settings
    bodies = place(scene, settings, results.cache)
    if not same_way(scene, settings, bodies):
        return None
    planner = Planner(settings, bodies.book, scene.composed)
    pairs = [
        Pair(bodies.placed[i], bodies.placed[j], settings, planner.request(i, j))
        for i, j in sorted(bodies.book.checked_pairs())
    ]
    sizes = {body.id: size_of(body, None) for body in bodies.placed.values()}
    # A tolerance of the size of a body gets a warning, from the check of its pose.
    small = all((p.request.tolerance or 0.0) < min(sizes[p.a.id], sizes[p.b.id]) for p in pairs)
    return PosedPairs(list(bodies.placed.values()), pairs) if pairs and small else None
