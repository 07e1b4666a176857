"""One pair: a plain check stage by stage, then every rung of the ladder. Runs in a child process.

    echo CASE_AND_EFFORT | python -m bench.accuracy.measuring

Both as JSON, in and out: {"case": Case.to_dict(), "effort": Effort as a dict} gives a record, or
{"failure": why}.
"""

from __future__ import annotations

import json
import math
import sys
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

from msgspec import to_builtins
from msgspec.structs import replace

from bench.accuracy.case import Case, Effort, case_of
from satcheck.audit import Settings, check
from satcheck.audit.tradeoff import RUNGS, tradeoff
from satcheck.core.errors import SatcheckError
from satcheck.report.json import render
from satcheck.report.tradeoff import Row
from satcheck.scene import Body, load_scene

SECONDS_PER_MICROSECOND = 1e-6
PARTS = [rung for rung in RUNGS if rung.threshold is not None]
UNITS = "m"  # of files that state none: samples pair them with GLB files
# What the trace of a pair lacks: files into bodies, bodies into the world, findings into JSON.
READING, PLACING, WRITING = "reading", "placing", "writing"


def measured(case: Case, effort: Effort) -> dict[str, Any]:
    """Raises SatcheckError where the two files give no two bodies."""
    with tempfile.TemporaryDirectory() as scratch:
        inputs = case.inputs(Path(scratch))
        scene = load_scene(inputs, units=UNITS)
        if len(scene.bodies) != 2:
            raise SatcheckError("no-pair", f"{len(scene.bodies)} readable bodies, not two")
        a, b = scene.bodies
        plain = [stages(inputs) for _ in range(effort.repeat + 1)][1:]  # the first one imports
        triangles = [body.world_mesh().triangle_count for body in (a, b)]
        left_out = PARTS if sum(triangles) > effort.part_triangles else []
        asked = [rung for rung in RUNGS if rung not in left_out]
        pair = tradeoff(
            (a, b),
            repeat=effort.repeat,
            budget=effort.pair_seconds,
            rung_seconds=effort.rung_seconds,
            rungs=asked,
        )
    reason = f"budget: more than {effort.part_triangles:,} triangles"
    rows = {(row.rung, row.threshold): row for row in pair.rungs}
    rows |= {
        rung: Row(rung=rung.name, threshold=rung.threshold, state="not run", reason=reason)
        for rung in left_out
    }
    return {
        "triangles": triangles,
        "size": min(_diagonal(body) for body in (a, b)),
        "stages": plain,
        "pair": to_builtins(replace(pair, rungs=tuple(rows[rung] for rung in RUNGS))),
    }


def stages(inputs: list[Path]) -> dict[str, float]:
    """Seconds of each stage of `satcheck A B`, from the files to the report."""
    start = perf_counter()
    scene = load_scene(inputs, units=UNITS)
    loaded = perf_counter()
    report = check(scene, Settings(depth=True))
    checked = perf_counter()
    render(report, timings=True)
    written = perf_counter()
    spent: dict[str, float] = {READING: loaded - start}
    for finding in report.findings:
        for stage in finding.plan:
            seconds = SECONDS_PER_MICROSECOND * stage.microseconds
            spent[stage.stage] = spent.get(stage.stage, 0.0) + seconds
    of_pairs = sum(spent.values()) - spent[READING]
    return spent | {PLACING: checked - loaded - of_pairs, WRITING: written - checked}


def _diagonal(body: Body) -> float:
    low, high = body.world_mesh().bounds
    return math.dist(low, high)


def main() -> None:
    asked = json.load(sys.stdin)
    try:
        record = measured(case_of(asked["case"]), Effort(**asked["effort"]))
    except SatcheckError as error:
        record = {"failure": str(error)}
    json.dump(record, sys.stdout)


if __name__ == "__main__":
    main()
