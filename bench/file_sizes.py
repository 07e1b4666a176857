"""Where the time of `satcheck A B` goes, for files of 1 kB, 1 MB and 100 MB.

    python -m bench.file_sizes [--rounds 3] [--sizes 1e3 1e6 1e8]

Two bumpy rings of mesh_pairs.py, interlocked without contact ("near") or crossing, as binary STL
and as OBJ, in the order of the surface. The command is the plain one, with depth and thickness.
A process of its own runs the command with clocks around its parts. Another one runs it with
--no-depth: its check gives the relation, and what the plain check takes longer is depth and
thickness.

The limit is measured in the same run: a process that imports numpy reads the bytes of both files
once and passes once over all triangles (the sum of their coordinates). The numbers are binary
there, so the limit of OBJ has no price for parsing. Each takes turns in every round;
the least wall time of each counts.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from bench.mesh_pairs import Soup, ring
from bench.whole import placed, write_binary_stl, write_obj

# Bytes of a triangle: STL has 50, OBJ about 42 (half a vertex, and a face).
BYTES = {"STL": 50, "OBJ": 42}
WRITERS = {"STL": write_binary_stl, "OBJ": write_obj}
# Seconds beyond the start of numpy below which the limit is noise.
LEAST = 0.02
NAMES = {1e3: "1 kB", 1e6: "1 MB", 1e8: "100 MB"}

# Runs the command with clocks around its parts.
CLOCKED = """
import sys, time, json, atexit
begun = time.perf_counter()
spent = {}
from satcheck.cli.commands import check as command
def clocked(name, own):
    def call(*given, **named):
        start = time.perf_counter()
        spent.setdefault("before " + name, start - begun)
        try:
            return own(*given, **named)
        finally:
            spent[name] = spent.get(name, 0.0) + time.perf_counter() - start
    return call
command.load = clocked("reading", command.load)
command._check = clocked("check", command._check)
command._deliver = clocked("report", command._deliver)
def tell():
    spent["all"] = time.perf_counter() - begun
    with open(sys.argv[0], "w") as out:
        json.dump(spent, out)
sys.argv = sys.argv[1:]
atexit.register(tell)
from satcheck.cli import main
main()
"""
LIMIT = """
import sys, numpy as np
for path, binary in zip(sys.argv[1::2], sys.argv[2::2]):
    with open(path, "rb") as file:
        np.frombuffer(file.read(), np.uint8).max()
    np.load(binary).sum()
"""


def rings(bytes_wanted: float, form: str) -> tuple[Soup, dict[str, Soup]]:
    half = max(int(bytes_wanted / BYTES[form] / 2), 12)
    across = max(int((half / 2) ** 0.5), 3)
    around = max(half // across, 3)
    first, other = (ring(0.7, seed, around, across, shuffled=False) for seed in (1, 2))
    return first, placed(other)


def clocked(command: list[str], folder: Path) -> dict[str, float]:
    """Wall seconds of the process and of its parts."""
    told = folder / "told.json"
    start = time.perf_counter()
    process = [sys.executable, "-c", CLOCKED, str(told), "--no-config", *command]
    done = subprocess.run(process, capture_output=True, check=False, text=True)
    wall = time.perf_counter() - start
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    spent = json.loads(told.read_text())
    return {
        "start": wall - spent["all"] + spent["before reading"],
        "reading": spent["reading"],
        "check": spent["check"],
        "report": spent["report"],
        "whole": wall,
    }


def timed(command: list[str]) -> float:
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - start


def row(size: float, form: str, name: str, rounds: int, folder: Path) -> str:
    first, others = rings(size, form)
    paths, binaries = [], []
    for soup, stem in ((first, "a"), (others[name], "b")):
        path, binary = folder / f"{stem}.{form.lower()}", folder / f"{stem}.npy"
        WRITERS[form](path, soup)
        np.save(binary, soup.vertices[soup.triangles])
        paths.append(str(path))
        binaries.append(str(binary))
    limit_command = [sys.executable, "-c", LIMIT]
    limit_command += [str(each) for pair in zip(paths, binaries, strict=True) for each in pair]
    best: dict[str, float] = {}
    relation = limit = bare = float("inf")
    for _ in range(rounds):
        spent = clocked(paths, folder)
        if spent["whole"] < best.get("whole", float("inf")):
            best = spent
        relation = min(relation, clocked(["--no-depth", *paths], folder)["check"])
        limit = min(limit, timed(limit_command))
        bare = min(bare, timed([sys.executable, "-c", "import numpy"]))
    best["relation"], best["depth"] = relation, max(best["check"] - relation, 0.0)
    parts = ("start", "reading", "relation", "depth", "report", "whole")
    cells = " | ".join(f"{1e3 * best[part]:.1f}" for part in parts)
    beyond_start = limit - bare
    reading = f"{best['reading'] / beyond_start:.1f}" if beyond_start > LEAST else "-"
    megabytes = sum(Path(path).stat().st_size for path in paths) / 2e6
    return (
        f"| {NAMES.get(size, f'{size:g}')} {form}, {name} | {len(first.triangles):,} | "
        f"{megabytes:.3g} | {cells} | {1e3 * limit:.1f} | {1e3 * bare:.1f} | "
        f"{best['whole'] / limit:.1f} | {reading} |"
    )


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--sizes", type=float, nargs="+", default=[1e3, 1e6, 1e8])
    options = parser.parse_args()
    heads = ["files", "triangles of each", "MB of each", "start", "reading", "relation"]
    heads += ["depth, thickness", "report", "whole, ms", "limit", "import numpy", "whole / limit"]
    heads += ["reading / limit without import"]
    sys.stdout.write("| " + " | ".join(heads) + " |\n" + "|---" * len(heads) + "|\n")
    for size in options.sizes:
        for form in BYTES:
            for name in ("near", "crossing"):
                with tempfile.TemporaryDirectory() as folder:
                    sys.stdout.write(row(size, form, name, options.rounds, Path(folder)) + "\n")
                    sys.stdout.flush()


if __name__ == "__main__":
    main()
