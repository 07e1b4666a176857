"""satcheck beside ifcclash on IFC files: time and memory of fresh processes, and each difference.

    python -m bench.ifc FILE ... [--rounds 3]      # pip install ifcclash

Both read the file with IfcOpenShell, make the shapes with its OpenCascade kernel at the same
deflection, and look for pairs that overlap; ifcclash on all cores, as its command does. The
programs take turns. For the differences satcheck is asked once more, with volumes by manifold3d,
which neither program uses to decide.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from msgspec import Struct

PEER = Path(__file__).parent / "peers" / "ask_ifcclash.py"
MODES = ("collision", "intersection")
OVERLAPS = frozenset(("penetrating", "contains", "inside", "coincident"))
POLL_SECONDS = 0.02
# Cubic metres. Below the first, the volume of an overlap is no more than rounding.
SLIVER, CUBIC_CENTIMETRE = 1e-9, 1e-6

Pair = frozenset[str]
Told = Mapping[Pair, Mapping[str, Any]]


class Run(Struct):
    """seconds: wall clock. cpu: seconds of all threads. mebibytes: the most that the processes held
    together."""

    seconds: float
    cpu: float
    mebibytes: int


def run(command: Sequence[str], out: Path, fine: Sequence[int]) -> Run:
    start, used = time.perf_counter(), cpu_of_children()
    most = 0
    with out.open("wb") as stream:
        child = subprocess.Popen(command, stdout=stream, stderr=subprocess.DEVNULL)
        while child.poll() is None:
            most = max(most, sum(map(mebibytes, tree_of(child.pid))))
            time.sleep(POLL_SECONDS)
    if child.returncode not in fine:
        raise RuntimeError(f"{command}: exit code {child.returncode}")
    return Run(time.perf_counter() - start, cpu_of_children() - used, most)


def cpu_of_children() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def tree_of(pid: int) -> Iterator[int]:
    """The process and those below it. One that ends meanwhile is left out."""
    yield pid
    with suppress(OSError):
        for thread in Path(f"/proc/{pid}/task").iterdir():
            for child in (thread / "children").read_text().split():
                yield from tree_of(int(child))


def mebibytes(pid: int) -> int:
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except (OSError, IndexError):
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE") >> 20


def satcheck(file: Path, folder: Path, *options: str) -> Run:
    """Leaves report.json in the folder."""
    report = ("--no-config", "--no-depth", "--surface-tolerance", "0", "--format", "json", *options)
    return run([sys.executable, "-m", "satcheck.cli", *report, str(file)], folder / "report.json",
               (0, 1, 3))  # fmt: skip


def told_by_satcheck(folder: Path) -> tuple[Told, dict[str, Any]]:
    report = json.loads((folder / "report.json").read_bytes())
    return {frozenset((f["a"], f["b"])): f for f in report["findings"]}, report


def compare(file: Path, folder: Path, peers: Mapping[str, set[Pair]]) -> Iterator[str]:
    """A line for each cause of differences."""
    satcheck(file, folder, "--volume")
    told, report = told_by_satcheck(folder)
    overlaps = {pair for pair, finding in told.items() if finding["relation"] in OVERLAPS}
    lost = {body["id"] for body in report["bodies"] if body["triangles"] is None}
    known = {body["id"] for body in report["bodies"]}
    counts = report["summary"]["pairs"]
    yield (
        f"  satcheck: {len(known)} bodies, {len(lost)} of them unreadable, {len(overlaps)} "
        f"overlaps, {counts['allowed']} pairs allowed"
    )
    for mode, pairs in peers.items():
        yield f"  ifcclash {mode}: {len(pairs)} pairs, {len(pairs & overlaps)} of both"
        only = Counter(_why_not_here(pair, told, lost, known) for pair in pairs - overlaps)
        for why, count in sorted(only.items()):
            yield f"    {count} of ifcclash only: {why}"
        missed = Counter(_what_is_there(told[pair]) for pair in overlaps - pairs)
        for why, count in sorted(missed.items()):
            yield f"    {count} of satcheck only: {why}"


def _why_not_here(pair: Pair, told: Told, lost: set[str], known: set[str]) -> str:
    if not pair <= known:
        return "an element that is no body of satcheck"
    if pair & lost:
        return "the kernel made no whole shape, so satcheck refuses to judge"
    if pair not in told:
        return "a relation of the file allows the pair"
    finding = told[pair]
    if finding["relation"] == "touching":
        return f"the overlap is within the precision of the file ({_figure(finding)})"
    return f"satcheck says {finding['relation']}"


def _what_is_there(finding: Mapping[str, Any]) -> str:
    if finding["relation"] in ("contains", "inside"):
        return "one body lies inside the other"
    if finding["relation"] == "coincident":
        return "two equal bodies in one place"
    return f"the bodies overlap ({_figure(finding)})"


def _figure(finding: Mapping[str, Any]) -> str:
    volume = finding["volume"]
    if volume is None:
        return "no volume: a body is open"
    if volume <= SLIVER:
        return "no volume"
    return "less than 1 cm3" if volume < CUBIC_CENTIMETRE else "1 cm3 or more"


def measure(file: Path, rounds: int) -> Iterator[str]:
    runs: dict[str, list[Run]] = {}
    with TemporaryDirectory() as name:
        folder = Path(name)
        peers: dict[str, set[Pair]] = {}
        for _ in range(rounds):
            runs.setdefault("satcheck", []).append(satcheck(file, folder))
            for mode in MODES:
                out = folder / f"{mode}.json"
                asked = [sys.executable, str(PEER), str(file), mode]
                runs.setdefault(f"ifcclash {mode}", []).append(run(asked, out, (0,)))
                peers[mode] = set(map(frozenset, json.loads(out.read_bytes())))
        own = runs["satcheck"]
        yield f"{file.name}"
        for title, each in runs.items():
            wall, cpu = (beside(each, own, key) for key in ("seconds", "cpu"))
            most = max(one.mebibytes for one in each)
            yield f"  {title}: {wall}, CPU {cpu}, {most} MiB"
        yield from compare(file, folder, peers)


def beside(runs: Sequence[Run], own: Sequence[Run], key: str) -> str:
    """The median, and that of the ratios to satcheck in the same round."""
    values = [getattr(each, key) for each in runs]
    ratios = [value / getattr(mine, key) for value, mine in zip(values, own, strict=True)]
    return f"{median(values):.2f} s ({median(ratios):.2f})"


def main(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args(arguments)
    for file in options.files:
        for line in measure(file, options.rounds):
            sys.stdout.write(line + "\n")
            sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
