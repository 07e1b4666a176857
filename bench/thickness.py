"""The thickness of overlaps on pairs of known thickness: right, narrow enough, and how fast.

    python -m bench.thickness DATA [--budget 10] [--width 0.01] [--pairs] [--only NAME]
    python -m bench.thickness --flush [--budget 1]

DATA: a folder with pairs.json, its meshes, and thickness/thickness.json, whose `pairs` and `fits`
have bounds of the true thickness and `weighted` decisions: is a point deeper than eA in A and eB in
B? Printed: contradictions, how many intervals are narrow enough, how many of those within a
second, and the median time beside that of the depth. --budget: seconds of work a pair.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bench.depth_interval import say
from satcheck import core
from satcheck.audit import Settings
from satcheck.audit.body import PlacedBody, SharedMesh
from satcheck.audit.pair import Pair
from satcheck.audit.planner import request_for
from satcheck.audit.settings import WORK_PER_SECOND
from satcheck.audit.stages.depth import way_out_of_hulls
from satcheck.scene import load_scene

# What thickness/README.md grants: relative to the bounds, and relative to the size of the pair.
RELATIVE, OF_SIZE = 1e-6, 1e-9


@dataclass(frozen=True)
class Measured:
    interval: core.ThicknessInterval
    seconds: float
    contradicts: bool
    decisions: int
    wrong_decisions: int
    open_decisions: int
    decision_seconds: float
    depth_seconds: float


def placed_pair(entry: dict[str, Any], folder: Path) -> Pair:
    settings = Settings()
    sides = [entry[side] for side in "ab"]
    placed = [side if isinstance(side, dict) else {"mesh": side} for side in sides]
    bodies = [
        {**body, "id": name, "mesh": str(folder / body["mesh"])}
        for name, body in zip("ab", placed, strict=True)
    ]
    content = {"schema": "satcheck-scene-1", "name": entry["id"], "units": "m", "bodies": bodies}
    with tempfile.TemporaryDirectory() as scratch:
        path = Path(scratch) / "pair.scene.json"
        path.write_text(json.dumps(content), encoding="utf-8")
        scene = load_scene([path])
    a, b = (PlacedBody(body, SharedMesh(body.file, settings)) for body in scene.bodies)
    return Pair(a, b, settings, request_for(settings))


def size_of(surface: core.Surface) -> float:
    low, high = surface.mesh.bounds
    return max(y - x for x, y in zip(low, high, strict=True))


def measure(entry: dict[str, Any], pair: Pair, work: int, width: float) -> Measured:
    a, b = pair.a.surface(), pair.b.surface()
    start = time.perf_counter()
    interval = core.search_thickness(a, b, width=width, work=work)
    seconds = time.perf_counter() - start
    slack = OF_SIZE * max(size_of(a), size_of(b))
    low, high = entry["lower"], entry["upper"]
    contradicts = interval.lower > high * (1 + RELATIVE) + slack
    contradicts |= interval.upper < low * (1 - RELATIVE) - slack
    if "truth" in entry:
        contradicts |= interval.lower > entry["truth"] * (1 + RELATIVE) + slack
        contradicts |= interval.upper < entry["truth"] * (1 - RELATIVE) - slack
    start = time.perf_counter()
    wrong = unsettled = 0
    decisions = [case for case in entry.get("weighted", []) if case["beyond"] is not None]
    for case in decisions:
        found = core.search_thickness(
            a, b, width=width, work=work, less_a=case["eA"], less_b=case["eB"], limit=0.0
        )
        unsettled += found.stop != "decided"
        wrong += found.lower > 0 and not case["beyond"]
        wrong += found.upper <= 0 and case["beyond"]
    decided = time.perf_counter()
    upper = way_out_of_hulls(pair).upper if entry["upper"] > 0 else 0.0
    depth_start = time.perf_counter()
    core.search_depth(a, b, upper=upper, lower=0.0, width=width, work=work)
    depth_seconds = time.perf_counter() - depth_start
    return Measured(
        interval,
        seconds,
        contradicts,
        len(decisions),
        wrong,
        unsettled,
        decided - start,
        depth_seconds,
    )


def line_of(name: str, one: Measured) -> str:
    found = one.interval
    relative = (found.upper - found.lower) / found.upper if found.upper > 0 else 0.0
    return (
        f"{name:32} {found.lower:12.6g} {found.upper:12.6g} {100 * relative:7.2f} % "
        f"{1e3 * one.seconds:8.1f} ms {found.boxes:7} boxes  {found.stop:10} "
        f"decisions {one.decisions - one.wrong_decisions - one.open_decisions}/{one.decisions} "
        f"{1e3 * one.decision_seconds:8.1f} ms  depth {1e3 * one.depth_seconds:8.1f} ms"
        + ("  WRONG" if one.contradicts or one.wrong_decisions else "")
    )


def report(measured: list[Measured], overlapping: list[Measured]) -> None:
    narrow = [one for one in measured if one.interval.stop == "narrow"]
    quick = sum(one.seconds <= 1 for one in narrow)
    say(f"{len(measured)} pairs: {sum(one.contradicts for one in measured)} contradict the truth")
    say(f"narrow enough: {len(narrow)}, within a second: {quick}")
    decisions = sum(one.decisions for one in measured)
    wrong = sum(one.wrong_decisions for one in measured)
    unsettled = sum(one.open_decisions for one in measured)
    say(f"{decisions} decisions: {wrong} wrong, {unsettled} open")
    thickness = statistics.median(one.seconds for one in overlapping)
    depth = statistics.median(one.depth_seconds for one in overlapping)
    say(f"median of overlapping pairs: {1e3 * thickness:.1f} ms, depth {1e3 * depth:.1f} ms")


def sphere_and_mould(level: int) -> tuple[Any, Any]:
    """A ball of 20 * 4**level triangles, and a block with its hollow."""
    import trimesh

    ball: Any = trimesh.creation.icosphere(subdivisions=level)
    hollow = ball.copy()
    hollow.invert()
    block: Any = trimesh.creation.box((4, 4, 4))
    return ball, trimesh.util.concatenate([block, hollow])


def measure_flush(work: int, width: float) -> None:
    import trimesh

    def surface(mesh: Any) -> core.Surface:
        return core.Surface(core.Mesh(np.array(mesh.vertices), np.array(mesh.faces)), True)

    transformations: Any = trimesh.transformations
    moves = {
        "as it is": np.eye(4),
        "moved by 1e-6": transformations.translation_matrix((1e-6, 0, 0)),
        "larger by 1e-6": np.diag((1 + 1e-6, 1 + 1e-6, 1 + 1e-6, 1)),
        "turned by 0.01": transformations.rotation_matrix(0.01, (1, 2, 3)),
    }
    for level in (4, 5, 6):
        ball, mould = sphere_and_mould(level)
        hollow = surface(mould)
        for name, matrix in moves.items():
            moved = surface(ball.copy().apply_transform(matrix))
            start = time.perf_counter()
            found = core.search_thickness(moved, hollow, width=width, work=work)
            seconds = time.perf_counter() - start
            say(
                f"{len(ball.faces):6} triangles, {name:15} {found.lower:12.6g} {found.upper:12.6g} "
                f"{1e3 * seconds:8.1f} ms {found.boxes:7} boxes  {found.stop}"
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("data", type=Path, nargs="?")
    parser.add_argument("--flush", action="store_true")
    parser.add_argument("--budget", type=float, default=10.0)
    parser.add_argument("--width", type=float, default=0.01)
    parser.add_argument("--pairs", action="store_true")
    parser.add_argument("--only", default="")
    given = parser.parse_args()
    if given.flush:
        measure_flush(int(given.budget * WORK_PER_SECOND), given.width)
        return
    if given.data is None:
        sys.exit("DATA or --flush is needed")
    truth_file = given.data / "thickness" / "thickness.json"
    if not truth_file.exists():
        sys.exit(f"there is no {truth_file}")
    truth = json.loads(truth_file.read_text(encoding="utf-8"))
    placements = json.loads((given.data / "pairs.json").read_text(encoding="utf-8"))["pairs"]
    placed = {entry["id"]: entry for entry in placements}
    work = int(given.budget * WORK_PER_SECOND)
    measured: list[Measured] = []
    overlapping: list[Measured] = []
    for entry in truth["pairs"] + truth["fits"]:
        if given.only not in entry["id"]:
            continue
        of_pairs = entry["id"] in placed
        folder = given.data if of_pairs else given.data / "thickness"
        pair = placed_pair(placed[entry["id"]] if of_pairs else entry, folder)
        one = measure(entry, pair, work, given.width)
        measured.append(one)
        if of_pairs and entry["lower"] > 0:
            overlapping.append(one)
        if given.pairs:
            say(line_of(entry["id"], one))
    report(measured, overlapping or measured)


if __name__ == "__main__":
    main()
