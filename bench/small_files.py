"""What a scene of many small files costs beside the least that any reader of them could do.

    python -m bench.small_files [--files 5000] [--rounds 9]

Each body has an OBJ file of its own, a box of 12 triangles. The floor does in one loop what cannot
be left out, and keeps no more than its results: the text of the scene is parsed by `tomllib`, each
file is looked up, read and hashed, and the C++ readers parse and inspect it. Both take turns in
every round; the least CPU time of each counts.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import random
import sys
import tempfile
import time
import tomllib
from collections.abc import Callable
from pathlib import Path

from satcheck import core
from satcheck._native import readers
from satcheck.scene import load_scene
from satcheck.scene.opening import signature

SCENE = "scene.toml"
CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
QUADS = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))
BODY = '\n[[bodies]]\nid = "b{0}"\nmesh = "m/b{0}.obj"\nposition = {1}\n'


def write_scene(folder: Path, count: int) -> None:
    chance = random.Random(0)
    (folder / "m").mkdir()
    text = 'schema = "satcheck.scene/1"\nunits = "m"\n'
    for k in range(count):
        sides = [chance.uniform(0.5, 1.5) for _ in range(3)]
        corners = ([s * c for s, c in zip(sides, at, strict=True)] for at in CORNERS)
        lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in corners]
        for a, b, c, d in QUADS:
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
        (folder / "m" / f"b{k}.obj").write_text("\n".join(lines) + "\n")
        text += BODY.format(k, [chance.uniform(0, 17) for _ in range(3)])
    (folder / SCENE).write_text(text)


def floor() -> list[object]:
    made: list[object] = []
    for body in tomllib.loads(Path(SCENE).read_text())["bodies"]:
        status = signature(body["mesh"])
        assert status is not None
        descriptor = os.open(body["mesh"], os.O_RDONLY)
        data = readers.read_file(descriptor, status[3])
        os.close(descriptor)
        mesh = readers.read_obj(data)
        assert isinstance(mesh, readers.MeshData)
        inspection = core.inspect_bytes(mesh.vertices, mesh.triangles, True)
        made.append((hashlib.sha256(data).hexdigest(), inspection))
    return made


def loaded() -> object:
    return load_scene([SCENE])


def seconds(run: Callable[[], object]) -> float:
    start = time.process_time()
    kept = run()
    took = time.process_time() - start
    del kept
    return took


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--files", type=int, default=5000)
    parser.add_argument("--rounds", type=int, default=9)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        write_scene(Path(folder), given.files)
        os.chdir(folder)
        rounds = [(seconds(floor), seconds(loaded)) for _ in range(given.rounds)]
        os.chdir("/")
    least, ours = (1e6 * min(each) / given.files for each in zip(*rounds, strict=True))
    sys.stdout.write(f"CPU microseconds for a file: {least:.0f} floor, {ours:.0f} load_scene\n")
    sys.stdout.write(f"load_scene is {ours / least:.2f} times the floor\n")


if __name__ == "__main__":
    main()
