"""satcheck on a folder of real files, and what other libraries say of what it lets pass.

    python -m bench.corpus FOLDER|LIST -o RUN.jsonl [--satcheck COMMAND] [--seed 0]
        [--files N] [--pairs N] [--jobs N]
    python -m bench.corpus --table RUN.jsonl [--before OLDER.jsonl]

Each file is checked alone (a scene, or its connected components), and against itself and another
file in the placements of `opinions/placing.py`, one process a pair. Of every pair that passes
(exit code 0) and every overlap python-fcl, manifold3d, winding numbers and triangles in rational
numbers are asked (`opinions/judge.py`). LIST: a text file with a path a line. The run goes to a
file of JSON lines, which a later call continues; the table is printed from it.
"""

from __future__ import annotations

import argparse
import json
import random
import shlex
import subprocess
import sys
import tempfile
import time
import zlib
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from bench.opinions.tables import table
from bench.peers.child import replies

Record = dict[str, Any]
NODES = frozenset((".glb", ".gltf", ".3mf"))
MESHES = frozenset((".obj", ".stl", ".stla", ".stlb", ".ply", ".off", ".dae", ".amf", *NODES))
ROBOTS = frozenset((".urdf",))
LARGEST = 20_000_000
SECONDS = 120.0
OVERLAPS = ("penetrating", "contains", "inside", "coincident")
# Depth is asked of one kind of pair: it costs most of the time.
DEPTH = "overlap"


def files_of(source: Path) -> list[Path]:
    """All files with a known ending below the folder, or those that a list names; by path."""
    known = MESHES | ROBOTS
    paths = (
        source.rglob("*")
        if source.is_dir()
        else map(Path, source.read_text(encoding="utf-8").splitlines())
    )
    return sorted(
        p
        for p in paths
        if p.suffix.lower() in known and p.is_file() and p.stat().st_size <= LARGEST
    )


def ask(command: Sequence[str], arguments: Sequence[str]) -> Record:
    """Exit code (None: out of time), seconds, traceback, and the report where there is one."""
    start = time.perf_counter()
    try:
        run = subprocess.run(
            [*command, "--format", "json", "--allow-outside", "--jobs", "1", *arguments],
            capture_output=True,
            timeout=SECONDS,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return {"exit": None, "seconds": SECONDS, "traceback": False, "error": "out of time"}
    seconds = round(time.perf_counter() - start, 3)
    words = run.stderr.decode(errors="replace")
    answer = {"exit": run.returncode, "seconds": seconds, "error": words[-500:]}
    answer["traceback"] = "Traceback (most recent" in words or "internal error" in words
    if run.stdout:
        answer["report"] = json.loads(run.stdout)
    return answer


def alone(command: Sequence[str], file: Path) -> Record:
    """The file as a scene: nodes, links or connected components."""
    ending = file.suffix.lower()
    how = [] if ending in NODES | ROBOTS else ["--split", "components"]
    answer = ask(command, ["--no-depth", *how, str(file)])
    report = answer.pop("report", None)
    if report is not None:
        answer["bodies"] = len(report["bodies"])
        answer["codes"] = sorted({issue["code"] for issue in report["issues"]})
        answer["verdict"] = report["summary"]["verdict"]
    return {"what": "file", "file": str(file), **answer}


def pair(command: Sequence[str], look: Record, kind: str) -> Record:
    """The file where it stands, and itself or its partner placed, both as if in metres: what a file
    states of its units would scale it once more."""
    files = [look["file"], look["other" if kind == "other" else "file"]]
    rows = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], look["pairs"][kind]
    bodies = [
        {"id": name, "mesh": file, "matrix": placed, "units": "m"}
        for name, file, placed in zip("ab", files, rows, strict=True)
    ]
    with tempfile.TemporaryDirectory() as scratch:
        scene = Path(scratch) / "pair.json"
        content = {"schema": "satcheck.scene/1", "units": "m", "bodies": bodies}
        scene.write_text(json.dumps(content), encoding="utf-8")
        answer = ask(command, ["--depth" if kind == DEPTH else "--no-depth", str(scene)])
    report = answer.pop("report", None)
    record = {"what": "pair", "file": files[0], "kind": kind, "files": files, "matrices": rows}
    if report is not None:
        record["health"] = [body.get("health") for body in report["bodies"]]
        record["codes"] = sorted({issue["code"] for issue in report["issues"]})
        for finding in report["findings"][:1]:
            named = ("relation", "quality", "undecided", "reason", "tolerance", "depth_bounds")
            record |= {key: finding.get(key) for key in named}
    return record | answer


