"""What a scene of many small files costs beside the least that any reader of them could do.

    python -m bench.small_files [--files 5000] [--rounds 9] [--format obj ...] [--named]

Each body has a file of its own, a prism of 8 to 60 triangles; OBJ, STL, PLY, OFF and GLB take
turns. --named: the files are named one by one, without a scene. The floor does in one loop what
cannot be left out, and keeps no more than its results: the text of the scene is parsed by
`tomllib`, each file is looked up, read and hashed, the C++ readers parse it (of GLB the JSON is
parsed and the numbers are unpacked), and C++ inspects the mesh. Both take turns in every round; the
least CPU time of each counts.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import struct
import sys
import tempfile
import time
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path

from bench.comparison.inputs import WRITERS, turned
from sample_meshes.make import rod
from satcheck import core
from satcheck._native import readers
from satcheck.scene import load_scene
from satcheck.scene.access import signature

SCENE = "scene.toml"
FORMATS = ("obj", "stl", "ply", "off", "glb")
BODY = '\n[[bodies]]\nid = "b{0}"\nmesh = "{1}"\nposition = {2}\n'
PARSERS = {
    "obj": readers.read_obj,
    "stl": readers.read_stl,
    "ply": readers.read_ply,
    "off": readers.read_off,
}


def write_scene(folder: Path, count: int, formats: Sequence[str]) -> list[str]:
    """The names of the files."""
    chance = random.Random(0)
    (folder / "m").mkdir()
    text = 'schema = "satcheck.scene/1"\nunits = "m"\n'
    names = []
    for k in range(count):
        ending = formats[k % len(formats)]
        mesh = rod(chance.uniform(0.2, 0.6), -0.5, chance.uniform(0.0, 0.5), chance.randint(3, 16))
        mesh = turned(mesh, chance.uniform(0, 6), (0.0, 0.0, 0.0))
        names.append(f"m/b{k}.{ending}")
        (folder / names[-1]).write_bytes(WRITERS[ending](mesh))
        text += BODY.format(k, names[-1], [chance.uniform(0, 60) for _ in range(3)])
    (folder / SCENE).write_text(text)
    return names


def of_glb(data: bytes) -> tuple[bytes, bytes]:
    """Vertices and triangles of a file as `sample_meshes.make` writes it."""
    (length,) = struct.unpack_from("<I", data, 12)
    points, corners = json.loads(data[20 : 20 + length])["bufferViews"]
    start = 28 + length
    middle, end = start + points["byteLength"], start + points["byteLength"] + corners["byteLength"]
    vertices = readers.unpack_numbers(data[start:middle], "f", 3, 12, 0)
    assert vertices is not None
    return vertices, readers.unpack_indices(data[middle:end], "H", 2)[0]


def floor(names: Sequence[str] | None) -> list[object]:
    """names: None: those of the scene."""
    if names is None:
        names = [body["mesh"] for body in tomllib.loads(Path(SCENE).read_text())["bodies"]]
    made: list[object] = []
    for name in names:
        status = signature(name)
        assert status is not None
        descriptor = os.open(name, os.O_RDONLY)
        data = readers.read_file(descriptor, status[3])
        os.close(descriptor)
        if name.endswith("glb"):
            inspection = core.inspect_bytes(*of_glb(data), True)
        else:
            mesh = PARSERS[name[-3:]](data)
            assert isinstance(mesh, readers.MeshData)
            inspection = core.inspect_bytes(mesh.vertices, mesh.triangles, True)
        made.append((hashlib.sha256(data).hexdigest(), inspection))
    return made


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
    parser.add_argument("--format", nargs="+", choices=FORMATS, default=FORMATS)
    parser.add_argument("--named", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        names = write_scene(Path(folder), given.files, given.format)
        os.chdir(folder)
        inputs = names if given.named else [SCENE]
        rounds = [
            (
                seconds(lambda: floor(names if given.named else None)),
                seconds(lambda: load_scene(inputs)),
            )
            for _ in range(given.rounds)
        ]
        os.chdir("/")
    least, ours = (1e6 * min(each) / given.files for each in zip(*rounds, strict=True))
    sys.stdout.write(f"CPU microseconds for a file: {least:.0f} floor, {ours:.0f} load_scene\n")
    sys.stdout.write(f"load_scene is {ours / least:.2f} times the floor\n")


if __name__ == "__main__":
    main()
