"""The convex narrow phase on a folder of pair files: answers to judge, and nanoseconds per query.

    python bench/convex_pairs.py FOLDER [W1 W2_12 ...] [--dump OUT] [--rounds 5] [--json FILE]

FOLDER holds NAME.pairs (CVXPAIR1, below) and NAME.ref. Every pair is asked "overlap"; overlapping
pairs (by the reference) "depth", the others "distance". Printed per file: wrong booleans, answers
off by more than 1e-9 of the size, undecided pairs (exactly touching pairs have no right boolean and
are left out), and CPU time per query on one thread: the fastest of the rounds.

CVXPAIR1, little endian: char[8] "CVXPAIR1"; u32 shapes, pairs, 0, 0; per shape u32 kind (0 box,
1 hull), vertices, faces, indices; f64 half[3]; f64 vertices[][3]; u32 face_offset[faces + 1];
u32 face_vertex[indices]; per pair u32 a, b; f64 pose_a[7], pose_b[7], a pose being tx ty tz qx qy
qz qw. Reference: per pair f64 signed distance, normal[3], point_a[3], point_b[3], L (mean extent of
the two shapes), certificate.

--dump writes OUT/NAME.satcheck.bin, 96 bytes a pair: i32 overlap (1, 0, -1 undecided), status,
has_answer, 0; f64 signed distance, normal[3], point_a[3], point_b[3].
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from satcheck import core

REFERENCE = np.dtype(
    [("sd", "<f8"), ("n", "<f8", 3), ("pa", "<f8", 3), ("pb", "<f8", 3), ("L", "<f8"), ("c", "<f8")]
)
DUMP = np.dtype(
    [
        ("ov", "<i4"),
        ("status", "<i4"),
        ("has", "<i4"),
        ("pad", "<i4"),
        ("sd", "<f8"),
        ("n", "<f8", 3),
        ("pa", "<f8", 3),
        ("pb", "<f8", 3),
    ]
)
PAIR = np.dtype([("a", "<u4"), ("b", "<u4"), ("pose_a", "<f8", 7), ("pose_b", "<f8", 7)])
MAGIC = b"CVXPAIR1"

# Below this part of L the reference itself cannot tell a touch from an overlap.
TOUCHING = 1e-13
# The promise that is judged, as a part of L.
PRECISION = 1e-9

Query = Literal["overlap", "depth", "distance"]
NUMBERS: tuple[Query, ...] = ("depth", "distance")


@dataclass(frozen=True, slots=True)
class PairFile:
    """Shapes, pairs (PAIR rows) and their reference (REFERENCE rows)."""

    shapes: list[Any]
    pairs: NDArray[Any]
    reference: NDArray[Any]

    def ask(self, rows: NDArray[np.intp], query: Query) -> Any:
        p = self.pairs[rows]
        return core.check_pairs(
            self.shapes,
            np.ascontiguousarray(p["a"]),
            np.ascontiguousarray(p["b"]),
            np.ascontiguousarray(p["pose_a"]),
            np.ascontiguousarray(p["pose_b"]),
            query=query,
            threads=1,
        )


@dataclass(frozen=True, slots=True)
class RawShape:
    """half: of a box, else None. vertices (n, 3); faces: vertex numbers, counter-clockwise."""

    half: tuple[float, float, float] | None
    vertices: NDArray[np.float64]
    faces: list[NDArray[np.uint32]]


def read_shapes(path: Path) -> tuple[list[RawShape], NDArray[Any]]:
    """The shapes of a pair file, and its PAIR rows."""
    data = path.read_bytes()
    if data[:8] != MAGIC:
        raise ValueError(f"{path}: not a {MAGIC.decode()} file")
    shape_count, pair_count = np.frombuffer(data, "<u4", 2, 8)
    at = 24
    shapes = []
    for _ in range(int(shape_count)):
        kind, vertices, faces, indices = (int(n) for n in np.frombuffer(data, "<u4", 4, at))
        half = tuple(np.frombuffer(data, "<f8", 3, at + 16).tolist())
        points = np.frombuffer(data, "<f8", 3 * vertices, at + 40).reshape(-1, 3)
        at += 40 + 24 * vertices
        offsets = np.frombuffer(data, "<u4", faces + 1, at)
        at += 4 * (faces + 1)
        polygons = np.split(np.frombuffer(data, "<u4", indices, at), offsets[1:-1])
        at += 4 * indices
        shapes.append(RawShape(half if kind == 0 else None, points.copy(), polygons))
    return shapes, np.frombuffer(data, PAIR, int(pair_count), at)


def read_pair_file(path: Path) -> PairFile:
    shapes, pairs = read_shapes(path)
    return PairFile(
        [core.Box(s.half) if s.half else core.Hull(s.vertices) for s in shapes],
        pairs,
        np.fromfile(path.with_suffix(".ref"), REFERENCE),
    )


def split(file: PairFile) -> dict[Query, NDArray[np.intp]]:
    """Row numbers by query: all, the overlapping, the others."""
    overlapping = file.reference["sd"] < 0
    return {
        "overlap": np.arange(len(file.pairs)),
        "depth": np.flatnonzero(overlapping),
        "distance": np.flatnonzero(~overlapping),
    }


def answers(file: PairFile) -> NDArray[Any]:
    """One DUMP row per pair."""
    dump = np.zeros(len(file.pairs), DUMP)
    rows = split(file)
    outcome = np.asarray(file.ask(rows["overlap"], "overlap").outcome)
    names = np.array(core.OUTCOMES)[outcome]
    dump["ov"] = np.where(names == "undecided", -1, names == "penetrating")
    for query in NUMBERS:
        result = file.ask(rows[query], query)
        for name, column in (
            ("sd", result.distance),
            ("n", result.normal),
            ("pa", result.witness_a),
            ("pb", result.witness_b),
        ):
            dump[name][rows[query]] = column
        dump["has"][rows[query]] = 1
    return dump


def judge(file: PairFile, dump: NDArray[Any]) -> dict[str, Any]:
    """Counts and row numbers of what is wrong, lengths as parts of L."""
    reference = file.reference
    clear = np.abs(reference["sd"]) > TOUCHING * reference["L"]
    overlapping = reference["sd"] < 0
    wrong = clear & (dump["ov"] >= 0) & ((dump["ov"] == 1) != overlapping)
    error = np.abs(dump["sd"] - reference["sd"]) / reference["L"]
    off = clear & ~(error <= PRECISION)
    undecided = clear & (dump["ov"] < 0)
    return {
        "pairs": len(reference),
        "touching": int((~clear).sum()),
        "wrong": np.flatnonzero(wrong).tolist(),
        "off": np.flatnonzero(off).tolist(),
        "undecided": np.flatnonzero(undecided).tolist(),
        "largest_error": float(error[clear].max(initial=0.0)),
    }


def nanoseconds(file: PairFile, rounds: int) -> dict[str, float]:
    """CPU time per query on one thread, the fastest of the rounds."""
    out: dict[str, float] = {}
    for query, rows in split(file).items():
        if len(rows) == 0:
            continue
        best = float("inf")
        for _ in range(rounds):
            start = time.process_time_ns()
            file.ask(rows, query)
            best = min(best, (time.process_time_ns() - start) / len(rows))
        out[query] = best
    return out


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", help="files to run; default all, in name order")
    parser.add_argument("--dump", type=Path, help="folder for the answers")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--json", type=Path, help="file for counts, row numbers and times")
    options = parser.parse_args()
    names = options.names or sorted(path.stem for path in options.folder.glob("*.pairs"))
    report: dict[str, Any] = {}
    out = sys.stdout
    out.write("file      pairs  wrong  >1e-9  undecided  largest error   ")
    out.write("ns: overlap  depth  distance\n")
    for name in names:
        file = read_pair_file(options.folder / f"{name}.pairs")
        dump = answers(file)
        if options.dump:
            options.dump.mkdir(parents=True, exist_ok=True)
            dump.tofile(options.dump / f"{name}.satcheck.bin")
        result = judge(file, dump) | {"ns": nanoseconds(file, options.rounds)}
        report[name] = result
        ns = result["ns"]
        out.write(
            f"{name:8s} {result['pairs']:6d} {len(result['wrong']):6d} {len(result['off']):6d} "
            f"{len(result['undecided']):10d} {result['largest_error']:14.1e} "
            f"{ns.get('overlap', 0):13.0f} {ns.get('depth', 0):6.0f} {ns.get('distance', 0):9.0f}\n"
        )
        out.flush()
    if options.json:
        options.json.write_text(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
