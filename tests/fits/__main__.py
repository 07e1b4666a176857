"""Checks flush fits: `python -m tests.fits [--fits 2000] [--interferences 500] [--seed 0]`.

A fit fails if it is not found to touch, an interference of three tolerances or more if it is not
an error. Each pair is made from (seed, number) alone: `--from 17 --fits 18 --keep FOLDER` repeats
the one of number 17, and keeps its files. Exit code 1 when one failed.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from tests.fits.run import Result, check_fit


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fits", type=int, default=2000)
    parser.add_argument("--interferences", type=int, default=500)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--from", dest="first", type=int, default=0)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--format")
    arguments = parser.parse_args()
    say(f"seed {arguments.seed}")
    failures = 0
    for question, count in (("fit", arguments.fits), ("interference", arguments.interferences)):
        tally: Counter[tuple[str, str]] = Counter()
        start = time.process_time()
        for number in range(arguments.first, count):
            with tempfile.TemporaryDirectory() as made:
                folder = arguments.keep or Path(made)
                folder.mkdir(exist_ok=True)
                result = check_fit(
                    folder, arguments.seed, number, question == "interference", arguments.format
                )
            tally[result.file_format, result.answer] += 1
            if not result.passes:
                failures += 1
                say(f"{question} {number}: {_line(result)}")
        total = sum(tally.values())
        seconds = time.process_time() - start
        say(f"{total} {question}s in {seconds:.0f} CPU s")
        for (file_format, answer), n in sorted(tally.items()):
            say(f"  {file_format:10} {n:5} {answer}")
    return min(failures, 1)


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def _line(result: Result) -> str:
    return f"{result.kind} in {result.file_format}: {result.answer}; {result.detail}"


if __name__ == "__main__":
    sys.exit(main())