def questions(records: Sequence[Record]) -> list[Record]:
    """Of the pairs that have a claim to be judged."""
    asked = []
    for record in records:
        if record["what"] != "pair" or "relation" not in record:
            continue
        claim = "pass" if record["exit"] == 0 else "alarm"
        if claim == "pass" or record["relation"] in OVERLAPS:
            asked.append({**record, "claim": claim, "tolerance": record["tolerance"] or 0.0})
    return asked


def partners(files: Sequence[Path], seed: int) -> list[Record]:
    """Each mesh file with another one, chosen by the seed."""
    meshes = [str(file) for file in files if file.suffix.lower() in MESHES]
    others = random.Random(seed).sample(meshes, len(meshes))
    return [{"file": a, "other": b} for a, b in zip(meshes, others, strict=True)]


def look_at(asked: Sequence[Record], seed: int) -> Iterator[Record]:
    """What `opinions/look.py` says of each file."""
    child = [sys.executable, "-m", "bench.opinions.look", str(seed)]
    answers = replies(child, (json.dumps(question) for question in asked), SECONDS)
    for question, reply in zip(asked, answers, strict=True):
        given = {"refused": reply} if reply in ("crash", "hang") else json.loads(reply)
        yield {"what": "look", **question, **given}


def chosen(records: Sequence[Record], seed: int, most: int | None) -> list[tuple[Record, str]]:
    """What was looked at, with the kinds of pairs to ask: in an order that the seed makes from each
    file and kind alone, so that a limit picks the same pairs in every run."""
    every = [(record, kind) for record in records for kind in record.get("pairs", {})]
    every.sort(key=lambda entry: zlib.crc32(f"{seed} {entry[1]} {entry[0]['file']}".encode()))
    return every[:most]


def measure(
    files: Sequence[Path],
    command: Sequence[str],
    seed: int,
    path: Path,
    *,
    pairs: int | None = None,
    jobs: int = 1,
) -> None:
    """Appends what is missing to the run at `path`. pairs: at most so many. jobs: processes."""
    done = {_key(record) for record in read_run(path)} if path.exists() else set()
    with path.open("a", encoding="utf-8") as out, ThreadPoolExecutor(jobs) as pool:

        def keep(record: Record) -> None:
            out.write(json.dumps(record) + "\n")
            out.flush()

        fresh = [file for file in files if ("file", str(file), None) not in done]
        for record in pool.map(lambda file: alone(command, file), fresh):
            keep(record)
        couples = partners(files, seed)
        unseen = [couple for couple in couples if ("look", couple["file"], None) not in done]
        for record in look_at(unseen, seed):
            keep(record)
        open_pairs = [
            (record, kind)
            for record, kind in chosen(read_run(path), seed, pairs)
            if ("pair", record["file"], kind) not in done
        ]
        for record in pool.map(lambda entry: pair(command, *entry), open_pairs):
            keep(record)
        asked = [
            question
            for question in questions(read_run(path))
            if ("opinion", question["file"], question["kind"]) not in done
        ]
        lines = (json.dumps(question) for question in asked)
        child = [sys.executable, "-m", "bench.opinions.judge"]
        for question, reply in zip(asked, replies(child, lines, SECONDS), strict=True):
            words = {"standing": "no answer", "words": reply}
            opinion = words if reply in ("crash", "hang") else json.loads(reply)
            named = {key: question[key] for key in ("file", "kind", "claim", "relation")}
            keep({"what": "opinion", **named, **opinion})


def _key(record: Record) -> tuple[str, str, str | None]:
    return record["what"], record["file"], record.get("kind")


def read_run(path: Path) -> list[Record]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("source", type=Path, nargs="?", help="a folder, or a list of paths")
    parser.add_argument("-o", "--output", type=Path, help="the run, as JSON lines")
    parser.add_argument("--satcheck", default="satcheck", help="the command that is measured")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--files", type=int, help="so many of the files, chosen by the seed")
    parser.add_argument("--pairs", type=int, help="so many of the pairs, chosen by the seed")
    parser.add_argument("--jobs", type=int, default=1, help="calls of satcheck at a time")
    parser.add_argument("--table", type=Path, help="print the table of this run, measure nothing")
    parser.add_argument("--before", type=Path, help="an older run to compare with")
    given = parser.parse_args()
    run = given.table or given.output
    if run is None:
        parser.error("-o or --table is missing")
    if given.table is None:
        if given.source is None:
            parser.error("a folder or a list is missing")
        files = files_of(given.source)
        if given.files is not None and given.files < len(files):
            files = sorted(random.Random(given.seed).sample(files, given.files))
        measure(
            files, shlex.split(given.satcheck), given.seed, run, pairs=given.pairs, jobs=given.jobs
        )
    before = read_run(given.before) if given.before else None
    sys.stdout.write(table(read_run(run), before))


if __name__ == "__main__":
    main()
