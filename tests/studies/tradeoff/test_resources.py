"""CPU time and memory of this process and of its children, as the system tells them."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import time
from pathlib import Path

import pytest

from satcheck.core.worker import Worker
from satcheck.studies.tradeoff.resources import ChildMemory, CpuClock, OwnMemory

SERVERS = Path(__file__).resolve().parents[2] / "core" / "serve_modules"
EATEN, LIMIT = 96, 1024
COUNTED_LATE = 1.0  # MiB: the system counts the pages of a thread in batches of 64
on_linux = pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="Linux alone says it")


@on_linux
def test_the_peak_of_a_worker_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(SERVERS), prepend=os.pathsep)
    with ChildMemory() as memory, Worker("misbehaving_server", megabytes=LIMIT) as worker:
        worker.ask(b"eat_memory %d" % EATEN, seconds=60.0)
    assert memory.megabytes is not None
    assert EATEN <= memory.megabytes <= LIMIT


def test_without_a_worker_there_is_none() -> None:
    # In a process of its own: other tests leave workers that later files are read by.
    look = """
from satcheck.studies.tradeoff.resources import ChildMemory
with ChildMemory() as memory:
    memory.look()
print(memory.megabytes)
"""
    seen = subprocess.run([sys.executable, "-c", look], capture_output=True, text=True, check=True)
    assert seen.stdout.strip() == "None"


@pytest.mark.skipif(
    platform.libc_ver()[0] != "glibc" or not os.access("/proc/self/clear_refs", os.W_OK),
    reason="glibc alone gives memory back, Linux alone says the mark",
)
def test_what_was_taken_and_given_back_is_seen() -> None:
    memory = OwnMemory()
    assert len(b"x" * (EATEN << 20)) == EATEN << 20
    assert memory.grown is not None
    assert abs(memory.grown - EATEN) < COUNTED_LATE
    nothing = OwnMemory().grown
    assert nothing is not None
    assert nothing < COUNTED_LATE


WORK = "import time\nwhile time.process_time() < 0.2: pass"


@pytest.mark.skipif(sys.platform == "win32", reason="Windows counts no children")
def test_a_child_counts_where_it_is_asked_for() -> None:
    clock = CpuClock()
    subprocess.run([sys.executable, "-c", WORK], check=True)
    alone, together = clock.seconds(children=False), clock.seconds(children=True)
    assert alone is not None
    assert together is not None
    # Of CPU time, which waits for no other process: the child worked 0.2 s, by its own account.
    assert together - alone >= 0.19


def test_what_waits_does_not_work() -> None:
    before = time.process_time()
    clock = CpuClock()
    time.sleep(0.05)
    used = clock.seconds(children=False)
    assert used is not None
    assert used <= time.process_time() - before
