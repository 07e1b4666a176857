"""The memory of child processes, as the system tells it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from satcheck.audit.tradeoff.memory import ChildMemory
from satcheck.core.worker import Worker

SERVERS = Path(__file__).resolve().parents[2] / "core" / "serve_modules"
EATEN, LIMIT = 96, 1024
on_linux = pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="Linux alone says it")


@on_linux
def test_the_peak_of_a_worker_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(SERVERS), prepend=os.pathsep)
    with ChildMemory() as memory, Worker("misbehaving_server", megabytes=LIMIT) as worker:
        worker.ask(b"eat_memory %d" % EATEN, seconds=60.0)
    assert memory.megabytes is not None
    assert EATEN <= memory.megabytes <= LIMIT


def test_without_a_worker_there_is_none() -> None:
    with ChildMemory() as memory:
        memory.look()
    assert memory.megabytes is None
