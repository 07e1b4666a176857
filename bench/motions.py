"""Sweeps of moving meshes: satcheck beside FCL's continuous collision and beside sampled poses.

    pip install '.[peers]'
    python -m bench.motions [--pairs 10] [--rounds 3]

Each family of pairs has a known time of impact, computed from the vertices in rational arithmetic,
or is known to stay free. All ask the same pairs, one after the other in every round; the trees are
built before the clock runs. FCL: its conservative advancement, and its check of evenly spaced
poses ("naive"). coal has no continuous collision, so its users check poses: the first of 100 or
1,000 that overlaps is the impact. Prints sweeps a second (least CPU time of the rounds) for meshes
of about 1,000 and 20,000 triangles, and what each got wrong: hits that were missed, free motions
called hits, and times off by more than 1e-3 of the motion.
"""

from __future__ import annotations

import argparse
import math
import random
import sys
import tempfile
import time
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import coal
import fcl
import numpy as np
import trimesh
from msgspec import Struct
from numpy.typing import NDArray

from bench.impact_judges import OFF, Answer
from satcheck.audit import Settings
from satcheck.audit.body import PlacedBody, SharedMesh
from satcheck.audit.pair import Pair
from satcheck.audit.planner import request_for
from satcheck.core import transform
from satcheck.scene import load_scene
from satcheck.scene.motion import Path as MotionPath
from satcheck.scene.motion import Rotation, Translation
from tests.audit.motion.pairs import sweep

Mesh = trimesh.Trimesh
SIZES = (1_000, 20_000)
# Of FCL: the error of a time, and the steps of its advancement.
TIME_ERROR, ADVANCES = 1e-6, 10_000


class Case(Struct, frozen=True):
    """B is at rest. impact: the true time of impact; None: the bodies stay apart."""

    family: str
    a: Mesh
    path: MotionPath
    b: Mesh
    impact: Answer


