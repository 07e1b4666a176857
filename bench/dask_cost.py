"""What a task costs Dask: the time that client, scheduler and worker spend on a task that does
nothing, sent as `satcheck batch --engine dask` sends its chunks. `audit/batch/dask_engine.py` makes
its chunks so long that this is less than a twentieth of their work.

Needs the extra `dask` and a cluster: `python bench/dask_cost.py SCHEDULER [--tasks 2000]`
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Mapping

from distributed import Client, as_completed

# In flight at a time, as in the engine.
_WINDOW = 20
# Of a chunk: the names of 200 scenes, and their compressed results.
_SENT = os.urandom(200 * 50)
_BACK = os.urandom(200 * 600)


def task(sent: bytes) -> bytes:
    return _BACK[: len(sent) * len(_BACK) // len(_SENT)]


def cpu_seconds() -> float:
    used = os.times()
    return used.user + used.system


def round_of(client: Client, tasks: int) -> dict[str, float]:
    """Seconds a task: of the clock, and of processors by process."""
    before = _used(client)
    start = time.monotonic()
    done = as_completed(
        [_submit(client) for _ in range(_WINDOW)], with_results=True, loop=client.loop
    )
    sent = _WINDOW
    for completed in done.batches():
        for _ in completed:
            if sent < tasks:
                done.add(_submit(client))
                sent += 1
    clock = time.monotonic() - start
    after = _used(client)
    return {"clock": clock / tasks, **{k: (after[k] - before[k]) / tasks for k in after}}


def _submit(client: Client) -> object:
    return client.submit(task, _SENT, pure=False)


def _used(client: Client) -> Mapping[str, float]:
    workers = client.run(cpu_seconds)
    return {
        "client": cpu_seconds(),
        "scheduler": client.run_on_scheduler(cpu_seconds),
        "workers": sum(workers.values()),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scheduler", help="its address, or the JSON file that it has written")
    parser.add_argument("--tasks", type=int, default=2000)
    given = parser.parse_args()
    where = "scheduler_file" if given.scheduler.endswith(".json") else "address"
    with Client(**{where: given.scheduler}) as client:
        round_of(client, 200)  # warm
        for _ in range(3):
            costs = round_of(client, given.tasks)
            words = (f"{name} {1e3 * cost:.2f} ms" for name, cost in costs.items())
            sys.stdout.write(", ".join(words) + "\n")


if __name__ == "__main__":
    main()
