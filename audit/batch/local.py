"""The local engine: slots on this machine, each served by a thread."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Generator, Sequence
from queue import Queue
from threading import Thread

from satcheck.audit.batch.options import CheckOptions, Limits, Pace, World
from satcheck.audit.batch.slot import RESULTS, Slot
from satcheck.audit.batch.slot_server import Answer, Wanted
from satcheck.core.worker_errors import WorkerNotStarted

# A process takes about this long to start: few worlds are checked before a second one would help.
# After each such time there are twice as many.
_SECONDS_BEFORE_MORE = 0.5
# Work of a slot between two questions to this process. Short, so that little is lost with it.
_CHUNK_SECONDS = 0.2
_LARGEST_CHUNK = 64


def check_locally(
    worlds: Sequence[World],
    options: CheckOptions,
    limits: Limits,
    slots: int,
    wanted: Wanted = RESULTS,
) -> Generator[list[Answer]]:
    """The answers, as they come: all that are there at a time. Raises WorkerNotStarted. If the
    iteration is left early, the slots end."""
    waiting = deque(worlds)
    answers: Queue[Answer | BaseException] = Queue(maxsize=1000)
    made = [Slot(options, limits, wanted=wanted) for _ in range(min(slots, len(worlds)))]
    # What no file keeps is asked for one by one: what is done is then known, whatever comes next.
    largest = _LARGEST_CHUNK if wanted.kept else 1
    try:
        for number, slot in enumerate(made):
            _start(_serve, slot, number, largest, waiting, answers)
        due = len(worlds)
        while due:
            come = [
                _answer(answers.get()),
                *(_answer(answers.get()) for _ in range(answers.qsize())),
            ]
            due -= len(come)
            yield come
    finally:
        waiting.clear()
        for slot in made:
            slot.stop()


def _start(work: Callable[..., None], *arguments: object) -> None:
    try:
        Thread(target=work, args=arguments, daemon=True).start()
    except RuntimeError as error:  # the system grants no more threads
        raise WorkerNotStarted(_start.__module__, str(error)) from error


def _serve(
    slot: Slot,
    number: int,
    largest: int,
    waiting: deque[World],
    answers: Queue[Answer | BaseException],
) -> None:
    """number: of the slot, from 0 on. largest: worlds of a chunk at most."""
    time.sleep(number.bit_length() * _SECONDS_BEFORE_MORE)
    pace = Pace(largest)
    try:
        while chunk := _next(waiting, pace.size):
            began = time.monotonic()
            for answer in slot.check(chunk):
                answers.put(answer)
            pace.measure(len(chunk), time.monotonic() - began, _CHUNK_SECONDS)
    except BaseException as error:  # noqa: BLE001  raised where the answers are awaited
        answers.put(error)


def _next(waiting: deque[World], size: int) -> list[World]:
    chunk: list[World] = []
    try:
        while len(chunk) < size:
            chunk.append(waiting.popleft())
    except IndexError:
        pass
    return chunk


def _answer(come: Answer | BaseException) -> Answer:
    if isinstance(come, BaseException):
        raise come
    return come
