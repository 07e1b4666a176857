"""The benches: each writes its inputs into a folder and gives its rows, named, to be measured.

Whole commands take one thread; their time is that of the process and of all its children.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from bench.comparison import answers, inputs
from bench.comparison.measuring import Measure, ask, check, command, python
from bench.comparison.sides import ROOT
from bench.scene_of import write_scene
from sample_meshes import make

SAMPLES = ROOT / "sample_meshes"
ONE_THREAD = ("-j", "1")
CONVEX_KINDS = ("boxes", "hulls-12", "hulls-60", "flush")
CONVEX_QUERIES = ("overlap", "depth", "distance")
# Readers of XML take seconds.
SLOW_READERS = ("3mf", "dae")

Rows = dict[str, Measure]


def convex(_: Path) -> Rows:
    """Thousands of pairs in one call of the Python interface."""
    return {
        f"{kind} {query}": ask("convex", kind, query)
        for kind in CONVEX_KINDS
        for query in CONVEX_QUERIES
    }


def concave_pairs(folder: Path) -> dict[str, list[str]]:
    link = inputs.MESHES["link_a.ply"]
    other = inputs.turned(link, 0.7, (0.4, 0.3, 0.2))
    return {
        "kettle": [str(SAMPLES / name) for name in ("kettle.obj", "snowflake.obj")],
        "links": inputs.write_pair(folder, "link", link, other),
        "rings": inputs.crossing_rings(folder, 64, 40),
    }


def depth(folder: Path) -> Rows:
    rows = {name: ask("depth", *pair) for name, pair in concave_pairs(folder).items()}
    large = [*inputs.crossing_rings(folder, *inputs.LARGE), *ONE_THREAD]
    whole = check(large, answers.of_report, folder / "large.json", 1)
    return rows | {"command, 128,000 triangles each": whole}


def thickness(folder: Path) -> Rows:
    return {name: ask("thickness", *pair) for name, pair in concave_pairs(folder).items()}


def scenes(folder: Path) -> Rows:
    few, many, nodes = (folder / name for name in ("few.json", "many.json", "nodes.glb"))
    write_scene(500, few)
    write_scene(3000, many)
    nodes.write_bytes(inputs.glb_of_nodes(500))
    flat, deep = ["--no-depth"], ["--depth", "--depth-budget", "0.02"]
    asked = {
        "500 bodies, no depth": [str(few), *flat],
        "500 bodies, depth": [str(few), *deep],
        "3,000 bodies, no depth": [str(many), *flat],
        "one GLB, no depth": [str(nodes), *flat],
        "one GLB, depth": [str(nodes), *deep],
    }
    out = folder / "scene_out.json"
    return {
        name: check([*words, *ONE_THREAD], answers.of_report, out, 2)
        for name, words in asked.items()
    }


def robots(folder: Path) -> Rows:
    """Up to 1,000 poses are listed, more are counted."""
    arm = [str(SAMPLES / name) for name in ("arm.urdf", "arm.srdf")]
    rows = {}
    for count in (1000, 50_000):
        words = [*arm, "--sample", str(count), *ONE_THREAD]
        rows[f"{count:,} poses"] = check(words, answers.of_samples, folder / "poses.json", 2)
    return rows


def startup(_: Path) -> Rows:
    """The last row does not know satcheck: it shows how quiet the machine is."""
    pair = [str(SAMPLES / name) for name in ("box.obj", "box_pushed.stl")]
    return {
        "satcheck --version": command(["--version"], answers.of_nothing, None, 5),
        "satcheck --help": command(["--help"], answers.of_nothing, None, 5),
        "satcheck A B": command([*pair, "--no-config"], answers.of_nothing, None, 5),
        "import numpy": python(["-c", "import numpy"], 5),
    }


def readers(folder: Path) -> Rows:
    """Two bodies far apart, of 128,000 triangles each: next to nothing is checked."""
    first = inputs.ring(*inputs.LARGE)
    other = inputs.turned(first, math.pi / 3, (20.0, 0.0, 0.0))
    rows = {}
    for ending, write in inputs.WRITERS.items():
        paths = [folder / f"{letter}.{ending}" for letter in "ab"]
        for path, mesh in zip(paths, (first, other), strict=True):
            path.write_bytes(write(mesh))
        # A busy machine should not end the reading of a file.
        words = [*map(str, paths), "--no-depth", "--seconds-per-file=600", *ONE_THREAD]
        runs = 1 if ending in SLOW_READERS else 3
        rows[ending] = check(words, answers.of_report, folder / "reading.json", runs)
    return rows


def batch(folder: Path) -> Rows:
    """Scenes that share the sample meshes, and scenes of files that no other scene has."""
    shared, own = folder / "shared", folder / "own"
    for place in (shared, own):
        place.mkdir()
    for k in range(200):
        write_scene(8, shared / f"{k:03}.json", seed=k)
        write_own_scene(own, k)
    out = folder / "results.jsonl"
    named = {"shared meshes": shared.glob("*.json"), "own files": own.glob("*.toml")}
    return {
        f"200 scenes, {name}": check(
            ["batch", *map(str, sorted(paths)), "--no-depth", *ONE_THREAD],
            answers.of_results,
            out,
            1,
        )
        for name, paths in named.items()
    }


def write_own_scene(folder: Path, number: int) -> None:
    """Three links, each a file of its own."""
    link = inputs.MESHES["link_a.ply"]
    lines = ['schema = "satcheck.scene/1"', 'units = "m"']
    for k in range(3):
        file = f"{number:03}_{k}.stl"
        moved = inputs.turned(link, number + k, (0.01 * number, 0.0, 0.0))
        (folder / file).write_bytes(make.stl(moved))
        lines += ["[[bodies]]", f'id = "link_{k}"', f'mesh = "{file}"']
    (folder / f"{number:03}.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")


BENCHES: dict[str, Callable[[Path], Rows]] = {
    "convex": convex,
    "depth": depth,
    "thickness": thickness,
    "scenes": scenes,
    "robots": robots,
    "startup": startup,
    "readers": readers,
    "batch": batch,
}
