"""What a check costs beside the least work with the same core: the rows of README.md with a floor.

    python -m bench.floors [arrays] [bodies] [convex] [--bodies 50000] [--rounds 5]

arrays: `satcheck.check_meshes` on two tetrahedra, relation only, beside the calls of the core that
decide it: inspection, trees, climb. Also with `satcheck.Mesh` made before.
bodies: `satcheck --no-depth SCENE` (scene_of.py) as JSON, whole processes, beside one that parses
the scene, asks the core about all close pairs on one thread, and writes names and relation of each.
It plans nothing, gives no reason and no cost, keeps no limit, and looks at no rule.
convex: `satcheck --no-depth` on two icospheres of 327,680 triangles that overlap, deep and shallow,
beside the same two where one vertex of the second is pushed in, so that it has no convex proof.

All take turns in every round; the least CPU time counts. Relations are compared in the same run.
Prints a line for each: the check, its floor, and the ratio. Needs Linux.
"""

from __future__ import annotations

import argparse
import compileall
import json
import sys
import sysconfig
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np

import satcheck
from bench.scene_of import write_scene
from bench.scenes import ask_satcheck, run
from satcheck import core
from satcheck.audit import Settings
from satcheck.report.report import OVERLAPS
from satcheck.scene import load_scene

CALLS = 2000
SCRIPT = str(Path(sysconfig.get_path("scripts")) / "satcheck")
POINTS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], dtype=np.uint32)
# As of arrays in float64 of this size.
STEP = 2.0**-49
SUBDIVISIONS = 7
DEEP, SHALLOW = 1.0, 1.95

# A Question of the core: two bodies, the gap limit, the tolerance, no depths of surfaces, no gap.
Question = tuple[core.PlacedGeometry, core.PlacedGeometry, float, float, float, float, bool]


def question(a: core.PlacedGeometry, b: core.PlacedGeometry, tolerance: float) -> Question:
    return a, b, tolerance, tolerance, 0.0, 0.0, False


def placed(points: bytes, faces: bytes) -> core.PlacedGeometry:
    found = core.inspect_bytes(points, faces, True)
    solid = found.repaired.solid
    return core.PlacedGeometry(core.Geometry(found.mesh, solid, solid), None, None, STEP)


def arrays(rounds: int) -> None:
    """Print microseconds of a call."""
    settings = Settings(depth=False)
    moved = POINTS + np.array([0.2, 0.1, 0.15])
    made = [satcheck.Mesh(points, FACES) for points in (POINTS, moved)]

    def check() -> str:
        return satcheck.check_meshes((POINTS, FACES), (moved, FACES), settings=settings).relation

    def check_made() -> str:
        return satcheck.check_meshes(made[0], made[1], settings=settings).relation

    def least() -> str:
        faces = FACES.tobytes()
        a, b = placed(POINTS.tobytes(), faces), placed(moved.tobytes(), faces)
        return core.climb(question(a, b, 2 * STEP)).relation

    ways: dict[str, Callable[[], str]] = {
        "two tetrahedra as arrays, us": check,
        "the same, satcheck.Mesh made before, us": check_made,
    }
    best = dict.fromkeys([*ways, "least"], float("inf"))
    for _ in range(rounds):
        for name, ask in {**ways, "least": least}.items():
            start = time.process_time()
            relations = {ask() for _ in range(CALLS)}
            best[name] = min(best[name], 1e6 * (time.process_time() - start) / CALLS)
            assert relations == {"penetrating"}, (name, relations)
    for name in ways:
        say(name, best[name], best["least"])


