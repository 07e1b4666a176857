"""What runs inside a Dask worker: the slots of a batch, each with a process of its own, so that no
crash of a check ends the worker."""

from __future__ import annotations

import pickle
import time
import zlib
from threading import Lock, Timer
from typing import Any

from distributed import Worker, WorkerPlugin, get_worker
from msgspec import Struct

from satcheck._version import __version__
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.slot import Slot
from satcheck.audit.batch.slot_server import Answer
from satcheck.core.errors import SatcheckError

# Slots end after this time without a task: their batch was killed before it could end them.
_IDLE_SECONDS = 60.0
# The fastest level of zlib.
_COMPRESSION = 1


class Terms(Struct, frozen=True):
    """What all checks of a batch share. folder: to which the names of files are relative."""

    options: CheckOptions
    limits: Limits
    folder: str | None


class Chunk(Struct, frozen=True):
    """The answers for some worlds, compressed, as all of them go through the scheduler. seconds:
    that their checks took."""

    packed: bytes
    seconds: float

    def unpacked(self) -> list[Answer]:
        answers: list[Answer] = pickle.loads(zlib.decompress(self.packed))
        return answers


class Slots(WorkerPlugin):
    """The slots of one batch on a worker: one for each thread that checks. They are kept from task
    to task. version: of the satcheck that runs the batch. terms: pickled, as another
    version may not know them."""

    def __init__(self, terms: Terms) -> None:
        self._version = __version__
        self._terms = pickle.dumps(terms)

    def setup(self, worker: Worker) -> None:
        self._lock = Lock()
        self._idle: list[Slot] = []
        self._busy: list[Slot] = []
        self._timer: Timer | None = None
        self._ended = False
        self._where = worker.address

    def teardown(self, worker: Worker) -> None:  # noqa: ARG002
        """Ends all checks of the batch."""
        with self._lock:
            self._ended = True
            busy = list(self._busy)
        self._stop_idle()
        for slot in busy:
            slot.stop()

    def check(self, worlds: tuple[World, ...]) -> Chunk:
        """If the worker or the batch is ended meanwhile, the answers for the first of these worlds.
        Raises SatcheckError (`other-version`); WorkerNotStarted."""
        self._refuse_other_version()
        slot = self._take()
        if slot is None:
            return _chunk([], 0.0)
        try:
            return self._checked(slot, worlds)
        finally:
            self._give_back(slot)

    def _checked(self, slot: Slot, worlds: tuple[World, ...]) -> Chunk:
        began = time.monotonic()
        answers = list(slot.check(worlds))
        return _chunk(answers, time.monotonic() - began)

    def _refuse_other_version(self) -> None:
        if self._version != __version__:
            reason = f"has satcheck {__version__}, and this batch is run by {self._version}"
            raise SatcheckError("other-version", f"the Dask worker {self._where} {reason}")

    def _take(self) -> Slot | None:
        with self._lock:
            if self._timer is not None:
                self._timer.cancel()
            if self._ended:
                return None
            slot = self._idle.pop() if self._idle else self._new()
            self._busy.append(slot)
            return slot

    def _new(self) -> Slot:
        terms: Terms = pickle.loads(self._terms)
        return Slot(terms.options, terms.limits, terms.folder)

    def _give_back(self, slot: Slot) -> None:
        with self._lock:
            self._busy.remove(slot)
            if self._ended:
                slot.close()
                return
            self._idle.append(slot)
            self._timer = Timer(_IDLE_SECONDS, self._stop_idle)
            self._timer.daemon = True
            self._timer.start()

    def _stop_idle(self) -> None:
        with self._lock:
            idle, self._idle = self._idle, []
        for slot in idle:
            slot.close()


def check_chunk(batch: str, worlds: bytes) -> Chunk:
    """The task. batch: the name of its plugin. worlds: pickled, so that Dask does not look for
    tasks in them."""
    slots: Any = get_worker().plugins[batch]
    answers: Chunk = slots.check(pickle.loads(worlds))
    return answers


def _chunk(answers: list[Answer], seconds: float) -> Chunk:
    return Chunk(zlib.compress(pickle.dumps(answers), _COMPRESSION), seconds)
