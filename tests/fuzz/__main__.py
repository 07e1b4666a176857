"""The fuzz run: `python -m tests.fuzz --pairs random=10000000 near=1000000 [--seed 0] [--from 0]`.

Batches of 4,096 pairs, each made from (seed, share, number) alone: a run can be cut off and resumed
with --from, or one batch repeated. Every pair is asked for overlap, depth and distance, swapped,
reordered, scaled and moved; a sample of each batch is judged in rationals. Contradictions are
printed with what makes them again; `--show SHARE NUMBER ROW` prints such a pair, `--shrink` a
smaller one with the same contradiction. Exit code 1 when there was one.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from satcheck import core
from tests.fuzz.invariants import against_truth, contradictions, sample
from tests.fuzz.pairs import PAIRS, SHARES, Batch, Share, make_batch
from tests.fuzz.shrink import contradictions_of, shrunk

PRINTED = 5  # contradictions of one batch and question


@dataclass(slots=True)
class Tally:
    pairs: int = 0
    judged: int = 0
    seconds: float = 0.0
    outcomes: Counter[str] = field(default_factory=Counter)
    contradictions: Counter[str] = field(default_factory=Counter)

    def line(self, share: str) -> str:
        outcomes = ", ".join(f"{n} {name}" for name, n in sorted(self.outcomes.items()))
        found = ", ".join(f"{n} {what}" for what, n in self.contradictions.items()) or "none"
        return (
            f"{share}: {self.pairs} pairs ({outcomes}), {self.judged} of them in rationals, "
            f"{self.seconds:.0f} s CPU; contradictions: {found}"
        )


def run_batch(share: Share, seed: int, number: int, judged: int, tally: Tally) -> None:
    start = time.process_time()
    batch = make_batch(share, seed, number)
    rng = np.random.default_rng([seed, SHARES.index(share), number, 1])
    checks = [*contradictions(batch, rng)]
    if not batch.curved:
        rows = sample(batch, judged, rng)
        checks += against_truth(batch, rows)
        tally.judged += len(rows)
    for what, failed in checks:
        rows = np.flatnonzero(failed)
        if len(rows):
            tally.contradictions[what] += len(rows)
            for row in rows[:PRINTED]:
                say(f"{share} {number} {row} (seed {seed}, {batch.name}): {what}")
    for code, count in Counter(np.asarray(batch.ask("overlap").outcome).tolist()).items():
        tally.outcomes[core.OUTCOMES[code]] += count
    tally.pairs += PAIRS
    tally.seconds += time.process_time() - start


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def show(pair: Batch) -> None:
    """A pair: the first row of the batch."""
    i, j = int(pair.index_a[0]), int(pair.index_b[0])
    say(pair.name)
    for shapes, k in ((pair.a, i), (pair.b, j)):
        made_of = shapes.points[k].tolist() if shapes.points else shapes.parameters[k]
        say(f"{shapes.kind} {made_of}")
    say(f"{pair.pose_a[0].tolist()}\n{pair.pose_b[0].tolist()}")
    for what, question in (("pair", pair), ("swapped", pair.swapped())):
        for query in ("overlap", "depth", "distance"):
            say(f"{what} {query} {question.ask(query)[0]}")


def shrink(pair: Batch) -> None:
    found = contradictions_of(pair)
    if not found:
        say("it contradicts nothing")
        return
    say(f"{', '.join(sorted(found))}, of which the first stays:")
    first = min(found)
    show(shrunk(pair, lambda smaller: first in contradictions_of(smaller)))


def main() -> int:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--pairs", nargs="+", default=["random=100000", "near=10000"])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--from", type=int, default=0, dest="first", help="number of the first batch"
    )
    parser.add_argument("--judged", type=int, default=4, help="pairs of a batch in rationals")
    for option in ("--show", "--shrink"):
        parser.add_argument(option, nargs=3, metavar=("SHARE", "NUMBER", "ROW"))
    options = parser.parse_args()
    if options.show or options.shrink:
        share, number, row = options.show or options.shrink
        pair = make_batch(share, options.seed, int(number)).rows(np.array([int(row)]))
        (show if options.show else shrink)(pair)
        return 0
    found = 0
    for share, pairs in (request.split("=") for request in options.pairs):
        tally = Tally()
        batches = -(-int(pairs) // PAIRS)
        for number in range(options.first, options.first + batches):
            run_batch(share, options.seed, number, options.judged, tally)
            if (number + 1) % 100 == 0:
                say(f"to batch {number}: {tally.line(share)}")
        say(tally.line(share))
        found += tally.contradictions.total()
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
