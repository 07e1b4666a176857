"""`satcheck batch` on scenes of ten bodies, some of which end their process: answers, memory, pace.

    python bench/batches.py [--meshes FOLDER] [--scenes 10000] [--slice 10000] [--rounds 3]

The scenes are made of the meshes of a folder. Five abort, five hang, five need too much memory: a
`sitecustomize` for the processes of satcheck does that when a file with a marked name is read
(tests/audit/batch/planted). A hundred are broken by themselves. All go through one batch on two
slots; then each good scene is checked in this process by `satcheck.audit.check`, and each answer is
compared. The memory of the processes is sampled meanwhile.

The pace is that of a slice of good scenes: the batch on two slots, a plain Python loop of the same
checks in one process that writes the reports to one file, and one `satcheck` process for each
scene, one after the other in each round. Others may use the two cores meanwhile. The processor time
hardly depends on that: twice that of the loop, divided by that of the batch, is how much faster the
batch is on two cores of its own that never wait. Needs Linux.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from satcheck.audit import Settings, check
from satcheck.report.json import line_of

ROOT = Path(__file__).resolve().parent.parent
PLANTED = ROOT / "tests" / "audit" / "batch" / "planted"
BODIES = 10
LARGEST_BYTES = 100_000
SUFFIXES = {".obj", ".stl", ".off", ".ply"}
SECONDS, MEBIBYTES = 10, 1024
# A word in the name of a mesh, and the code of the issue that has to name it.
ENDS = {"abort": "worker-crashed", "hang": "worker-timeout", "bomb": "worker-out-of-memory"}
EACH, BROKEN = 5, 100
SLOTS = 2
SHELL_SCENES = 25
# The same checks, and the reports as lines of a file. It looks for no changed files, states no
# digests of them, and starts no process.
PLAIN_LOOP = """
import sys
from satcheck.audit import Settings, check
from satcheck.report.json import line_of
settings = Settings(jobs=1)
with open("loop.jsonl", "wb") as lines:
    for name in sys.stdin.read().split():
        lines.write(line_of(check([name], settings)))
