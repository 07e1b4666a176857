"""What accuracy costs in time, over a corpus: every rung of the ladder on every pair, as a page.

    python -m bench.accuracy_vs_time CORPUS... --results FILE.jsonl [--page docs/x.md]

CORPUS: a pair file (as of bench/depth_interval.py), the index of sample_meshes, a folder with one
of them, or a folder of meshes (every two). --pair A B: two files besides.
"""

from __future__ import annotations

import argparse
import compileall
import sys
import sysconfig
from pathlib import Path

from bench.accuracy import corpus, runs
from bench.accuracy.case import Effort


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpora", nargs="+", type=Path, metavar="CORPUS")
    parser.add_argument("--pair", nargs=2, type=Path, action="append", default=[])
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--rung-seconds", type=float, default=10.0)
    parser.add_argument("--pair-seconds", type=float, default=30.0)
    options = parser.parse_args()
    effort = Effort(options.repeat, options.rung_seconds, options.pair_seconds)
    cases = [case for path in options.corpora for case in corpus.read(path).cases]
    cases += [corpus.given((a, b)) for a, b in options.pair]
    compileall.compile_dir(sysconfig.get_path("platlib"), quiet=2, workers=1)
    runs.measure_all(cases, effort, options.results, say)


if __name__ == "__main__":
    main()
