"""A batch of 100,000 pairs from Python beside the same pairs from C++, on one thread and on two.

    cmake -S . -B build/cxx -DSATCHECK_PYTHON=OFF -DSATCHECK_BENCH=ON && cmake --build build/cxx
    python -m bench.batch FOLDER [W1 W2_12 ...] [--pairs 100000] [--rounds 9]

FOLDER holds pair files (convex_pairs.py says which form they have). Their pairs are taken in turn,
again and again, until there are enough: boxes, small hulls and large ones side by side. Compared is
from arrays of indices and poses to contiguous arrays of outcomes, distances, normals and witness
points (overlap: outcomes alone) with `core.check_pairs`, and from prepared requests to the same
arrays with check_pairs() of core/native/convex/batch.hpp. Everybody is asked once a round, one
after the other; the best round of each counts, as others may use the machine. Ratios of one thread
are of CPU time, those of threads are of wall time. `machine` is the same ratio of plain arithmetic
in registers, asked in the same rounds: what two threads could give at best. `work`: CPU time on two
threads by that on one; 1 means that the second thread costs nothing.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.convex_pairs import MAGIC, PAIR, Query, read_pair_file
from satcheck import core

QUERIES: tuple[Query, ...] = ("overlap", "depth", "distance")
THREADS = (1, 2)
HEADER_BYTES = 24
SLOW = ("W3F", "W6")  # pairs that need exact arithmetic: nothing else would be seen beside it
DRIVER = Path("build/cxx/bench/native/batch_driver")
MACHINE = "machine"

Asked = Callable[[Query, int], tuple[float, float, int]]


@dataclass(frozen=True, slots=True)
class Batch:
    """Shapes, and PAIR rows, as a file and in memory."""

    shapes: list[Any]
    pairs: NDArray[Any]
    path: Path


def shape_bytes(path: Path) -> bytes:
    data = path.read_bytes()
    return data[HEADER_BYTES : len(data) - PAIR.itemsize * int(np.frombuffer(data, "<u4", 2, 8)[1])]


def mixed(paths: list[Path], count: int, to: Path) -> Batch:
    """The pairs of all files in turn: every file gives its next one, until there are `count`."""
    files = [read_pair_file(path) for path in paths]
    firsts = np.cumsum([0, *(len(file.shapes) for file in files)])
    pairs = np.empty(count, PAIR)
    for k, (file, first) in enumerate(zip(files, firsts[:-1], strict=True)):
        mine = pairs[k :: len(files)]
        mine[:] = file.pairs[np.arange(len(mine)) % len(file.pairs)]
        mine["a"] += np.uint32(first)
        mine["b"] += np.uint32(first)
    head = MAGIC + np.array([firsts[-1], count, 0, 0], "<u4").tobytes()
    to.write_bytes(head + b"".join(map(shape_bytes, paths)) + pairs.tobytes())
    return Batch([shape for file in files for shape in file.shapes], pairs, to)


def from_python(batch: Batch) -> Asked:
    arrays = [np.ascontiguousarray(batch.pairs[name]) for name in ("a", "b", "pose_a", "pose_b")]

    def ask(query: Query, threads: int) -> tuple[float, float, int]:
        start, worked = time.perf_counter_ns(), time.process_time_ns()
        found = core.check_pairs(batch.shapes, *arrays, query=query, threads=threads)
        outcome = np.ascontiguousarray(found.outcome)
        if query != "overlap":
            for column in (found.distance, found.normal, found.witness_a, found.witness_b):
                np.ascontiguousarray(column)
        cpu = time.process_time_ns() - worked
        return time.perf_counter_ns() - start, cpu, int(outcome.sum(dtype=np.int64))

    return ask


def from_cxx(child: subprocess.Popen[str], instead: str = "") -> Asked:
    """The driver's answers to the query, or to what is to be asked `instead`."""
    assert child.stdin is not None
    assert child.stdout is not None
    to, back = child.stdin, child.stdout

    def ask(query: Query, threads: int) -> tuple[float, float, int]:
        to.write(f"{instead or query} {threads}\n")
        to.flush()
        wall, cpu, total = back.readline().split()
        return float(wall), float(cpu), int(total)

    return ask


def measure(asked: dict[str, Asked], query: Query, rounds: int) -> dict[tuple[str, int], Any]:
    """Least wall and CPU nanoseconds by who and how many threads. The outcomes must agree."""
    best: dict[tuple[str, int], Any] = {}
    totals = set()
    for _ in range(rounds):
        for threads in THREADS:
            for who, ask in asked.items():
                wall, cpu, total = ask(query, threads)
                least = best.get((who, threads), (wall, cpu))
                best[who, threads] = min(wall, least[0]), min(cpu, least[1])
                if who != MACHINE:
                    totals.add(total)
    if len(totals) != 1:
        raise RuntimeError(f"{query}: the outcomes differ: {totals}")
    return best


def row(query: Query, best: dict[tuple[str, int], Any], count: int) -> str:
    one, cxx = best["Python", 1], best["C++", 1]
    python, native, machine = (
        best[who, 1][0] / best[who, 2][0] for who in ("Python", "C++", MACHINE)
    )
    return (
        f"| {query} | {cxx[1] / count:.0f} | {one[1] / count:.0f} | {one[1] / cxx[1]:.2f} "
        f"| {python:.2f} | {native:.2f} | {machine:.2f} | {best['Python', 2][1] / one[1]:.2f} |"
    )


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument(
        "names", nargs="*", help="files to take pairs from; default all but W3F and W6"
    )
    parser.add_argument("--pairs", type=int, default=100_000)
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--driver", type=Path, default=DRIVER)
    options = parser.parse_args()
    every = sorted(path.stem for path in options.folder.glob("*.pairs") if path.stem not in SLOW)
    paths = [options.folder / f"{name}.pairs" for name in options.names or every]
    lines = [
        "| query | C++, ns a pair | Python | ratio | 2 threads, Python | C++ | machine | work |",
        "|---|---|---|---|---|---|---|---|",
    ]
    with tempfile.TemporaryDirectory() as folder:
        batch = mixed(paths, options.pairs, Path(folder) / "batch.pairs")
        command = [str(options.driver.absolute()), str(batch.path)]
        with subprocess.Popen(
            command, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE
        ) as child:
            asked = {
                "C++": from_cxx(child),
                "Python": from_python(batch),
                MACHINE: from_cxx(child, "arithmetic"),
            }
            for query in QUERIES:
                lines.append(row(query, measure(asked, query, options.rounds), options.pairs))
            assert child.stdin is not None
            child.stdin.close()
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
