"""A progress bar on stderr: only for a person, and only when the work takes long."""

from __future__ import annotations

import os
import sys
from _thread import allocate_lock
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from threading import Timer
    from types import TracebackType

    from rich.progress import Progress, TaskID

# Seconds before the bar appears: shorter work answers before anyone would read it.
PATIENCE = 0.7


class Bar:
    """Context manager; call what it gives as `bar(done, total)` from any thread. `unit`: what is
    counted."""

    def __init__(self, unit: str = "pairs") -> None:
        self._unit = unit
        # FORCE_COLOR would make rich write cursor movements into a redirected stderr.
        self._wanted = bool(
            sys.stderr is not None and sys.stderr.isatty() and os.environ.get("TERM") != "dumb"
        )
        self._lock = allocate_lock()
        self._ended = False
        self._done, self._total = 0, 0
        self._shown: tuple[Progress, TaskID] | None = None
        self._timer: Timer | None = None

    def __enter__(self) -> Bar | None:
        """None where standard error is not shown."""
        if not self._wanted:
            return None
        from threading import Timer

        timer = Timer(PATIENCE, self._show)
        timer.daemon = True
        try:
            timer.start()
        except RuntimeError:  # the system grants no more threads
            return None
        self._timer = timer
        return self

    def __call__(self, done: int, total: int) -> None:
        with self._lock:
            self._done, self._total = done, total
            if self._shown is not None:
                bar, task = self._shown
                bar.update(task, completed=done, total=total)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._timer is None:
            return
        self._timer.cancel()
        with self._lock:
            self._ended = True
            if self._shown is not None:
                self._shown[0].stop()

    def _show(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
        from rich.progress import TimeElapsedColumn as Elapsed

        with self._lock:
            if self._ended:
                return
            bar = Progress(
                TextColumn("checking"),
                BarColumn(),
                MofNCompleteColumn(),
                TextColumn(self._unit),
                Elapsed(),
                console=Console(stderr=True),
                transient=True,
            )
            task = bar.add_task(self._unit, completed=self._done, total=self._total or None)
            bar.start()
            self._shown = (bar, task)
