"""Impacts of corners and edges that meet exactly: satcheck beside FCL's continuous collision.

    pip install '.[peers]'
    python -m bench.impacts [--rounds 20]

The pairs are those of `impact_pairs.py`, all moved along a line; the truth is rational
(`swept_truth.py`). The tolerance is 0: a touch is what the rounding of a pose may hide. Both ask
the same pairs in turn; what can be made before is free. Time is CPU time, the least of three.

Missed: bodies that come to overlap are not called a hit, or bodies that touch are called separate.
False: bodies that never overlap are called a hit, or bodies with a gap are called touching. Off:
the time of impact is wrong by more than 1e-3 of the motion, or outside of the proven interval.
Where the bodies only touch, or are off by 6e-14, both answers of FCL are right.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Sequence

import fcl
import trimesh
from msgspec import Struct

from bench.impact_judges import Answer, judge, judge_time
from bench.impact_pairs import ONE, ImpactPair, Pieces, impact_pairs
from bench.motions import ADVANCES, Case, by_fcl
from bench.swept_truth import Point
from satcheck.report.sweep import Sweep
from satcheck.scene.motion import Translation
from tests.audit.motion.pairs import pair_of, sweep
from tests.audit.shapes import Mesh

REPEATS = 3
KINDS = ("missed", "false", "undecided", "off")
PEER_KINDS = ("missed", "false", "off")  # FCL always gives an answer


class Row(Struct):
    """Of one family, and of one library in it."""

    pairs: int = 0
    seconds: float = 0.0
    wrong: dict[str, int] = {}

    def add(self, kind: str, seconds: float) -> None:
        self.pairs += 1
        self.seconds += seconds
        if kind:
            self.wrong[kind] = self.wrong.get(kind, 0) + 1

    def cells(self, kinds: Sequence[str]) -> str:
        counts = " / ".join(str(self.wrong.get(kind, 0)) for kind in kinds)
        return f"{1e3 * self.seconds / self.pairs:.2f} | {counts}"


def by_satcheck(pair: ImpactPair) -> Callable[[], Sweep]:
    a, b = mesh_of(pair.a), mesh_of(pair.b)
    is_sheet = len(a[1]) == 1
    placed = pair_of(a, b, depth=False, tolerance=0.0, allow_open=is_sheet)
    for body in (placed.a, placed.b):
        body.surface(), body.hull_shape()
    path = Translation(vector_of(pair.move))
    return lambda: sweep(placed, path, None)


def by_peer(pair: ImpactPair) -> Callable[[], Answer]:
    a, b = (trimesh.Trimesh(*mesh_of(pieces), process=False) for pieces in (pair.a, pair.b))
    case = Case(pair.family, a, Translation(vector_of(pair.move)), b, None)
    return by_fcl(case, fcl.CCDSolverType.CCDC_CONSERVATIVE_ADVANCEMENT, ADVANCES)


def mesh_of(pieces: Pieces) -> Mesh:
    """The surfaces of all pieces, one after the other."""
    points: list[Point] = []
    triangles: list[tuple[int, ...]] = []
    for piece in pieces:
        triangles += [tuple(k + len(points) for k in triangle) for triangle in piece.triangles]
        points += piece.points
    return [vector_of(p) for p in points], triangles


def vector_of(p: Point) -> tuple[float, float, float]:
    """Exact."""
    return p[0] / ONE, p[1] / ONE, p[2] / ONE


def measure(rounds: int) -> dict[str, tuple[Row, Row]]:
    rows: dict[str, tuple[Row, Row]] = defaultdict(lambda: (Row(), Row()))
    for pair in impact_pairs(rounds):
        ours, peer, truth = by_satcheck(pair), by_peer(pair), pair.truth()
        least = [math.inf, math.inf]
        for _ in range(REPEATS):
            start = time.process_time()
            found = ours()
            between = time.process_time()
            answer = peer()
            least[0] = min(least[0], between - start)
            least[1] = min(least[1], time.process_time() - between)
        row = rows[pair.family]
        row[0].add(judge(pair, truth, found), least[0])
        row[1].add(judge_time(pair, truth, answer), least[1])
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--rounds", type=int, default=20, help="random variants of each situation")
    rows = measure(parser.parse_args().rounds)
    ours_head, peer_head = (f"ms | {' / '.join(kinds)}" for kinds in (KINDS, PEER_KINDS))
    sys.stdout.write(f"| | pairs | satcheck, {ours_head} | FCL, {peer_head} |\n|---|{'---|' * 5}\n")
    for family, (ours, peer) in rows.items():
        cells = f"{ours.cells(KINDS)} | {peer.cells(PEER_KINDS)}"
        sys.stdout.write(f"| {family} | {ours.pairs} | {cells} |\n")


if __name__ == "__main__":
    main()
