"""The Dask engine: the worlds of a batch go in chunks to the workers of a Dask cluster."""

from __future__ import annotations

import pickle
import time
from collections import deque
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from itertools import chain
from pathlib import Path
from typing import Any
from uuid import uuid4

from distributed import Client, Future, KilledWorker, as_completed

from satcheck.audit.batch.dask_worker import Chunk, Slots, Terms, check_chunk
from satcheck.audit.batch.options import CheckOptions, Limits, Pace, World
from satcheck.audit.batch.remote import is_url
from satcheck.audit.batch.slot import lost
from satcheck.audit.batch.slot_server import Answer
from satcheck.core.errors import SatcheckError
from satcheck.core.steps import Loss

# A task costs about 7 ms of processor time: 1.5 of the client, 2.3 of the scheduler, 2.7 of the
# worker (bench/dask_cost.py). Tasks of a second keep that far below a twentieth of the work. There
# is one scheduler: with many threads longer tasks keep it at 50 a second.
_TASK_SECONDS = 1.0
_TASK_SECONDS_PER_THREAD = 0.02
_LARGEST_CHUNK = 10_000
# Tasks that the scheduler holds at a time, however large the batch is.
_TASKS_PER_THREAD = 2
_TASKS_AT_LEAST = 16
_CONNECT_SECONDS = 30
_SECONDS_BETWEEN_COUNTS = 2.0


def check_with_dask(
    worlds: Sequence[World], options: CheckOptions, limits: Limits, scheduler: str
) -> Generator[list[Answer]]:
    """The answers, as they come. scheduler: its address, or the JSON file that it has written. If
    the iteration is left early, all checks end.

    A task whose worker dies is run again by another one. If several workers die with a task, its
    worlds are suspects, as those of other tasks on these workers are: one suspect at a time is
    checked again. A world that still ends workers has an answer that says so. Raises SatcheckError:
    `no-scheduler`, `scheduler-lost`, `other-version`, `dask-failed`; WorkerNotStarted.
    """
    if not worlds:
        return
    terms = Terms(options, limits, _folder(worlds, options))
    with _connected(scheduler) as client, _slots(client, terms) as batch:
        yield from _Tasks(client, batch, worlds).answers()


