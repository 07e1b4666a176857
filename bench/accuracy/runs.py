"""All pairs of a corpus, one child process a pair, into a file that a later call goes on with.

JSON lines: first what the run is, then a record a pair, in the order in which they were made.
"""

from __future__ import annotations

import json
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import Any

from bench.accuracy.case import Case, Effort
from bench.accuracy.machine import environment_of
from bench.scenes import environment, run

# Beyond the budget of the rungs: reading, the plain checks, and a last run that had begun.
SPARE_SECONDS = 120.0
FINE = (0, 1, 3)

Record = dict[str, Any]
Header = dict[str, Any]


class OtherRun(Exception):
    """The file holds what was measured in another way."""


def measure_all(
    cases: Sequence[Case], effort: Effort, results: Path, told: Callable[[str], None]
) -> None:
    """Appends to `results` what is not there yet. Raises OtherRun where it was begun otherwise."""
    header = {"effort": asdict(effort), "environment": environment_of()}
    if results.exists():
        _drop_broken_end(results)
        before, records = load(results)
        if before["effort"] != header["effort"]:
            raise OtherRun(f"{results} was measured with {before['effort']}")
        if before["environment"]["versions"] != header["environment"]["versions"]:
            raise OtherRun(f"{results} was measured with {before['environment']['versions']}")
    else:
        records = {}
        _append(results, header)
    for number, case in enumerate(cases, 1):
        if case.id not in records:
            record = _record(case, effort)
            _append(results, {"case": case.to_dict(), **record})
            told(f"{number}/{len(cases)} {case.id} {record['seconds']:.1f} s")


def load(results: Path) -> tuple[Header, dict[str, Record]]:
    """What the run was, and its records by the id of their pair."""
    lines = results.read_text(encoding="utf-8").splitlines()
    header, *records = (json.loads(line) for line in lines if line)
    return header, {record["case"]["id"]: record for record in records}


def _drop_broken_end(results: Path) -> None:
    """A line that was being written when the run was broken off."""
    text = results.read_bytes()
    with results.open("r+b") as file:
        file.truncate(text.rfind(b"\n") + 1)


def _append(results: Path, value: dict[str, Any]) -> None:
    with results.open("a", encoding="utf-8") as file:
        file.write(json.dumps(value) + "\n")


def _record(case: Case, effort: Effort) -> Record:
    start = perf_counter()
    record = _ask_child(case, effort)
    if "failure" not in record:
        record["process"] = _processes(case, effort.repeat)
    return record | {"seconds": perf_counter() - start}


def _ask_child(case: Case, effort: Effort) -> Record:
    asked = json.dumps({"case": case.to_dict(), "effort": asdict(effort)})
    limit = effort.pair_seconds + SPARE_SECONDS
    try:
        done = subprocess.run(
            [sys.executable, "-m", "bench.accuracy.measuring"],
            input=asked.encode(),
            capture_output=True,
            timeout=limit,
            env=environment(),
            check=False,
        )
    except subprocess.TimeoutExpired:
        return {"failure": f"no answer within {limit:g} s"}
    if done.returncode:
        tail = done.stderr.decode(errors="replace").strip().splitlines()[-1:]
        return {"failure": f"exit code {done.returncode} {' '.join(tail)}".strip()}
    record: Record = json.loads(done.stdout)
    return record


def _processes(case: Case, repeat: int) -> list[dict[str, float]]:
    """The command as a user types it: wall and CPU seconds, MiB of each whole process."""
    script = str(Path(sysconfig.get_path("scripts")) / "satcheck")
    made = []
    with tempfile.TemporaryDirectory() as scratch:
        inputs = [str(path) for path in case.inputs(Path(scratch))]
        report = str(Path(scratch) / "report.json")
        for _ in range(repeat):
            wall, cpu, mebibytes, _ = run([script, "--depth", "-o", report, *inputs], fine=FINE)
            made.append({"wall": wall, "cpu": cpu, "megabytes": float(mebibytes)})
    return made
