"""A progress bar on stderr: only for a person, and only when the work takes long."""

from __future__ import annotations

import os
import sys
from _thread import allocate_lock
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, TypeVar

from satcheck.cli.output import harmless
from satcheck.core.steps import current

if TYPE_CHECKING:
    from threading import Timer
    from types import TracebackType

    from rich.progress import Progress, Task, TaskID

_T = TypeVar("_T")

# Seconds before the bar appears: shorter work answers before anyone would read it.
PATIENCE = 0.7


# Of fewer there is no telling how long the others take.
RATED = 20


class Bar:
    """Context manager; call what it gives as `bar(done, total)` from any thread. unit: what is
    counted; verb: what is done, while no step names itself (core/steps.py)."""

    def __init__(self, unit: str = "pairs", verb: str = "checking") -> None:
        self._unit, self._verb = unit, verb
        # FORCE_COLOR would make rich write cursor movements into a redirected stderr.
        self._wanted = bool(
            sys.stderr is not None and sys.stderr.isatty() and os.environ.get("TERM") != "dumb"
        )
        self._lock = allocate_lock()
        self._ended = False
        self._done, self._total = 0, 0
        self._beside = ""
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

    def __call__(self, done: int, total: int, beside: str = "") -> None:
        """beside: what is said after the count."""
        with self._lock:
            self._done, self._total, self._beside = done, total, beside
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
        from rich.progress import BarColumn, Progress, ProgressColumn
        from rich.text import Text

        class Step(ProgressColumn):
            def render(column, _: Task) -> Text:
                # A name may hold anything, also what rich takes for its markup.
                name = harmless(current()) or self._verb
                return Text(name, no_wrap=True, overflow="ellipsis")

        class Pace(ProgressColumn):
            def render(column, task: Task) -> str:
                return self._pace(task)

        with self._lock:
            if self._ended:
                return
            bar = Progress(
                Step(), BarColumn(), Pace(), console=Console(stderr=True), transient=True
            )
            task = bar.add_task("", completed=self._done, total=self._total or None)
            bar.start()
            self._shown = (bar, task)

    def _pace(self, task: Task) -> str:
        """Return `120/300 pairs, 35/s, 0:00:05 left`; where little is counted, the time so far."""
        from datetime import timedelta

        counted = f"{self._done:,}/{self._total:,} {self._unit}, " if self._total else ""
        counted += f"{self._beside}, " if self._beside else ""
        if self._total >= RATED and task.speed and task.time_remaining is not None:
            left = timedelta(seconds=round(task.time_remaining))
            return f"{counted}{task.speed:.3g}/s, {left} left"
        return f"{counted}{timedelta(seconds=round(task.elapsed or 0.0))}"


def counting(things: Sequence[_T], unit: str, verb: str) -> Iterator[_T]:
    """Yield them under a bar, which counts those that are done. unit, verb: as in Bar."""
    with Bar(unit, verb) as bar:
        for number, thing in enumerate(things, 1):
            yield thing
            if bar is not None:
                bar(number, len(things))