def bodies(count: int, rounds: int) -> None:
    """Print seconds of a process."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.json"
        write_scene(count, scene)
        command = [sys.executable, "-m", "bench.floors", "--decide", str(scene)]
        ours, least = float("inf"), float("inf")
        for _ in range(rounds):
            one = ask_satcheck(scene)
            _, cpu, _, said = run(command, fine=(0,))
            assert json.loads(said)["overlaps"] == one.pairs
            ours, least = min(ours, one.cpu), min(least, cpu)
    say(f"{count:,} bodies, --no-depth, s", ours, least)


def decide(scene: Path) -> None:
    """Print how many pairs of a scene overlap, as the least work finds them, and write as much as a
    report of them has."""
    document = msgspec.json.decode(scene.read_bytes())
    files = {body["mesh"]: None for body in document["bodies"]}
    shared = {path: load_scene([scene.parent / path]).bodies[0].file for path in files}
    geometry = {
        path: core.Geometry(file.mesh, file.health.solid, file.health.plain_solid)
        for path, file in shared.items()
    }
    paths = [body["mesh"] for body in document["bodies"]]
    meshes = [shared[path].mesh for path in paths]
    matrices = [[c for row in body["transform"] for c in row] for body in document["bodies"]]
    boxes = [box for box in core.placed_bounds(meshes, matrices, 1) if box is not None]
    reach = [2.0**-24 * mesh.largest_coordinate for mesh in meshes]
    made = [
        core.PlacedGeometry(geometry[path], matrix, None, step)
        for path, matrix, step in zip(paths, matrices, reach, strict=True)
    ]
    close = core.ClosePairs(boxes, reach, [0] * len(boxes), [], [])
    counts: Counter[str] = Counter()
    findings = []
    while pairs := close.take(256):
        asked = [question(made[i], made[j], reach[i] + reach[j]) for i, j in pairs]
        for (i, j), climb in zip(pairs, core.Climbing(asked, threads=1).results(), strict=True):
            assert climb is not None
            counts[climb.relation] += 1
            ids = document["bodies"][i]["id"], document["bodies"][j]["id"]
            findings.append({"a": ids[0], "b": ids[1], "relation": climb.relation})
    scene.with_suffix(".least").write_bytes(msgspec.json.encode(findings))
    overlaps = sum(counts[relation] for relation in OVERLAPS)
    sys.stdout.write(json.dumps({"overlaps": overlaps}))


def convex(rounds: int) -> None:
    """Print seconds of a process."""
    import trimesh  # the least work of `bodies` does not import it

    with tempfile.TemporaryDirectory() as folder:
        ball = trimesh.creation.icosphere(SUBDIVISIONS)
        ball.export(Path(folder) / "a.ply")
        for name, offset in (("deep", DEEP), ("shallow", SHALLOW)):
            other = ball.copy()
            other.apply_translation([offset, 0.01, 0.02])
            other.export(Path(folder) / f"{name}.ply")
            points = np.array(other.vertices)
            points[len(points) // 3] += 0.01 * (other.centroid - points[len(points) // 3])
            trimesh.Trimesh(points, other.faces, process=False).export(
                Path(folder) / f"{name}_dented.ply"
            )
            best: dict[str, float] = {}
            for _ in range(rounds):
                for file in (f"{name}.ply", f"{name}_dented.ply"):
                    paths = [str(Path(folder) / each) for each in ("a.ply", file)]
                    _, cpu, _, said = run([SCRIPT, "--no-depth", "--format", "json", *paths])
                    assert json.loads(said)["findings"][0]["relation"] == "penetrating"
                    best[file] = min(best.get(file, cpu), cpu)
            say(f"two icospheres, {name}, s; one dented", *best.values())


def say(name: str, ours: float, least: float) -> None:
    sys.stdout.write(f"{name}: {ours:.3g}, floor {least:.3g}, {ours / least:.2f} of it\n")
    sys.stdout.flush()


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rows", nargs="*", default=["arrays", "bodies", "convex"])
    parser.add_argument("--bodies", type=int, default=50_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--decide", type=Path, metavar="SCENE", help="the least work on one scene")
    given = parser.parse_args()
    if given.decide:
        decide(given.decide)
        return
    compileall.compile_dir(sysconfig.get_path("platlib"), quiet=2, workers=1)
    for row in given.rows:
        if row == "arrays":
            arrays(given.rounds)
        elif row == "bodies":
            bodies(given.bodies, given.rounds)
        elif row == "convex":
            convex(given.rounds)
        else:
            parser.error(f"no such row: {row}")


if __name__ == "__main__":
    main()