"""


class Cost(NamedTuple):
    """Seconds of wall-clock and of processor time for one scene."""

    wall: float
    cpu: float


def make(meshes: Path, folder: Path, count: int) -> dict[str, list[str]]:
    """Kind of scene -> its files: good, broken, and the words of ENDS."""
    shutil.copytree(meshes, folder / "m", ignore=_unfit)
    names = sorted(place.name for place in (folder / "m").iterdir())
    kinds = ["broken"] * BROKEN + [word for word in ENDS for _ in range(EACH)]
    kinds += ["good"] * (count - len(kinds))
    chance = random.Random(19)
    chance.shuffle(kinds)
    scenes: dict[str, list[str]] = {kind: [] for kind in ("good", "broken", *ENDS)}
    for number, kind in enumerate(kinds):
        file = f"s{number:06}.toml"
        text = 'schema = "satcheck.scene/1"\n'
        for body in range(BODIES):
            mesh = chance.choice(names)
            if body == 0 and kind != "good":
                mesh = _bad_mesh(folder / "m", mesh, kind, number)
            place = [round(chance.uniform(-4, 4), 3) for _ in range(3)]
            text += f'[[bodies]]\nid = "b{body}"\nmesh = "m/{mesh}"\nposition = {place}\n'
        (folder / file).write_text(text)
        scenes[kind].append(file)
    return scenes


def _unfit(folder: str, names: list[str]) -> list[str]:
    """The files of a folder that are no small mesh."""
    places = [Path(folder) / name for name in names]
    return [
        place.name
        for place in places
        if place.suffix not in SUFFIXES or place.stat().st_size > LARGEST_BYTES
    ]


def _bad_mesh(folder: Path, mesh: str, kind: str, number: int) -> str:
    """A copy of a mesh that ends its process, is cut off or damaged, or is missing."""
    name = f"{kind}{number}{Path(mesh).suffix}"
    data = (folder / mesh).read_bytes()
    if kind != "broken":
        (folder / name).write_bytes(data)
    elif number % 3:
        (folder / name).write_bytes((data[: len(data) // 2] + b"\xff") * (number % 3 - 1))
    return name


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def command(*words: str) -> list[str]:
    return [sys.executable, "-m", "satcheck.cli", *words]


def sampled(process: subprocess.Popen[bytes]) -> Iterator[tuple[int, int]]:
    """MiB of the process and of the largest of its children, until it ends."""
    while process.poll() is None:
        time.sleep(0.2)
        yield _mebibytes(process.pid), max(map(_mebibytes, _children(process.pid)), default=0)


def _children(pid: int) -> list[int]:
    """Threads and processes that end meanwhile are left out."""
    found: list[int] = []
    with suppress(OSError):
        for thread in Path(f"/proc/{pid}/task").iterdir():
            found += map(int, (thread / "children").read_text().split())
    return found


def _mebibytes(pid: int) -> int:
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except (OSError, IndexError):
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE") >> 20


def run_all(folder: Path) -> None:
    """One batch of all scenes. Prints the memory in each fifth of the run."""
    words = command("batch", "s*.toml", "-o", "results.jsonl", "-j", str(SLOTS))
    limits = ["--limit", f"scene-seconds={SECONDS},scene-megabytes={MEBIBYTES}"]
    began = time.perf_counter()
    process = subprocess.Popen(
        [*words, *limits], cwd=folder, env={**os.environ, "PYTHONPATH": str(PLANTED)}
    )
    samples = list(sampled(process))
    say(f"exit code {process.returncode}, {time.perf_counter() - began:.0f} s")
    fifth = max(1, len(samples) // 5)
    parts = [samples[k : k + fifth] for k in range(0, len(samples), fifth)][:5]
    for title, column in (("parent", 0), ("worker", 1)):
        most = [max(sample[column] for sample in part) for part in parts]
        say(f"peak memory of the {title} in each fifth of the run: {most} MiB")


def compare(folder: Path, scenes: dict[str, list[str]]) -> None:
    """Prints how many answers are as they have to be."""
    lines = map(json.loads, (folder / "results.jsonl").read_bytes().splitlines())
    results: dict[str, Any] = {line["files"][0]: line for line in lines}
    settings = Settings(jobs=1)
    right = sum(
        results[name]["report"]["findings"] == _findings(name, settings) for name in scenes["good"]
    )
    say(f"good scenes with the right answer: {right} of {len(scenes['good'])}")
    for word, code in ENDS.items():
        named = sum(_names_the_file(results[name], word, code) for name in scenes[word])
        say(f"scenes of {word} that name the file: {named} of {len(scenes[word])}")
    failed = sum(results[name]["verdict"] == "error" for name in scenes["broken"])
    say(f"broken scenes with an error: {failed} of {len(scenes['broken'])}")


def _names_the_file(result: Any, word: str, code: str) -> bool:
    """And the report has all other bodies."""
    report = result["report"]
    named = any(issue["code"] == code and word in issue["message"] for issue in report["issues"])
    usable = [body for body in report["bodies"] if body["triangles"] is not None]
    return named and result["verdict"] != "error" and len(usable) == BODIES - 1


def _findings(name: str, settings: Settings) -> object:
    return json.loads(line_of(check([name], settings)))["findings"]


def cost(words: list[str], scenes: int, given: str = "") -> Cost:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.perf_counter()
    done = subprocess.run(words, input=given.encode(), capture_output=True, check=False)
    wall = time.perf_counter() - began
    if done.returncode not in (0, 1, 3):
        raise RuntimeError(done.stderr.decode())
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Cost(wall / scenes, cpu / scenes)


def pace(good: list[str], rounds: int) -> None:
    """good: the scenes of the slice."""
    Path("slice").write_text("\n".join(good))
    few = good[:SHELL_SCENES]
    batch = command("batch", "--manifest", "slice", "-o", "slice.jsonl", "-j", str(SLOTS))
    satcheck = " ".join(command("$scene", "--format", "json"))
    shell = ["sh", "-c", f"while read -r scene; do {satcheck} || true; done"]
    costs: dict[str, list[Cost]] = {"batch": [], "loop": [], "shell": []}
    for _ in range(rounds):
        Path("slice.jsonl").unlink(missing_ok=True)
        costs["batch"].append(cost(batch, len(good)))
        costs["loop"].append(cost([sys.executable, "-c", PLAIN_LOOP], len(good), "\n".join(good)))
        costs["shell"].append(cost(shell, len(few), "\n".join(few) + "\n"))
    titles = {
        "batch": "`satcheck batch`, two slots",
        "loop": "plain Python loop, one process",
        "shell": "shell loop of `satcheck` calls",
    }
    say("| | wall, ms a scene | processor, ms a scene | batch is faster by | at most |")
    say("|---|---|---|---|---|")
    for kind, title in titles.items():
        wall, cpu = (median(column) * 1e3 for column in zip(*costs[kind], strict=True))
        pairs = list(zip(costs[kind], costs["batch"], strict=True))
        faster = median(own.wall / ours.wall for own, ours in pairs)
        most = median(SLOTS * own.cpu / ours.cpu for own, ours in pairs)
        say(f"| {title} | {wall:.2f} | {cpu:.2f} | {faster:.2f} | {most:.2f} |")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--meshes", type=Path, default=ROOT / "sample_meshes")
    parser.add_argument("--scenes", type=int, default=10_000)
    parser.add_argument("--slice", type=int, default=10_000)
    parser.add_argument("--rounds", type=int, default=3)
    asked = parser.parse_args()
    meshes = asked.meshes.resolve()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        scenes = make(meshes, Path(folder), asked.scenes)
        run_all(Path(folder))
        compare(Path(folder), scenes)
        pace(scenes["good"][: asked.slice], asked.rounds)
        os.chdir(ROOT)


if __name__ == "__main__":
    main()
