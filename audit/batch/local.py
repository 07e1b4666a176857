"""The local engine: slots on this machine, each served by a thread."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Generator, Iterator, Sequence
from contextlib import suppress
from itertools import count
from queue import Empty, Queue
from threading import Event, Thread

from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.slot import RESULTS, Slot
from satcheck.audit.batch.slot_server import Answer, Wanted
from satcheck.core.worker_errors import WorkerNotStarted

# A process takes about this long to start: few worlds are checked before a second one would help.
# After each such time there are twice as many.
_SECONDS_BEFORE_MORE = 0.5
# Answers are taken together: each time costs a write to the disk.
_SECONDS_BETWEEN_LOOKS = 0.1
_MOST_TO_TAKE = 1000
# For slots to end, after Ctrl-C: their processes have given the answers that are still taken.
_SECONDS_TO_END = 0.5
_SECONDS_BETWEEN_JOINS = 0.01


def check_locally(
    worlds: Sequence[World],
    options: CheckOptions,
    limits: Limits,
    slots: int,
    wanted: Wanted = RESULTS,
) -> Generator[list[Answer]]:
    """The answers, as they come: all that are there at a time. Raises WorkerNotStarted. If the
    iteration is left early, the slots end. A KeyboardInterrupt, also one that is thrown, is raised
    after all answers that the processes have given."""
    if not worlds:
        return
    made = _Slots(worlds, [Slot(options, limits, wanted=wanted) for _ in range(slots)])
    try:
        made.start()
        due = len(worlds)
        while due:
            answers = made.answers()
            due -= len(answers)
            if answers:
                yield answers
    except KeyboardInterrupt:
        yield made.ended()
        raise
    finally:
        made.ended()


class _Slots:
    """A thread for each slot."""

    def __init__(self, worlds: Sequence[World], slots: Sequence[Slot]) -> None:
        self._waiting = deque(worlds)
        self._numbers = count(1)
        self._total = len(worlds)
        self._slots = slots[: len(worlds)]
        self._threads: list[Thread] = []
        self._come: Queue[Answer] = Queue(_MOST_TO_TAKE)
        self._failures: list[BaseException] = []
        self._ending, self._done = Event(), Event()

    def start(self) -> None:
        """Raises WorkerNotStarted."""
        for number, slot in enumerate(self._slots):
            thread = Thread(target=self._serve, args=(slot, number), daemon=True)
            self._threads.append(thread)
            try:
                thread.start()
            except RuntimeError as error:  # the system grants no more threads
                raise WorkerNotStarted(__name__, str(error)) from error

    def answers(self) -> list[Answer]:
        """All that have come since the last look; when there is none, raises what a slot raises."""
        self._done.wait(_SECONDS_BETWEEN_LOOKS)
        answers = list(self._taken())
        if not answers and self._failures:
            raise self._failures[0]
        return answers

    def ended(self) -> list[Answer]:
        """End the slots, and return what their processes had given before."""
        self._waiting.clear()
        self._ending.set()
        for slot in self._slots:
            slot.stop()
        answers: list[Answer] = []
        deadline = time.monotonic() + _SECONDS_TO_END
        for thread in self._threads:
            while thread.is_alive() and time.monotonic() < deadline:
                thread.join(_SECONDS_BETWEEN_JOINS)
                answers += self._taken()
        return [*answers, *self._taken()]

    def _taken(self) -> Iterator[Answer]:
        with suppress(Empty):
            while True:
                yield self._come.get_nowait()

    def _serve(self, slot: Slot, number: int) -> None:
        """number: of the slot, from 0 on."""
        self._ending.wait(number.bit_length() * _SECONDS_BEFORE_MORE)
        try:
            for answer in slot.check(self._worlds()):
                self._come.put(answer)
                if next(self._numbers) == self._total:
                    self._done.set()
        except BaseException as error:  # noqa: BLE001  raised where the answers are awaited
            self._failures.append(error)
            self._done.set()
        finally:
            slot.close()

    def _worlds(self) -> Iterator[World]:
        with suppress(IndexError):
            while True:
                yield self._waiting.popleft()
