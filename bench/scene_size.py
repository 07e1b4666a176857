"""Time and memory of `satcheck SCENE` against the number of bodies, at constant density.

    python -m bench.scene_size [--sizes 100,300,1000] [--rounds 3] [--svg docs/scene_size.svg]

Scenes come from scene_of.py; whole processes, verdicts only, report as JSON, as in scenes.py. The
sizes alternate in every round, least figures count. Prints a table with the slope between sizes in
a log-log plot (1: linear in the number of bodies) and writes the plot, a light and a dark file.
"""

from __future__ import annotations

import argparse
import compileall
import math
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from bench.drawing import name_decades, plain, write_both
from bench.scenes import Run, ask_satcheck
from satcheck.cli.plotting import style

SIZES = (100, 300, 1000, 3000, 10_000, 30_000, 100_000)


def slope(sizes: Sequence[int], values: Sequence[float]) -> float:
    """Of the line of least squares through the logarithms."""
    xs, ys = [math.log(size) for size in sizes], [math.log(value) for value in values]
    x, y = sum(xs) / len(xs), sum(ys) / len(ys)
    across = sum((a - x) ** 2 for a in xs)
    return sum((a - x) * (b - y) for a, b in zip(xs, ys, strict=True)) / across


def measure(sizes: Sequence[int], rounds: int) -> dict[int, Run]:
    """Of each size the least time and memory of all rounds."""
    best: dict[int, Run] = {}
    with tempfile.TemporaryDirectory() as folder:
        for size in sizes:
            # In a process of its own: a child counts the memory that its parent had as its own.
            out = str(Path(folder) / f"{size}.json")
            subprocess.run([sys.executable, "-m", "bench.scene_of", str(size), out], check=True)
        for _ in range(rounds):
            for size in sizes:
                one = ask_satcheck(Path(folder) / f"{size}.json")
                was = best.get(size, one)
                best[size] = Run(
                    min(one.wall, was.wall),
                    min(one.cpu, was.cpu),
                    min(one.mebibytes, was.mebibytes),
                    one.pairs,
                )
    return best


def table(runs: dict[int, Run]) -> str:
    lines = [
        "| bodies | overlaps | wall s | CPU s | MiB | slope of CPU |",
        "|---|---|---|---|---|---|",
    ]
    before: tuple[int, Run] | None = None
    for size, one in runs.items():
        local = ""
        if before is not None:
            local = f"{math.log(one.cpu / before[1].cpu) / math.log(size / before[0]):.2f}"
        figures = f"{one.wall:.2f} | {one.cpu:.2f} | {one.mebibytes} | {local}"
        lines.append(f"| {size:,} | {one.pairs:,} | {figures} |")
        before = size, one
    return "\n".join(lines)


def draw(runs: dict[int, Run], steep: float, *, dark: bool) -> Figure:
    """CPU seconds and MiB over one axis of numbers; dashed: time proportional to the bodies."""
    sizes, times = list(runs), [one.cpu for one in runs.values()]
    with style(dark=dark) as palette:
        figure = Figure((9, 5.5), layout="constrained")
        axes = figure.add_subplot(xlabel="bodies", xscale="log", yscale="log")
        axes.plot(sizes, [one.mebibytes for one in runs.values()], "o-", color=palette.guess)
        axes.plot(sizes, times, "o-", color=palette.proven)
        low = axes.get_ylim()[0]
        axes.plot(sizes, [times[-1] * n / sizes[-1] for n in sizes], "--", color=palette.faint)
        axes.set_ylim(bottom=low)
        for axis in (axes.xaxis, axes.yaxis):
            name_decades(axis, plain)
        axes.set_title(
            "A check of N bodies: time and memory\n"
            f"From 1,000 bodies on the time grows as N^{steep:.2f}"
        )
        axes.legend(["MiB", "CPU seconds", "CPU seconds, if proportional"], loc="upper left")
    return figure


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", default=",".join(map(str, SIZES)))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--svg", type=Path)
    options = parser.parse_args()
    compileall.compile_dir(sysconfig.get_path("platlib"), quiet=2, workers=1)
    sizes = [int(size) for size in options.sizes.split(",")]
    runs = measure(sizes, options.rounds)
    large = [size for size in sizes if size >= 1000] or sizes
    steep = slope(large, [runs[size].cpu for size in large]) if len(large) > 1 else math.nan
    sys.stdout.write(f"{table(runs)}\n\nCPU time grows as N^{steep:.2f} from {large[0]:,} on.\n")
    if options.svg:
        write_both(options.svg, lambda dark: draw(runs, steep, dark=dark))


if __name__ == "__main__":
    main()
