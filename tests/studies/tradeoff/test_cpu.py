"""Work of this process, and of children that have ended."""

from __future__ import annotations

import subprocess
import sys
import time

import pytest

from satcheck.studies.tradeoff.cpu import CpuClock

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
