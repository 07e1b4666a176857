"""Time and memory of `satcheck SCENE` against the number of bodies, at constant density.

    python -m bench.scene_size [--sizes 100,300,1000] [--rounds 3] [--svg docs/scene_size.svg]

Scenes come from scene_of.py; whole processes, verdicts only, report as JSON, as in scenes.py. The
sizes alternate in every round, least figures count. Prints a table with the slope between sizes in
a log-log plot (1: linear in the number of bodies) and writes the plot: CPU seconds and MiB.
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

from bench.drawing import LogAxis, plain, text
from bench.scenes import Run, ask_satcheck

SIZES = (100, 300, 1000, 3000, 10_000, 30_000, 100_000)
WIDTH, HEIGHT = 660, 400
LEFT, RIGHT, TOP, BOTTOM = 64, 620, 44, 346
# Middle tones: readable on white and on black.
TIME, MEMORY, INK = "#2a7fde", "#d9711c", "#808080"
GRID = f'stroke="{INK}" stroke-opacity="0.3"'
FONT = f'font-family="system-ui, sans-serif" font-size="13" fill="{INK}"'


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


def curve(points: Sequence[tuple[float, float]], colour: str) -> str:
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    dots = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour}"/>' for x, y in points)
    line = f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2.5"/>'
    return line + dots


def grid(x: LogAxis, y: LogAxis) -> list[str]:
    parts = []
    for value in y.decades:
        at = y.at(value)
        parts.append(f'<path d="M{LEFT} {at:.1f}H{RIGHT}" {GRID}/>')
        parts.append(text(LEFT - 8, at + 4, plain(value)))
    for value in x.decades:
        at = x.at(value)
        parts.append(f'<path d="M{at:.1f} {TOP}V{BOTTOM}" {GRID}/>')
        parts.append(text(at, BOTTOM + 20, plain(value), "middle"))
    return parts


def proportional(runs: dict[int, Run], x: LogAxis, y: LogAxis) -> str:
    """The dashed line through the last time, as far as it is within the picture."""
    last = max(runs)
    points = [(x.at(size), y.at(runs[last].cpu * size / last)) for size in runs]
    path = " ".join(f"{a:.1f},{b:.1f}" for a, b in points if b <= BOTTOM)
    return f'<polyline points="{path}" fill="none" stroke="{INK}" stroke-dasharray="5 5"/>'


def picture(runs: dict[int, Run], steep: float) -> str:
    """Both curves over one axis of numbers: CPU seconds and MiB."""
    values = [v for one in runs.values() for v in (one.cpu, float(one.mebibytes))]
    low, high = 10 ** math.floor(math.log10(min(values))), 10 ** math.ceil(math.log10(max(values)))
    x = LogAxis(min(runs), max(runs), LEFT, RIGHT)
    y = LogAxis(low, high, BOTTOM, TOP)
    times = [(x.at(size), y.at(one.cpu)) for size, one in runs.items()]
    memory = [(x.at(size), y.at(one.mebibytes)) for size, one in runs.items()]
    title = (
        f'<text x="{LEFT}" y="24">A check of N bodies: '
        f'<tspan fill="{TIME}">CPU seconds</tspan>, <tspan fill="{MEMORY}">MiB</tspan>. '
        f"From 1,000 bodies on the time grows as N^{steep:.2f}</text>"
    )
    foot = text(RIGHT, BOTTOM + 42, "bodies; dashed: linear")
    parts = [*grid(x, y), proportional(runs, x, y), curve(memory, MEMORY), curve(times, TIME)]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        f'{FONT} role="img"><title>Time and memory against the number of bodies</title>'
        f"{''.join(parts)}{title}{foot}</svg>\n"
    )


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
        options.svg.write_text(picture(runs, steep), encoding="utf-8")


if __name__ == "__main__":
    main()
