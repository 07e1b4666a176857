"""Two commits side by side: how many times the CPU time of OLD each row takes in NEW.

    python bench/compare.py OLD NEW [BENCH ...] [--rounds 7] [--wall] [--json FILE]

OLD, NEW: a commit, "." for the working tree, or the folder or the Python of an environment. A
commit is built once, into build/compare. The benches are those of the tree that this file lies in,
so both sides are measured by the same code and on the same files.

Each round measures each row on both sides, one right after the other, and the next round in the
other order. A ratio is that of one round: what slows the machine for longer slows both sides.
Printed are the medians, the median ratio and the ratios it lies between. A row is slower when the
ratios of all rounds are above 1.05, faster when all are below 0.95. Exit code 1: a row is slower,
fails, or its answers differ; 2: nothing was measured. Fewer than five rounds call nothing slower or
faster. Needs Linux or macOS.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from bench.comparison.benches import BENCHES  # noqa: E402
from bench.comparison.measuring import Row  # noqa: E402
from bench.comparison.ratios import (  # noqa: E402
    Clock,
    Line,
    judged,
    record,
    summary,
    table,
    turns,
)
from bench.comparison.sides import CannotCompare, Side, side_of  # noqa: E402

ROUNDS = 7


def chosen(names: Sequence[str]) -> list[str]:
    """All benches where none is named. Raises CannotCompare."""
    unknown = [name for name in names if name not in BENCHES]
    if unknown:
        raise CannotCompare(f"no bench {', '.join(unknown)}; there are: {', '.join(BENCHES)}")
    return list(names or BENCHES)


def measured(rows: Sequence[Row], sides: tuple[Side, Side], rounds: int) -> list[Line]:
    """A row that has failed is not asked again."""
    lines = [Line(row.bench, row.name) for row in rows]
    for round_ in range(rounds):
        for row, line in zip(rows, lines, strict=True):
            if not line.failures:
                progress(f"{round_ + 1}/{rounds} {row.bench}: {row.name}")
                for side in turns(round_):
                    line.outcomes[side].append(row.outcome(sides[side]))
    progress("")
    return lines


def progress(text: str) -> None:
    """One line of a terminal, written over again and again."""
    if sys.stderr.isatty():
        sys.stderr.write(f"\r\033[K{text}")
        sys.stderr.flush()


def main(arguments: Sequence[str] | None = None) -> int:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old", metavar="OLD")
    parser.add_argument("new", metavar="NEW")
    parser.add_argument("benches", nargs="*", metavar="BENCH", help=", ".join(BENCHES))
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--wall", action="store_true", help="ratios of wall time")
    parser.add_argument("--json", type=Path, help="file for every figure of every round")
    options = parser.parse_args(arguments)
    clock: Clock = "wall" if options.wall else "cpu"
    os.environ.pop("PYTHONPATH", None)  # or both sides could run the same satcheck
    try:
        names = chosen(options.benches)
        sides = side_of(options.old), side_of(options.new)
    except CannotCompare as error:
        sys.stderr.write(f"{error}\n")
        return 2
    with tempfile.TemporaryDirectory() as folder:
        rows = [
            Row(bench, name, measure)
            for bench in names
            for name, measure in BENCHES[bench](Path(folder)).items()
        ]
        lines = measured(rows, sides, options.rounds)
    sys.stdout.write(f"OLD {options.old}, NEW {options.new}\n\n{table(lines, clock)}\n\n")
    sys.stdout.write(summary(lines, clock) + "\n")
    if options.json:
        options.json.write_text(json.dumps([record(line) for line in lines], indent=1))
    found = judged(lines, clock)
    return int(any(found[what] for what in ("slower", "answers differ", "failed")))


if __name__ == "__main__":
    raise SystemExit(main())
