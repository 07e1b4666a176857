"""Whole processes on two mesh files: imports, reading, the question, the report.

    python -m bench.whole pairs|large|readers [--rounds 5]

pairs: two bumpy rings of 70,000 triangles (mesh_pairs.py) in three placements, as binary STL, text
STL and OBJ: relation and distance by satcheck, beside trimesh's CollisionManager
(in_collision_other, and min_distance_other where nothing collides).
large: two such rings of 1,000,000 triangles as binary STL: `satcheck --no-depth`, beside a process
that imports numpy and reads both files with np.fromfile and the record dtype of the format, and
does nothing with them.
readers: one ring of 70,000 triangles in each format, in this process: read and inspected, welded
and sorted by satcheck, read by trimesh.

Vertices and triangles come in random order, which is the hardest for memory; in `large` also in
the order of the surface, as exporters write them. All take turns in every round, byte-compiled; the
least time of each counts. Wall times depend on how many cores are free: satcheck uses two for two
files and two bodies, the others one.
"""

from __future__ import annotations

import argparse
import compileall
import sys
import sysconfig
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.mesh_pairs import Soup, ring
from bench.scenes import run

PEER = Path(__file__).resolve().parent / "peers" / "ask_trimesh_pair.py"
FACET = [("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]
READ_BOTH = f"""
import sys, numpy as np
for path in sys.argv[1:]:
    np.fromfile(path, np.dtype({FACET}), offset=84)
"""
FARTHEST = "1e9"  # a clearance that asks for every distance
UPRIGHT = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
EIGHTH = np.array([[0.5**0.5, -(0.5**0.5), 0], [0.5**0.5, 0.5**0.5, 0], [0, 0, 1]])
SMALL, LARGE = (250, 140), (1000, 500)  # around, across: half the triangles

Times = dict[str, tuple[float, float]]  # least wall and CPU seconds by name


def placed(other: Soup) -> dict[str, Soup]:
    """The second ring beside the first: boxes apart; only hulls apart; near; crossing."""
    upright = other.vertices @ UPRIGHT.T

    def at(points: NDArray[np.float64], x: float, y: float = 0.0) -> Soup:
        return Soup(points + np.array([x, y, 0]), other.triangles)

    return {
        "boxes apart": at(other.vertices, 8),
        "hulls apart": at(upright @ EIGHTH.T, 3.9, 3.9),
        "near": at(upright, 2.53),
        "crossing": at(upright, 2.9),
    }


def write_binary_stl(path: Path, soup: Soup) -> None:
    facets = np.zeros(len(soup.triangles), np.dtype(FACET))
    facets["v"] = soup.vertices[soup.triangles]
    path.write_bytes(b" " * 80 + np.uint32(len(facets)).tobytes() + facets.tobytes())


def write_text_stl(path: Path, soup: Soup) -> None:
    with path.open("w", encoding="ascii") as out:
        out.write("solid ring\n")
        for corners in soup.vertices[soup.triangles].tolist():
            points = "".join(f"   vertex {x:.6e} {y:.6e} {z:.6e}\n" for x, y, z in corners)
            out.write(f" facet normal 0 0 0\n  outer loop\n{points}  endloop\n endfacet\n")
        out.write("endsolid ring\n")


def write_obj(path: Path, soup: Soup) -> None:
    with path.open("w", encoding="ascii") as out:
        out.writelines(f"v {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in soup.vertices.tolist())
        out.writelines(f"f {i} {j} {k}\n" for i, j, k in (soup.triangles + 1).tolist())


WRITERS: dict[str, tuple[str, Callable[[Path, Soup], None]]] = {
    "binary STL": (".stl", write_binary_stl),
    "text STL": (".text.stl", write_text_stl),
    "OBJ": (".obj", write_obj),
}


def written(folder: Path, name: str, soup: Soup, form: str) -> str:
    suffix, write = WRITERS[form]
    path = folder / (name.replace(" ", "_") + suffix)
    write(path, soup)
    return str(path)


def in_turn(commands: dict[str, list[str]], rounds: int) -> Times:
    best: Times = {}
    for _ in range(rounds):
        for name, command in commands.items():
            wall, cpu, _, _ = run(command)
            least = best.get(name, (wall, cpu))
            best[name] = min(wall, least[0]), min(cpu, least[1])
    return best


def satcheck(*options: str) -> list[str]:
    return [str(Path(sysconfig.get_path("scripts")) / "satcheck"), "--no-depth", *options]


def pairs(folder: Path, rounds: int) -> list[str]:
    lines = [
        "| placement | file | satcheck, s | CPU s | trimesh, s | CPU s | ratio | CPU ratio |",
        "|---|---|---|---|---|---|---|---|",
    ]
    first = ring(0.7, 1, *SMALL)
    others = placed(ring(0.7, 2, *SMALL))
    for form in WRITERS:
        a = written(folder, "a", first, form)
        for name in ("boxes apart", "near", "crossing"):
            b = written(folder, name, others[name], form)
            commands = {
                "ours": satcheck("--clearance", FARTHEST, a, b),
                "theirs": [sys.executable, str(PEER), a, b],
            }
            best = in_turn(commands, rounds)
            (wall, cpu), (their_wall, their_cpu) = best["ours"], best["theirs"]
            lines.append(
                f"| {name} | {form} | {wall:.2f} | {cpu:.2f} | {their_wall:.2f} | {their_cpu:.2f} "
                f"| {their_wall / wall:.1f} | {their_cpu / cpu:.1f} |"
            )
    return lines


def large(folder: Path, rounds: int) -> list[str]:
    lines = ["| | wall s | CPU s | wall ratio | CPU ratio |", "|---|---|---|---|---|"]
    commands: dict[str, list[str]] = {}
    for shuffled, order in ((True, ""), (False, ", in order")):
        first, other = (ring(0.7, seed, *LARGE, shuffled=shuffled) for seed in (1, 2))
        a = written(folder, f"a{order}", first, "binary STL")
        for name, soup in placed(other).items():
            b = written(folder, f"{name}{order}", soup, "binary STL")
            commands.setdefault("numpy reads both", [sys.executable, "-c", READ_BOTH, a, b])
            commands[f"satcheck, {name}{order}"] = satcheck(a, b)
    best = in_turn(commands, rounds)
    base = best["numpy reads both"]
    for name, (wall, cpu) in best.items():
        ratios = f"{wall / base[0]:.2f} | {cpu / base[1]:.2f}"
        lines.append(f"| {name} | {wall:.2f} | {cpu:.2f} | {ratios} |")
    return lines


def readers(folder: Path, rounds: int) -> list[str]:
    import trimesh

    from satcheck.scene import MeshFiles
    from satcheck.scene.document import FilePart

    lines = ["| 70,000 triangles | satcheck, CPU ms | trimesh | ratio |", "|---|---|---|---|"]
    for form in WRITERS:
        path = written(folder, "a", ring(0.7, 1, *SMALL), form)
        reads: dict[str, Callable[[str], Any]] = {
            "ours": lambda path: MeshFiles().mesh(FilePart(path, path)),
            "theirs": lambda path: trimesh.load(path, force="mesh"),
        }
        best = dict.fromkeys(reads, float("inf"))
        for _ in range(rounds):
            for name, read in reads.items():
                start = time.process_time()
                read(path)
                best[name] = min(best[name], 1e3 * (time.process_time() - start))
        ratio = best["theirs"] / best["ours"]
        lines.append(f"| {form} | {best['ours']:.0f} | {best['theirs']:.0f} | {ratio:.1f} |")
    return lines


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("pairs", "large", "readers"))
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    compileall.compile_dir(sysconfig.get_path("platlib"), quiet=2, workers=1)
    tables = {"pairs": pairs, "large": large, "readers": readers}
    with tempfile.TemporaryDirectory() as folder:
        lines = tables[options.what](Path(folder), options.rounds)
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
