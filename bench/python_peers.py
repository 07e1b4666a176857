"""Convex pairs from Python: our batch beside the Python interfaces of other libraries.

    pip install '.[peers]'
    python -m bench.python_peers FOLDER [W1 W2_12 ...] [--pairs 400] [--rounds 3]

FOLDER holds pair files and references (convex_pairs.py says which form they have). Of each file so
many pairs, evenly spread, are asked for overlap and for the signed distance. satcheck answers them
in one call of `core.check_pairs` on one thread, and one by one with `core.check_pair`; the others
have no call for many. Shapes are made, and where the interface has placements these too, before the
clock runs. All take turns in every round; the least CPU time counts. Judged by the reference:
pairs closer to touching than it can tell are left out. Prints two tables of nanoseconds a pair:
overlap with the number of wrong answers, signed distance with the share off by more than 1e-9 of
the size, and by more than 1e-6; "aborts": the library ended its process. What is not installed is
left out and said so. Not for Windows.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import sys
import time
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.convex_pairs import PRECISION, REFERENCE, TOUCHING, RawShape, read_shapes
from bench.peers.python_api import PEERS, Peer
from satcheck import core

COARSE = 1e-6
PENETRATING = core.OUTCOMES.index("penetrating")

# All pairs at once: booleans, or signed distances.
Ask = Callable[[], NDArray[Any]]


def one_by_one(ask: Callable[[int], Any], count: int) -> Ask:
    return lambda: np.array([ask(i) for i in range(count)])


def satcheck(shapes: Sequence[RawShape], pairs: NDArray[Any]) -> dict[str, tuple[Ask, Ask]]:
    made: list[Any] = [core.Box(s.half) if s.half else core.Hull(s.vertices) for s in shapes]
    arrays = [np.ascontiguousarray(pairs[name]) for name in ("a", "b", "pose_a", "pose_b")]

    def overlaps() -> NDArray[Any]:
        found = core.check_pairs(made, *arrays, query="overlap", threads=1)
        return np.asarray(found.outcome == PENETRATING)

    def distances() -> NDArray[Any]:
        return core.check_pairs(made, *arrays, query="depth", threads=1).distance

    singles = [
        (made[p["a"]], made[p["b"]], p["pose_a"].tolist(), p["pose_b"].tolist()) for p in pairs
    ]

    def overlap(i: int) -> bool:
        return core.check_pair(*singles[i], query="overlap").outcome == "penetrating"

    def distance(i: int) -> float:
        found = core.check_pair(*singles[i], query="depth").distance
        return float("nan") if found is None else found

    return {
        "satcheck, batch": (overlaps, distances),
        "satcheck, one by one": (
            one_by_one(overlap, len(pairs)),
            one_by_one(distance, len(pairs)),
        ),
    }


def others(
    names: Sequence[str], shapes: Sequence[RawShape], pairs: NDArray[Any]
) -> dict[str, tuple[Ask, Ask]]:
    asked = {}
    for name in names:
        peer: Peer = PEERS[name][1](shapes, pairs)
        asked[f"{name} {version(name)}"] = (
            one_by_one(peer.overlap, len(pairs)),
            one_by_one(peer.distance, len(pairs)),
        )
    return asked


def share(part: float) -> str:
    return "0" if part == 0 else f"{part:.1%}" if part < 1 else "all"


def survives(asks: tuple[Ask, Ask]) -> bool:
    """Whether a library answers all pairs without an end of its process, tried in a child."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            for ask in asks:
                ask()
            code = 0
        finally:
            os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def cells(
    asked: dict[str, tuple[Ask, Ask]], reference: NDArray[Any], rounds: int
) -> dict[str, tuple[str, str]]:
    """For each library what it costs and gets wrong, as text: overlap and signed distance."""
    texts = dict.fromkeys(asked, ("aborts", "aborts"))
    asked = {name: asks for name, asks in asked.items() if survives(asks)}
    best = {name: [np.inf, np.inf] for name in asked}
    answers: dict[str, list[NDArray[Any]]] = {name: [np.empty(0)] * 2 for name in asked}
    for _ in range(rounds):
        for name, asks in asked.items():
            for k, ask in enumerate(asks):
                start = time.process_time_ns()
                answers[name][k] = ask()
                spent = (time.process_time_ns() - start) / len(reference)
                best[name][k] = min(best[name][k], spent)
    clear = np.abs(reference["sd"]) > TOUCHING * reference["L"]
    for name, (overlap, distance) in answers.items():
        wrong = int((clear & (overlap != (reference["sd"] < 0))).sum())
        error = np.abs(distance - reference["sd"])[clear] / reference["L"][clear]
        fine, coarse = (float((~(error <= limit)).mean()) for limit in (PRECISION, COARSE))
        off = f"{share(fine)}, {share(coarse)}"
        texts[name] = f"{best[name][0]:.0f} / {wrong}", f"{best[name][1]:.0f} ({off})"
    return texts


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", help="files to run; default all, in name order")
    parser.add_argument("--pairs", type=int, default=400)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    files = options.names or sorted(path.stem for path in options.folder.glob("*.pairs"))
    installed = [name for name, (module, _) in PEERS.items() if importlib.util.find_spec(module)]
    for name in set(PEERS) - set(installed):
        sys.stderr.write(f"{name}: not installed, left out\n")
    columns: dict[str, dict[str, tuple[str, str]]] = {}
    for file in files:
        path = options.folder / f"{file}.pairs"
        shapes, pairs = read_shapes(path)
        rows = np.unique(np.linspace(0, len(pairs) - 1, options.pairs).astype(int))
        chosen, reference = pairs[rows], np.fromfile(path.with_suffix(".ref"), REFERENCE)[rows]
        asked = satcheck(shapes, chosen) | others(installed, shapes, chosen)
        columns[file] = cells(asked, reference, options.rounds)
    for k, title in enumerate(
        ("overlap: ns / wrong", "signed distance: ns (off by > 1e-9, > 1e-6)")
    ):
        lines = [f"| {title} | {' | '.join(files)} |", "|---" * (len(files) + 1) + "|"]
        for name in columns[files[0]]:
            lines.append(f"| {name} | {' | '.join(columns[file][name][k] for file in files)} |")
        sys.stdout.write("\n".join(lines) + "\n\n")


if __name__ == "__main__":
    main()
