"""Asks satcheck one question through its Python interface, in an environment that is compared.

    python ask.py convex KIND QUERY
    python ask.py depth|thickness A B

Prints the least CPU and wall seconds of some runs, and the answers, as JSON. Everything that the
benches know of the Python interface stands here; where two commits differ in it, write both here.
"""

from __future__ import annotations

import json
import math
import random
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import satcheck
from satcheck import core

# The least of at least so many runs, which take this many seconds together.
FEWEST, SPENT = 3, 0.3
SHAPES, PAIRS = 40, 4000
# How far the centres of two shapes are from each other: some overlap, nearly all do,
# none does.
CENTRES = {"overlap": (0.8, 2.4), "depth": (0.05, 0.5), "distance": (3.5, 4.5)}
FLUSH = "flush"
VERTICES = {"hulls-12": 12, "hulls-60": 60}
ROUNDING = 1e-9

Record = dict[str, Any]


def made_shapes(kind: str, source: random.Random) -> list[Any]:
    """Boxes, or hulls of points on ellipsoids. Flush: cubes of size 2, boxes and hulls in turn."""
    shapes: list[Any] = []
    for k in range(SHAPES):
        half = [1.0] * 3 if kind == FLUSH else [source.uniform(0.5, 1.0) for _ in range(3)]
        if kind in VERTICES:
            points = [unit(source) for _ in range(VERTICES[kind])]
        else:
            points = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        if kind == "boxes" or (kind == FLUSH and k % 2):
            shapes.append(core.Box(tuple(half)))
        else:
            shapes.append(core.Hull(np.array(points) * half))
    return shapes


def unit(source: random.Random, dimensions: int = 3) -> tuple[float, ...]:
    values = [source.gauss(0, 1) for _ in range(dimensions)]
    length = math.hypot(*values)
    return tuple(value / length for value in values)


def convex(kind: str, query: str) -> Record:
    source = random.Random(7)
    shapes = made_shapes(kind, source)
    places = np.zeros((2, PAIRS, 7))
    places[:, :, 6] = 1
    for a, b in places.transpose(1, 0, 2):
        if kind == FLUSH:
            b[:3] = (2.0, source.randrange(-1, 2), source.randrange(-1, 2))
        else:
            a[3:], b[3:] = unit(source, 4), unit(source, 4)
            b[:3] = np.array(unit(source)) * source.uniform(*CENTRES[query])
    turns = np.arange(PAIRS, dtype=np.uint32)
    firsts, seconds = turns % SHAPES, (turns * 7 + 1) % SHAPES
    wanted: Any = query

    def ask() -> Any:
        return core.check_pairs(shapes, firsts, seconds, *places, query=wanted, threads=1)

    times, found = timed(ask)
    outcome = np.array(core.OUTCOMES)[np.asarray(found.outcome)]
    record = times | {"facts": outcome.tolist(), "bounds": []}
    if query != "overlap":
        total = math.fsum(np.asarray(found.distance).tolist())
        slack = ROUNDING * PAIRS
        record["bounds"] = [[total - slack, total + slack]]
    return record


def concave(query: str, a: str, b: str) -> Record:
    scene = satcheck.load_scene([a, b])
    asked: dict[str, Any] = {name: name == query for name in ("depth", "thickness")}
    settings = satcheck.Settings(**asked, jobs=1)
    times, report = timed(lambda: satcheck.check(scene, settings))
    (finding,) = report.findings
    bounds = finding.depth_bounds if query == "depth" else finding.thickness_bounds
    if bounds is None:
        raise SystemExit(f"there is no {query}: {finding.relation}")
    return times | {"facts": [finding.relation], "bounds": [list(bounds)]}


def timed(ask: Callable[[], Any]) -> tuple[Record, Any]:
    cpus, walls = list[float](), list[float]()
    while len(cpus) < FEWEST or sum(cpus) < SPENT:
        start, began = time.process_time(), time.perf_counter()
        answer = ask()
        cpus.append(time.process_time() - start)
        walls.append(time.perf_counter() - began)
    return {"cpu": min(cpus), "wall": min(walls)}, answer


def main() -> None:
    what, *words = sys.argv[1:]
    record = convex(*words) if what == "convex" else concave(what, *words)
    json.dump(record, sys.stdout)


if __name__ == "__main__":
    main()
