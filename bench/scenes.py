"""Scenes of many bodies: `satcheck SCENE` beside trimesh's CollisionManager, whole processes.

    python bench/scenes.py SCENE.json ... [--rounds 3]

Which pairs overlap, yes or no. Each round asks everybody once, one after the other, so that all see
the same machine: read the ratios. Start of the interpreter, imports, reading of the files and the
report are in it, byte-compiled. Needs trimesh and python-fcl (peers/ask_trimesh.py says how they
are asked), and Linux for the memory. Prints a table: medians of wall and CPU seconds, the most
memory of a process, the pairs found, and how many times satcheck's time that is.
"""

from __future__ import annotations

import argparse
import compileall
import json
import os
import subprocess
import sys
import sysconfig
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median

PEER = Path(__file__).resolve().parent / "peers" / "ask_trimesh.py"
OVERLAPS = ("penetrating", "contains", "inside", "coincident")
SATCHECK, RIGHT, WRONG = "satcheck", "trimesh, meshes transformed", "trimesh, meshes placed"


@dataclass(frozen=True, slots=True)
class Run:
    """One process: seconds of wall and CPU time, its peak memory, the pairs that it found."""

    wall: float
    cpu: float
    mebibytes: int
    pairs: int


def environment() -> dict[str, str]:
    return {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}


def run(command: list[str], fine: tuple[int, ...] = (0, 1)) -> tuple[float, float, int, bytes]:
    """Wall and CPU seconds and MiB of a fresh process, and its standard output.

    Raises RuntimeError, with its standard error, where the exit code is not among `fine`.
    """
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.perf_counter()
        child = subprocess.Popen(command, env=environment(), stdout=out, stderr=err)
        _, status, usage = os.wait4(child.pid, 0)
        wall = time.perf_counter() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        said = out.read()
        err.seek(0)
        complaint = err.read().decode(errors="replace")
    if child.returncode not in fine:
        raise RuntimeError(f"{command}: exit code {child.returncode}\n{complaint}".strip())
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss // 1024, said


def ask_satcheck(scene: Path, *options: str) -> Run:
    script = str(Path(sysconfig.get_path("scripts")) / "satcheck")
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [script, "--no-depth", "--format", "json", "-o", str(report), *options]
        wall, cpu, mebibytes, _ = run([*command, str(scene)])
        found = json.loads(report.read_text(encoding="utf-8"))["summary"]["by_relation"]
    return Run(wall, cpu, mebibytes, sum(found[name] for name in OVERLAPS))


def ask_trimesh(scene: Path, way: str) -> Run:
    wall, cpu, mebibytes, said = run([sys.executable, str(PEER), str(scene), way])
    return Run(wall, cpu, mebibytes, json.loads(said)["pairs"])


def measure(scene: Path, rounds: int) -> dict[str, list[Run]]:
    runs: dict[str, list[Run]] = {SATCHECK: [], RIGHT: [], WRONG: []}
    for _ in range(rounds):
        runs[SATCHECK].append(ask_satcheck(scene))
        runs[RIGHT].append(ask_trimesh(scene, "transformed"))
        runs[WRONG].append(ask_trimesh(scene, "placed"))
    return runs


def rows(name: str, runs: dict[str, list[Run]]) -> list[str]:
    wall = {who: median(one.wall for one in mine) for who, mine in runs.items()}
    cpu = {who: median(one.cpu for one in mine) for who, mine in runs.items()}
    return [
        f"| {name} | {who} | {mine[0].pairs} | {wall[who]:.2f} | {cpu[who]:.2f} "
        f"| {max(one.mebibytes for one in mine)} "
        f"| {wall[who] / wall[SATCHECK]:.1f} | {cpu[who] / cpu[SATCHECK]:.1f} |"
        for who, mine in runs.items()
    ]


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="+", type=Path, metavar="SCENE.json")
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    compileall.compile_dir(sysconfig.get_path("platlib"), quiet=2, workers=1)
    lines = [
        "| scene | | pairs | wall s | CPU s | MiB | wall ratio | CPU ratio |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for scene in options.scenes:
        name = scene.stem if scene.stem != "scene" else scene.resolve().parent.name
        lines += rows(name, measure(scene, options.rounds))
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
