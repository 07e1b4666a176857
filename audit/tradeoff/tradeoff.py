"""Which pairs of a scene are measured, one after another, within one budget."""

from __future__ import annotations

from satcheck import core
from satcheck.audit.bodies.placed_bodies import place
from satcheck.audit.checked_pairs import Progress
from satcheck.audit.ladder.close_pairs import close_pairs
from satcheck.audit.request.planner import Planner
from satcheck.audit.request.settings import Method, Settings
from satcheck.audit.studied_pair import Bodies
from satcheck.audit.summary import tool
from satcheck.audit.tradeoff.gauge import Budget
from satcheck.audit.tradeoff.measure import measure_pair
from satcheck.audit.tradeoff.result import PairTradeoff, Tradeoff
from satcheck.audit.tradeoff.rungs import RUNGS
from satcheck.core.errors import SatcheckError
from satcheck.scene import Scene


def tradeoff(
    scene: Scene,
    *,
    repeat: int = 5,
    budget: float = 60.0,
    pairs: int = 10,
    method: Method = "auto",
    progress: Progress | None = None,
) -> Tradeoff:
    """Every rung on the two bodies of the scene, or on the first pairs whose boxes meet.

    repeat: runs of each rung. budget: seconds for everything after the files are read; each pair
    has its share of what those before it have left. pairs: at most so many. Bodies stand as the
    scene places them; of its rules only exemptions are followed.
    method: of the convex hulls, see Settings.
    progress(done, total) counts runs.
    Raises SatcheckError (`no-pair`, `units-unknown`, `planar-only`) where no boxes meet, and for a
    scene with outlines.
    """
    scene.require_in_space("tradeoff compares meshes in space only")
    scene.require_one_unit()
    clock = Budget(budget)
    met = _pairs(scene)
    if not met:
        raise SatcheckError("no-pair", "no two bodies have boxes that meet: nothing to compare")
    done, total = 0, min(len(met), pairs) * repeat * len(RUNGS)

    def on_run() -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, total)

    measurements: list[PairTradeoff] = []
    for bodies in met[:pairs]:
        waiting = min(len(met), pairs) - len(measurements)
        share = clock.share(waiting)
        measurements.append(measure_pair(bodies, repeat, share, on_run, method=method))
    return Tradeoff(
        tool(),
        scene.units,
        repeat,
        budget,
        clock.spent,
        tuple(measurements),
        len(met) - len(measurements),
    )


def _pairs(scene: Scene) -> list[Bodies]:
    """Return of two bodies the pair, wherever they are; of more the asked ones whose boxes meet.

    Raises SatcheckError for a body that cannot be placed.
    """
    settings = Settings()
    placed_bodies = place(scene, settings)
    for issue in placed_bodies.issues:
        if issue.severity == "error":
            raise SatcheckError(issue.code, issue.message, body=issue.body)
    if len(scene.bodies) == 2:
        a, b = scene.bodies
        return [(a, b)]
    near = close_pairs(placed_bodies, Planner(settings, placed_bodies.book, scene.composed))
    met = [(placed_bodies.placed[i], placed_bodies.placed[j]) for i, j in near]
    return [(a.body, b.body) for a, b in met if core.box_gap(a.bounds, b.bounds) == 0]
