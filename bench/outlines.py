"""Flat outlines beside shapely, Box2D, Chipmunk and parry2d: overlap, depth, distance.

    pip install shapely pyb2d3 pymunk
    (cd bench/peers/parry && cargo build --release)
    python -m bench.outlines [--pairs 200] [--rounds 5]

Every library answers all pairs of a set in native code: satcheck as a batch on one thread, shapely by
its arrays, Box2D and Chipmunk from a loop in C (which needs gcc), parry2d from a loop in Rust. Box2D takes
at most 8 corners. shapely has no depth, Chipmunk no distance. All take turns in every round; the least
CPU time counts. What is made before the first question is free for all.

The truth comes from rational arithmetic on the same coordinates, without any tolerance. An overlap
is wrong if the interiors meet and the library says no, or the other way round. A figure is wrong if
it is off by more than a millionth of the size. What is not installed is left out and said so.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np

from bench.outline_pairs import PairSet, concave_sets, convex_sets
from bench.outline_peers import Floats, Query, concave_peers, convex_peers, missing

# Box2D has coordinates of 24 bits.
WRONG = 1e-6


def truth_of(pairs: PairSet, query: Query) -> Floats:
    if query == "overlap":
        return (pairs.signed < 0).astype(np.float64)
    return np.maximum(pairs.signed if query == "distance" else -pairs.signed, 0)


def rows_of(pairs: PairSet, rounds: int) -> list[str]:
    peers = list((convex_peers if pairs.convex else concave_peers)(pairs.pairs))
    rows = []
    for query in ("overlap", "depth", "distance"):
        asked = {name: ask for name, ask, queries in peers if query in queries}
        truth = truth_of(pairs, query)
        best, wrong = dict.fromkeys(asked, np.inf), dict.fromkeys(asked, 0)
        for _ in range(rounds):
            for name, ask in asked.items():
                spent, figures = ask(query)
                best[name] = min(best[name], spent / len(truth))
                wrong[name] = int((~(np.abs(figures - truth) <= WRONG)).sum())
        cells = [f"{name} {best[name]:.0f} / {wrong[name]}" for name in asked]
        if asked:
            rows.append(f"| {pairs.title} | {query} | " + " | ".join(cells) + " |")
    return rows


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    for name in missing():
        sys.stderr.write(f"{name}: not installed, left out\n")
    rng = np.random.default_rng(1)
    sets = convex_sets(rng, options.pairs) + concave_sets(rng, max(options.pairs // 5, 5))
    for pairs in sets:
        meet = int((pairs.signed < 0).sum())
        sys.stdout.write(f"\n{pairs.title}: {len(pairs.pairs)} pairs, {meet} overlap\n\n")
        sys.stdout.write("\n".join(rows_of(pairs, options.rounds)) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
