"""Damaged files through every reader: `python -m tests.fuzz.files [KIND ...] [--count 1000]`.

Each file is made from (seed, kind, number) alone. An error with a code is an answer; any other
exception, and a reader that takes too long, is a fault, printed with what makes the file again.
`--keep FOLDER` writes the files of all faults there. Exit code 1 when there was one.
"""

from __future__ import annotations

import argparse
import random
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from tests.fuzz.mutations import damaged
from tests.fuzz.readers import READERS, SAMPLES, attempt, name_of, seeds

LONGEST = 20  # seconds for one file, which take milliseconds


class TooSlow(Exception):
    """A reader that does not end."""


@contextmanager
def time_limit(seconds: int) -> Iterator[None]:
    def stop(_signal: int, _frame: FrameType | None) -> None:
        raise TooSlow

    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def file_of(kind: str, seed: int, number: int) -> bytes:
    rng = random.Random(f"{seed} {kind} {number}")
    return damaged(rng.choice(seeds(kind)), rng)


def workplace(folder: Path) -> Path:
    """A copy of the samples, for files that name others."""
    place = folder / "samples"
    shutil.copytree(SAMPLES, place)
    return place


def fault_of(kind: str, path: Path) -> tuple[str, str]:
    """(code of the answer, traceback of the fault); one of them is empty."""
    try:
        with time_limit(LONGEST):
            return attempt(kind, path), ""
    except Exception:  # noqa: BLE001  any exception is what this looks for
        return "", traceback.format_exc()


def run(kind: str, seed: int, first: int, count: int, keep: Path | None) -> int:
    """The number of faults."""
    codes: Counter[str] = Counter()
    faults: Counter[str] = Counter()
    start = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        path = workplace(Path(folder)) / name_of(kind)
        for number in range(first, first + count):
            content = file_of(kind, seed, number)
            path.write_bytes(content)
            code, fault = fault_of(kind, path)
            codes[code or "read"] += 1
            if fault:
                last = fault.strip().splitlines()[-1][:150]
                faults[last] += 1
                if faults[last] == 1:
                    say(f"{kind} {number} (seed {seed}):\n{fault}")
                    if keep is not None:
                        (keep / f"{kind}-{seed}-{number}-{path.name}").write_bytes(content)
    seconds = time.process_time() - start
    answers = ", ".join(f"{n} {code}" for code, n in codes.most_common())
    say(f"{kind}: {count} files, {seconds:.0f} s CPU, {faults.total()} faults; {answers}")
    return faults.total()


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz.files", description=__doc__)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(READERS))
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--from", type=int, default=0, dest="first")
    parser.add_argument("--keep", type=Path)
    options = parser.parse_args()
    kinds = options.kinds or list(READERS)
    where = options.seed, options.first, options.count, options.keep
    return int(sum(run(kind, *where) for kind in kinds) > 0)


if __name__ == "__main__":
    sys.exit(main())
