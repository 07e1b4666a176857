"""Flat outlines beside shapely, Box2D, Chipmunk and parry2d: overlap, depth, distance.

    pip install shapely pyb2d3 pymunk
    (cd bench/peers/parry && cargo build --release)
    python -m bench.outlines [--pairs 1000] [--rounds 5]

Every library answers all pairs of a set in native code: satcheck as a batch on one thread, shapely
by its arrays, Box2D and Chipmunk from a loop in C (which needs gcc), parry2d from a loop in Rust.
Concave outlines are asked one by one from Python, as prisms. Box2D takes at most 8 corners. shapely
has no depth, Chipmunk no distance. Depth is asked of pairs that overlap, distance of the others.
All take turns in every round and are asked twice in it. The second time counts, as CPU time; of all
rounds the least. What is made before the first question, or at it, is free for all.

The truth comes from rational arithmetic on the same coordinates, without any tolerance. An overlap
is wrong if the interiors meet and the library says no, or the other way round. A figure is wrong if
it is off by more than a millionth of the size. What is not installed is left out and said so.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np
from numpy.typing import NDArray

from bench.outline_pairs import PairSet, concave_sets, convex_sets, loops_of
from bench.outline_peers import Floats, Query, concave_peers, convex_peers, missing

# Box2D has coordinates of 24 bits.
WRONG = 1e-6
NAMES = ("satcheck", "shapely", "Box2D", "Chipmunk", "parry2d")


def truth_of(pairs: PairSet, query: Query) -> Floats:
    if query == "overlap":
        return (pairs.signed < 0).astype(np.float64)
    return np.maximum(pairs.signed if query == "distance" else -pairs.signed, 0)


def rows_of(pairs: PairSet, rounds: int) -> list[str]:
    rows = []
    meet = pairs.signed < 0
    asked: tuple[tuple[Query, NDArray[np.bool_]], ...]
    asked = (("overlap", meet | True), ("depth", meet), ("distance", ~meet))
    for query, chosen in asked:
        if chosen.any():
            rows += row_of(chosen_of(pairs, chosen), query, rounds)
    return rows


def chosen_of(pairs: PairSet, chosen: NDArray[np.bool_]) -> PairSet:
    some = [pairs.pairs[k] for k in np.flatnonzero(chosen)]
    return PairSet(pairs.title, some, pairs.signed[chosen], pairs.convex)


def row_of(pairs: PairSet, query: Query, rounds: int) -> list[str]:
    peers = (convex_peers if pairs.convex else concave_peers)(pairs.pairs)
    size = max(np.abs(loop).max() for pair in pairs.pairs for o in pair for loop in loops_of(o))
    asked = {name: ask for name, ask, queries in peers if query in queries}
    truth = truth_of(pairs, query)
    best, wrong = dict.fromkeys(asked, np.inf), dict.fromkeys(asked, 0)
    for _ in range(rounds):
        for name, ask in asked.items():
            ask(query)  # brings its data into the cache
            spent, figures = ask(query)
            best[name] = min(best[name], spent / len(truth))
            wrong[name] = int((~(np.abs(figures - truth) <= WRONG * size)).sum())
    cells = [f"{best[name]:.0f} / {wrong[name]}" if name in asked else "-" for name in NAMES]
    return [f"| {pairs.title} | {query}, {len(truth)} | " + " | ".join(cells) + " |"] * bool(asked)


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=1000)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    for name in missing():
        sys.stderr.write(f"{name}: not installed, left out\n")
    rng = np.random.default_rng(1)
    sets = convex_sets(rng, options.pairs) + concave_sets(rng, max(options.pairs // 25, 5))
    out = sys.stdout.write
    out(f"| ns / wrong | query, pairs | {' | '.join(NAMES)} |\n|{'---|' * (2 + len(NAMES))}\n")
    for pairs in sets:
        out("".join(f"{row}\n" for row in rows_of(pairs, options.rounds)))
        sys.stdout.flush()


if __name__ == "__main__":
    main()
