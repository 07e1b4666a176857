"""The width of depth intervals against the time they take, on a file of real pairs.

    python bench/depth_interval.py PAIRS.json [--budgets 0.02 0.1 0.5 2] [--width 0.01] [--closed]
                                    [--pairs] [--thickness]

PAIRS.json: {"pairs": [{"id", "a": {"mesh", "transform"}, "b": {...}}, ...]}, meshes relative to the
file, transforms row-major 4x4; a lower bound above truth.best_known_length, where given, is wrong.
Every pair that overlaps and is not wholly convex is searched from the way out of its hulls. Printed
per budget, in seconds of `budget`: how wide the intervals are, how much CPU time they took,
and how many contradict the best known way out. --closed: only pairs of solids. --pairs: a line for
each pair as well, with the last budget. --thickness: then, with the default budgets, the time of a
depth, of a thickness, and of both, the least of three runs. bench/overlapping_pairs.py makes files
of such pairs.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from satcheck import core
from satcheck.audit import Settings
from satcheck.audit.body import PlacedBody, SharedMesh
from satcheck.audit.draft import Draft
from satcheck.audit.pair import Pair
from satcheck.audit.planner import request_for
from satcheck.audit.settings import WORK_PER_SECOND
from satcheck.audit.stages.depth import way_out_of_hulls
from satcheck.audit.stages.relation import settle
from satcheck.report.report import OVERLAPS
from satcheck.scene import load_scene

# A best known way out was verified by others, with coordinates rounded once more.
ROUNDING = 1e-9
# Of each search whose time is compared.
RUNS = 3


@dataclass(frozen=True)
class Measured:
    name: str
    interval: core.DepthInterval
    seconds: float
    best_known: float | None

    @property
    def width(self) -> float:
        upper = self.interval.upper
        return (upper - self.interval.lower) / upper if upper > 0 else 0.0

    @property
    def contradicts(self) -> bool:
        return self.best_known is not None and self.interval.lower > self.best_known * (
            1 + ROUNDING
        )


def pair_of(entry: dict[str, Any], folder: Path, settings: Settings) -> Pair | None:
    """The pair, if it overlaps and has a concave side; None for the others."""
    bodies = [
        {
            "id": side,
            "mesh": str(folder / entry[side]["mesh"]),
            "transform": entry[side]["transform"],
        }
        for side in "ab"
    ]
    content = {"schema": "satcheck-scene-1", "name": entry["id"], "units": "m", "bodies": bodies}
    with tempfile.TemporaryDirectory() as scratch:
        path = Path(scratch) / "pair.scene.json"
        path.write_text(json.dumps(content), encoding="utf-8")
        scene = load_scene([path])
    if len(scene.bodies) < 2:
        return None
    a, b = (PlacedBody(body, SharedMesh(body.file, settings)) for body in scene.bodies)
    pair = Pair(a, b, settings, request_for(settings))
    draft = Draft(pair)
    settle(draft)
    if pair.both_convex or draft.exact not in OVERLAPS:
        return None
    return pair


def measure(
    name: str, pair: Pair, best_known: float | None, budget: float, width: float
) -> Measured:
    a, b = pair.a.surface(), pair.b.surface()
    upper = way_out_of_hulls(pair).upper
    start = time.process_time()
    found = core.search_depth(
        a, b, upper=upper, lower=0.0, width=width, work=int(budget * WORK_PER_SECOND)
    )
    return Measured(name, found, time.process_time() - start, best_known)


def least_seconds(search: Callable[[], object]) -> float:
    seconds = math.inf
    for _ in range(RUNS):
        start = time.process_time()
        search()
        seconds = min(seconds, time.process_time() - start)
    return seconds


def compare_thickness(pairs: list[Pair], width: float) -> None:
    """Of solids, on one core."""
    settings = Settings()
    depths, thicknesses = [], []
    for pair in pairs:
        a, b, upper = pair.a.surface(), pair.b.surface(), way_out_of_hulls(pair).upper
        depth = partial(core.search_depth, a, b, upper=upper, lower=0.0, width=width)
        depths.append(least_seconds(partial(depth, work=settings.work)))
        thickness = partial(core.search_thickness, a, b, width=width)
        thicknesses.append(least_seconds(partial(thickness, work=pair.thickness_work)))
    say("| of pairs of solids | median ms | 95 % ms | longest ms |")
    say("|---|---|---|---|")
    both = [one + other for one, other in zip(depths, thicknesses, strict=True)]
    for name, seconds in (("depth", depths), ("thickness", thicknesses), ("both", both)):
        times = sorted(1e3 * one for one in seconds)
        high = times[int(0.95 * (len(times) - 1))]
        say(f"| {name} | {statistics.median(times):.1f} | {high:.0f} | {times[-1]:.0f} |")


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("pairs_file", type=Path)
    parser.add_argument(
        "--budgets", type=float, nargs="+", default=[0.005, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 10]
    )
    parser.add_argument("--width", type=float, default=0.01)
    parser.add_argument("--closed", action="store_true")
    parser.add_argument("--pairs", action="store_true")
    parser.add_argument("--thickness", action="store_true")
    given = parser.parse_args()
    settings = Settings()
    entries = json.loads(given.pairs_file.read_text(encoding="utf-8"))["pairs"]
    pairs = [
        (entry["id"], pair, entry.get("truth", {}).get("best_known_length"))
        for entry in entries
        if (pair := pair_of(entry, given.pairs_file.parent, settings)) is not None
        if (pair.a.solid and pair.b.solid) or not given.closed
    ]
    say(
        "| budget, s | median width | up to 1 % | up to 2 % "
        "| median ms | 95 % ms | longest ms | wrong |"
    )
    say("|---|---|---|---|---|---|---|---|")
    measured: list[Measured] = []
    for budget in given.budgets:
        measured = [measure(*known, budget, given.width) for known in pairs]
        widths = [one.width for one in measured]
        times = sorted(1e3 * one.seconds for one in measured)
        say(
            f"| {budget:g} | {100 * statistics.median(widths):.2g} % "
            f"| {sum(w <= 0.0101 for w in widths)} of {len(widths)} "
            f"| {sum(w <= 0.0201 for w in widths)} | {statistics.median(times):.0f} "
            f"| {times[int(0.95 * (len(times) - 1))]:.0f} | {times[-1]:.0f} "
            f"| {sum(one.contradicts for one in measured)} |"
        )
    if given.pairs:
        for one in measured:
            found = one.interval
            say(
                f"{one.name:32} {found.lower:12.6g} {found.upper:12.6g} {100 * one.width:7.2f} % "
                f"{1e3 * one.seconds:8.1f} ms {found.boxes:7} boxes {found.sets:5} sets "
                f"{found.mesh_tests:6} tests {found.stop}"
            )
    if given.thickness:
        compare_thickness(
            [pair for _, pair, _ in pairs if pair.a.solid and pair.b.solid], given.width
        )


if __name__ == "__main__":
    main()
