"""How much memory the child processes of this one took, where the system says so (Linux)."""

from __future__ import annotations

import threading
from contextlib import suppress
from pathlib import Path

_TASKS = Path("/proc/self/task")
_PEAK = "VmHWM:"  # the high-water mark of the resident set, in KiB
_WORKER = b"satcheck.core.worker_child"
_KIB_PER_MIB = 1024.0
_PERIOD = 0.02  # seconds; the mark only rises, so no more than the last rise is missed


class ChildMemory:
    """Context manager that looks at all children of this process from time to time.

    megabytes: the largest resident set that one of them had, in MiB; None where nobody says. A last
    rise within 20 ms of a child's end can be missed.
    """

    def __init__(self) -> None:
        self.megabytes: float | None = None
        self._ended = threading.Event()
        self._watcher = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> ChildMemory:
        self._watcher.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._watcher.join()

    def _watch(self) -> None:
        ended = False
        while not ended:
            ended = self._ended.wait(_PERIOD)
            self.look()

    def look(self) -> None:
        for child in _children():
            peak = _peak(child)
            if peak is not None:
                self.megabytes = max(self.megabytes or 0.0, peak)


def _children() -> list[str]:
    found: list[str] = []
    with suppress(OSError):
        for task in _TASKS.iterdir():
            with suppress(OSError):  # a thread that has ended meanwhile
                found += (task / "children").read_text(encoding="ascii").split()
    return found


def _peak(process: str) -> float | None:
    folder = Path("/proc", process)
    try:
        # Until it has become a worker it is a copy of this process.
        if _WORKER not in (folder / "cmdline").read_bytes():
            return None
        status = (folder / "status").read_text(encoding="utf-8", errors="replace")
    except OSError:  # it has ended
        return None
    lines = (line.split() for line in status.splitlines() if line.startswith(_PEAK))
    return next((int(words[1]) / _KIB_PER_MIB for words in lines), None)