def torus(triangles: int, major: float, minor: float) -> Mesh:
    """Its axis is z."""
    across = max(8, math.isqrt(triangles // 3))
    along = triangles // (2 * across)
    mesh: Mesh = trimesh.creation.torus(major, minor, major_sections=along, minor_sections=across)
    return mesh


def block(triangles: int, low: list[float], high: list[float]) -> Mesh:
    mesh: Mesh = trimesh.creation.box(bounds=[low, high])
    while len(mesh.faces) < triangles // 2:
        mesh = mesh.subdivide()
    return mesh


def reaches(ahead: NDArray[np.float64], wall: float, length: float) -> float:
    """When the farthest of these coordinates, moved by `length`, reaches the wall."""
    return float((Fraction(wall) - Fraction(float(ahead.max()))) / Fraction(length))


def cases(triangles: int, pairs: int) -> list[Case]:
    draw = random.Random(22)
    found = []
    for _ in range(pairs):
        ring = torus(triangles, draw.uniform(0.8, 1.2), draw.uniform(0.2, 0.4))
        wall, length = draw.uniform(2, 4), draw.uniform(5, 9)
        plate = block(triangles, [wall, -5, -5], [wall + 0.01, 5, 5])
        along = Translation((length, 0.0, 0.0))
        impact = reaches(ring.vertices[:, 0], wall, length)
        found.append(Case("into a plate", ring, along, plate, impact))

        wire = torus(triangles, draw.uniform(0.8, 1.2), 1e-4)
        sheet = block(triangles, [-5, -5, wall], [5, 5, wall + 1e-5])
        impact = reaches(wire.vertices[:, 2], wall, 7.0)
        found.append(Case("a wire through a sheet", wire, Translation((0, 0, 7.0)), sheet, impact))

        radius = 0.9 * float(np.hypot(*ring.vertices[:, :2].T).min())
        rod = trimesh.creation.cylinder(radius, 1.0, sections=triangles // 4)
        rod.apply_translation([0, 0, -3])
        found.append(Case("a rod through a ring", rod, Translation((0, 0, 6.0)), ring, None))

        low = float(ring.vertices[:, 2].min())
        table = block(triangles, [-9, -9, low - 1], [9, 9, low - 1e-6])
        found.append(Case("a gap of 1e-6", ring, along, table, None))

        floor = block(triangles, [-9, -9, low - 3], [9, 9, low - 2])
        deep = -2.0 - 1e-6
        impact = reaches(-ring.vertices[:, 2], -low + 2, -deep)
        found.append(
            Case("1e-6 deep at the end", ring, Translation((3.0, 1.0, deep)), floor, impact)
        )

        bar = block(triangles, [1, -draw.uniform(0.1, 0.3), 0], [3, 0, 1])
        post = block(triangles, [-0.5, 1, 0], [0, 3, 1])
        turn = Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 120.0)
        found.append(Case("a bar turns into a wall", bar, turn, post, 0.75))

        square = block(triangles, [-1, -1, 0], [1, 1, 1])
        beside = block(triangles, [math.sqrt(2) + 1e-3, -5, 0], [9, 5, 1])
        found.append(Case("a square turns beside a wall", square, turn, beside, None))
    return found


def path_matrix(path: MotionPath, t: float) -> NDArray[np.float64]:
    """The pose at t. These rotations are about the origin."""
    matrix = np.eye(4)
    if isinstance(path, Rotation):
        turned = transform.about(path.axis, transform.cos_sin(path.degrees * t))
        matrix[:3, :3] = np.reshape(turned, (3, 3))
    elif isinstance(path, Translation):
        matrix[:3, 3] = np.multiply(path.vector, t)
    return matrix


def by_satcheck(case: Case) -> Callable[[], Answer]:
    settings = Settings(depth=False)
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / name for name in ("a.obj", "b.obj")]
        for path, mesh in zip(paths, (case.a, case.b), strict=True):
            mesh.export(path, digits=17, include_normals=False)
        scene = load_scene(paths)
    a, b = (PlacedBody(body, SharedMesh(body.file, settings)) for body in scene.bodies)
    pair = Pair(a, b, settings, request_for(settings))
    for body in (a, b):
        body.surface(), body.hull_shape()

    def ask() -> Answer:
        found = sweep(pair, case.path, None)
        if found.relation == "indeterminate":
            return math.nan
        return None if found.time_of_impact is None else found.time_of_impact[1]

    return ask


def by_fcl(case: Case, solver: int, steps: int) -> Callable[[], Answer]:
    def model(mesh: Mesh) -> fcl.CollisionObject:
        bvh = fcl.BVHModel()
        bvh.beginModel(len(mesh.vertices), len(mesh.faces))
        bvh.addSubModel(mesh.vertices, mesh.faces)
        bvh.endModel()
        return fcl.CollisionObject(bvh, fcl.Transform())

    a, b = model(case.a), model(case.b)
    turns = isinstance(case.path, Rotation)
    kinds = fcl.CCDMotionType
    motion = kinds.CCDM_LINEAR if turns else kinds.CCDM_TRANS
    end = path_matrix(case.path, 1.0)
    there = fcl.Transform(end[:3, :3], end[:3, 3])

    def ask() -> Answer:
        request = fcl.ContinuousCollisionRequest(steps, TIME_ERROR, motion, 0, solver)
        result = fcl.ContinuousCollisionResult()
        fcl.continuousCollide(a, there, b, fcl.Transform(), request, result)
        return result.time_of_contact if result.is_collide else None

    return ask


def by_coal(case: Case, poses: int) -> Callable[[], Answer]:
    def model(mesh: Mesh) -> Any:
        bvh = coal.BVHModelOBBRSS()
        bvh.beginModel(len(mesh.faces), len(mesh.vertices))
        bvh.addVertices(np.asarray(mesh.vertices))
        bvh.addTriangles(np.asarray(mesh.faces))
        bvh.endModel()
        return bvh

    a, b, rest = model(case.a), model(case.b), coal.Transform3s()
    times = [k / poses for k in range(poses + 1)]
    placed = []
    for t in times:
        matrix = path_matrix(case.path, t)
        placed.append(coal.Transform3s(matrix[:3, :3].copy(), matrix[:3, 3].copy()))

    def ask() -> Answer:
        for t, pose in zip(times, placed, strict=True):
            if coal.collide(a, pose, b, rest, coal.CollisionRequest(), coal.CollisionResult()):
                return t
        return None

    return ask


METHODS: dict[str, Callable[[Case], Callable[[], Answer]]] = {
    "satcheck": by_satcheck,
    "FCL, conservative advancement": lambda c: by_fcl(
        c, fcl.CCDSolverType.CCDC_CONSERVATIVE_ADVANCEMENT, ADVANCES
    ),
    "FCL, 1,000 poses": lambda c: by_fcl(c, fcl.CCDSolverType.CCDC_NAIVE, 1000),
    "coal, 100 poses": lambda c: by_coal(c, 100),
    "coal, 1,000 poses": lambda c: by_coal(c, 1000),
}


class Score(Struct):
    seconds: float = 0.0
    missed: int = 0
    false_hits: int = 0
    off: int = 0
    undecided: int = 0

    def judge(self, case: Case, answer: Answer) -> str:
        """The kind of the answer; "" if it is right."""
        if answer is not None and math.isnan(answer):
            self.undecided += 1
            return "undecided"
        if case.impact is None:
            self.false_hits += answer is not None
            return "false hit" if answer is not None else ""
        if answer is None:
            self.missed += 1
            return "missed"
        off = abs(answer - case.impact) > OFF
        self.off += off
        return "off" if off else ""


def measure(triangles: int, pairs: int, rounds: int) -> dict[str, Score]:
    scores = {name: Score() for name in METHODS}
    wrong: dict[tuple[str, str, str], int] = {}
    all_cases = cases(triangles, pairs)
    for case in all_cases:
        asks = {name: method(case) for name, method in METHODS.items()}
        least = dict.fromkeys(METHODS, math.inf)
        answers: dict[str, Answer] = {}
        for _ in range(rounds):
            for name, ask in asks.items():
                start = time.process_time()
                answers[name] = ask()
                least[name] = min(least[name], time.process_time() - start)
        for name, score in scores.items():
            score.seconds += least[name]
            kind = score.judge(case, answers[name])
            if kind:
                wrong[name, case.family, kind] = wrong.get((name, case.family, kind), 0) + 1
    for (name, family, kind), count in sorted(wrong.items()):
        sys.stdout.write(f"{triangles} triangles, {name}, {family}: {count} {kind}\n")
    return scores


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--pairs", type=int, default=10, help="pairs of each of the 7 families")
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    results = {size: measure(size, given.pairs, given.rounds) for size in SIZES}
    head = " | ".join(f"a second, {size:,} triangles" for size in SIZES)
    sys.stdout.write(f"\n| | {head} | missed | false hits | off | undecided |\n|---|{'---|' * 6}\n")
    for name in METHODS:
        rows = [results[size][name] for size in SIZES]
        speeds = " | ".join(f"{7 * given.pairs / row.seconds:,.0f}" for row in rows)
        counts = [
            sum(getattr(row, field) for row in rows)
            for field in ("missed", "false_hits", "off", "undecided")
        ]
        sys.stdout.write(f"| {name} | {speeds} | {' | '.join(map(str, counts))} |\n")


if __name__ == "__main__":
    main()