class _Tasks:
    def __init__(self, client: Client, batch: str, worlds: Sequence[World]) -> None:
        self._client = client
        self._batch = batch
        self._waiting = deque(worlds)
        self._suspects: deque[World] = deque()
        self._suspect: Future[Chunk] | None = None  # that is being checked again
        self._sent: dict[Future[Chunk], tuple[World, ...]] = {}
        self._pace = Pace(_LARGEST_CHUNK)
        self._threads = 0
        self._counted = float("-inf")

    def answers(self) -> Iterator[list[Answer]]:
        done = as_completed(with_results=True, raise_errors=False, loop=self._client.loop)
        try:
            self._send(done)
            for completed in done.batches():
                yield [each for future, result in completed for each in self._taken(future, result)]
                self._send(done)
        except OSError as error:
            raise _cause(error) from error
        finally:
            with suppress(OSError):
                self._client.cancel(list(self._sent), force=True)

    def _send(self, done: as_completed) -> None:
        self._count_threads()
        if self._suspects and self._suspect is None:
            self._suspect = self._submit((self._suspects.popleft(),), done)
        most = _TASKS_PER_THREAD * self._threads + _TASKS_AT_LEAST
        while len(self._sent) < most and (chunk := self._next()):
            self._submit(chunk, done)

    def _submit(self, chunk: tuple[World, ...], done: as_completed) -> Future[Chunk]:
        worlds = pickle.dumps(chunk)
        future = self._client.submit(check_chunk, self._batch, worlds, key=f"satcheck-{uuid4()}")
        self._sent[future] = chunk
        done.add(future)
        return future

    def _next(self) -> tuple[World, ...]:
        """At the end chunks become smaller, so that all threads end together."""
        fair = -(-len(self._waiting) // max(1, 2 * self._threads))
        size = min(self._pace.size, fair)
        return tuple(self._waiting.popleft() for _ in range(size))

    def _taken(self, future: Future[Chunk], result: object) -> list[Answer]:
        chunk = self._sent.pop(future)
        was_suspect = future is self._suspect
        if was_suspect:
            self._suspect = None
        if isinstance(result, Chunk):
            return self._answers(chunk, result)
        # Of a failed task Dask gives the exception in a tuple, of a cancelled one alone.
        error = result[1] if isinstance(result, tuple) else result
        if not isinstance(error, KilledWorker):
            raise _cause(error)
        if was_suspect:
            return [_lost(chunk[0], error)]
        self._suspects.extend(chunk)
        return []

    def _answers(self, chunk: tuple[World, ...], result: Chunk) -> list[Answer]:
        """A worker that is closed has no answers for the last worlds of its chunk."""
        answers = result.unpacked()
        self._waiting.extendleft(chunk[len(answers) :])
        if answers:
            wanted = max(_TASK_SECONDS, _TASK_SECONDS_PER_THREAD * self._threads)
            self._pace.measure(len(answers), result.seconds, wanted)
        return answers

    def _count_threads(self) -> None:
        if time.monotonic() - self._counted > _SECONDS_BETWEEN_COUNTS:
            self._threads = sum(self._client.nthreads().values())
            self._counted = time.monotonic()


def _folder(worlds: Sequence[World], options: CheckOptions) -> str | None:
    """The working directory, if a name is relative to it: workers need to have it, too."""
    shared = (
        *options.rules,
        *options.folders,
        *(options.packages or {}).values(),
        *filter(None, [options.baseline]),
    )
    names = chain(chain.from_iterable(worlds), shared)
    everywhere = all(is_url(name) or Path(name).is_absolute() for name in names)
    return None if everywhere else str(Path.cwd())


@contextmanager
def _connected(scheduler: str) -> Iterator[Client]:
    is_file = scheduler.endswith(".json")
    where: dict[str, Any] = {"scheduler_file" if is_file else "address": scheduler}
    if is_file and not Path(scheduler).is_file():  # Dask would wait for it
        raise _no_scheduler(scheduler, "no such file")
    try:
        client = Client(**where, timeout=_CONNECT_SECONDS, set_as_default=False, name="satcheck")
    except (OSError, ValueError) as error:
        raise _no_scheduler(scheduler, f"no connection to a Dask scheduler: {error}") from None
    with client:
        yield client


@contextmanager
def _slots(client: Client, terms: Terms) -> Iterator[str]:
    """The name of the plugin of this batch on all workers, also those that come later."""
    name = f"satcheck-{uuid4()}"
    try:
        client.register_plugin(Slots(terms), name)
    except Exception as error:
        raise _cause(error) from error
    try:
        yield name
    finally:
        with suppress(OSError):  # without a scheduler the slots end when they are idle
            client.unregister_worker_plugin(name)


def _no_scheduler(scheduler: str, reason: str) -> SatcheckError:
    return SatcheckError("no-scheduler", reason, file=scheduler)


def _cause(error: object) -> Exception:
    if isinstance(error, SatcheckError):
        return error
    if isinstance(error, (CancelledError, OSError)):
        reason = (
            "the Dask scheduler is gone, or has cancelled the batch: --resume goes on with another"
        )
        return SatcheckError("scheduler-lost", reason)
    kind = type(error).__name__
    reason = f"a Dask worker cannot check: {kind}: {error}"
    return SatcheckError(
        "dask-failed", f"{reason}. Each worker needs this version of satcheck[dask]"
    )


def _lost(world: World, error: KilledWorker) -> Answer:
    times = error.allowed_failures + 1
    return lost(world, Loss("worker-crashed", f"died with its Dask worker, {times} times"))
