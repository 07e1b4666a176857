"""CPU time and memory that this process and its children take.

Memory is known on Linux alone.
"""

from __future__ import annotations

import ctypes
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path

_SELF = Path("/proc/self")
_TASKS = _SELF / "task"
_RESET = "5"  # written to clear_refs it makes the mark the size of this moment
_PEAK = "VmHWM:"  # the high-water mark of the resident set, in KiB
_WORKER = b"satcheck.core.worker_child"
_KIB_PER_MIB = 1024.0
_PERIOD = 0.02  # seconds; the mark only rises, so no more than the last rise is missed


class CpuClock:
    """Runs from where it is made, on all threads; what a child takes counts when it has ended."""

    def __init__(self) -> None:
        self._own, self._children = time.process_time(), _children_seconds()

    def seconds(self, *, children: bool) -> float | None:
        """children: some have been at work. None: the system does not say what they took."""
        own, theirs = time.process_time() - self._own, _children_seconds()
        if not children:
            return own
        if theirs is None or self._children is None:
            return None
        return own + theirs - self._children


def _children_seconds() -> float | None:
    if sys.platform == "win32":
        return None
    from resource import RUSAGE_CHILDREN, getrusage

    used = getrusage(RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class OwnMemory:
    """Looks at this process from where it is made on.

    What is free goes back to the system before (glibc), or it would be used again, and not seen.
    """

    def __init__(self) -> None:
        self._before = _fresh_mark()

    @property
    def grown(self) -> float | None:
        """The largest use so far, MiB; None where the system does not say."""
        if self._before is None:
            return None
        mark = _mark(_SELF)
        return None if mark is None else mark - self._before


def _fresh_mark() -> float | None:
    try:
        ctypes.CDLL(None).malloc_trim(0)
        (_SELF / "clear_refs").write_text(_RESET, encoding="ascii")
        return _mark(_SELF)
    except (OSError, AttributeError, TypeError):  # another system, or another library
        return None


class ChildMemory:
    """Context manager that looks at all children of this process from time to time.

    megabytes: the largest resident set that one of them had, in MiB; None where unknown. A last
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
    children: list[str] = []
    with suppress(OSError):
        for task in _TASKS.iterdir():
            with suppress(OSError):  # a thread that has ended meanwhile
                children += (task / "children").read_text(encoding="ascii").split()
    return children


def _peak(process: str) -> float | None:
    folder = Path("/proc", process)
    try:
        # Until it has become a worker it is a copy of this process.
        if _WORKER not in (folder / "cmdline").read_bytes():
            return None
        return _mark(folder)
    except OSError:  # it has ended
        return None


def _mark(folder: Path) -> float | None:
    status = (folder / "status").read_text(encoding="utf-8", errors="replace")
    lines = (line.split() for line in status.splitlines() if line.startswith(_PEAK))
    return next((int(words[1]) / _KIB_PER_MIB for words in lines), None)
