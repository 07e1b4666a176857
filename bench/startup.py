"""Start-up: `satcheck A B` on two small convex meshes against `python -c "import numpy"`.

    python bench/startup.py A.obj B.stl [--runs 25] [--limit 1.5]

The two commands alternate, so that both see the same machine; medians of wall and CPU time are
printed. Everything is byte-compiled first and PYTHONDONTWRITEBYTECODE is removed: without .pyc
files an import costs two to three times what a user pays. Exit code 1 above the limit.
"""

from __future__ import annotations

import argparse
import compileall
import os
import subprocess
import sys
import sysconfig
import time
from pathlib import Path
from statistics import median


def children_cpu() -> float:
    """CPU seconds of all children that have ended."""
    try:
        import resource
    except ImportError:  # Windows, where the time of children stays 0
        times = os.times()
        return times.children_user + times.children_system
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def cost(command: list[str], environment: dict[str, str]) -> tuple[float, float]:
    """Wall and CPU milliseconds of one fresh process; its exit code must be 0 or 1 (findings)."""
    before = children_cpu()
    start = time.perf_counter()
    done = subprocess.run(command, env=environment, capture_output=True, check=False)
    wall = time.perf_counter() - start
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{command}: exit code {done.returncode}\n{done.stderr.decode()}")
    return 1e3 * wall, 1e3 * (children_cpu() - before)


def main() -> int:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("a", type=Path)
    parser.add_argument("b", type=Path)
    parser.add_argument("--runs", type=int, default=25)
    parser.add_argument("--limit", type=float, default=1.5, help="largest allowed ratio, wall")
    options = parser.parse_args()
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    compileall.compile_dir(sysconfig.get_path("platlib"), quiet=2, workers=1)
    script = Path(sysconfig.get_path("scripts")) / "satcheck"
    commands = {
        "satcheck A B": [str(script), str(options.a), str(options.b)],
        "import numpy": [sys.executable, "-c", "import numpy"],
    }
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in commands}
    for command in commands.values():
        cost(command, environment)  # warm the disk cache
    for _ in range(options.runs):
        for name, command in commands.items():
            times[name].append(cost(command, environment))
    wall = {name: median(t[0] for t in rows) for name, rows in times.items()}
    cpu = {name: median(t[1] for t in rows) for name, rows in times.items()}
    for name in commands:
        sys.stdout.write(f"{name}: wall {wall[name]:.1f} ms, CPU {cpu[name]:.1f} ms\n")
    ratio = wall["satcheck A B"] / wall["import numpy"]
    cpu_ratio = cpu["satcheck A B"] / cpu["import numpy"]
    sys.stdout.write(f"ratio: wall {ratio:.2f}, CPU {cpu_ratio:.2f} (limit {options.limit})\n")
    return int(ratio > options.limit)


if __name__ == "__main__":
    raise SystemExit(main())
