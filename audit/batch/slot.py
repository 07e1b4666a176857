"""A slot: a process that checks worlds, and is replaced when it dies.

The world at which a process was lost is checked again, alone and carefully, so that the step which
ends the process is known. The next check leaves that step out: the other files and pairs of the
world have their answers. The process had not begun the worlds behind it, which are sent again.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from itertools import chain
from tempfile import TemporaryDirectory

from satcheck.audit.batch.check_world import lost_asset
from satcheck.audit.batch.options import CheckOptions, Limits, Pace, World
from satcheck.audit.batch.remote import is_remote
from satcheck.audit.batch.slot_server import (
    STEP_LINE,
    Answer,
    Job,
    Wanted,
    answer_in,
    request_of,
    result_of,
    text_of,
)
from satcheck.core.steps import Loss
from satcheck.core.worker import Worker
from satcheck.core.worker_errors import (
    WorkerCrashed,
    WorkerError,
    WorkerNotStarted,
    WorkerOutOfMemory,
    WorkerStopped,
    WorkerTimeout,
)
from satcheck.report.json import line_of

_SERVER = "satcheck.audit.batch.slot_server"
RESULTS = Wanted()
# Steps of one world that are left out, before the world is given up.
_MOST_LEFT_OUT = 3
# A step is to blame for the end at the time limit only if it took more than this share of it.
_SHARE_OF_TIME = 0.5
# Work that a process has before it: short, as another slot may be free for it.
_SECONDS_AHEAD = 0.2
_MOST_AHEAD = 64


class Slot:
    """Checks worlds one after another. Close it after use. folder: to which the names of files are
    relative; None: the working directory. wanted: of each check."""

    def __init__(
        self,
        options: CheckOptions,
        limits: Limits,
        folder: str | None = None,
        wanted: Wanted = RESULTS,
    ) -> None:
        self._limits = limits
        self._terms = text_of((options, limits, wanted))
        self._copies: TemporaryDirectory[str] | None = None
        self._worker = Worker(_SERVER, megabytes=limits.megabytes, grouped=True, folder=folder)

    def stop(self) -> None:
        """Ends its process, even during a check; no check may follow."""
        self._worker.stop()

    def close(self) -> None:
        """Stops it, and waits until no check is under way."""
        self.stop()
        self._worker.close()
        if self._copies is not None:
            self._copies.cleanup()

    def check(self, worlds: Iterable[World]) -> Iterator[Answer]:
        """An answer for each world, in this order, as they come; if the slot is stopped, those that
        its process has given. Raises WorkerNotStarted."""
        waiting = iter(worlds)
        with suppress(WorkerStopped):
            while True:
                sent: deque[World] = deque()
                try:
                    yield from self._plainly(waiting, sent)
                    return
                except (WorkerNotStarted, WorkerStopped):
                    raise
                except WorkerError:
                    yield self._alone(sent.popleft())
                waiting = chain(sent, waiting)

    def _plainly(self, worlds: Iterable[World], sent: deque[World]) -> Iterator[Answer]:
        """Yield answers until a world fails. sent: gets the worlds that the process has. Raises
        WorkerError."""

        def requests() -> Iterator[bytes]:
            for world in worlds:
                sent.append(world)
                yield self._request(world)

        pace = Pace(_MOST_AHEAD)
        replies = self._worker.replies(
            requests(), seconds=self._limits.seconds, ahead=lambda: pace.size
        )
        began, answered = time.monotonic(), 0
        for reply in replies:
            yield answer_in(reply, sent.popleft())
            answered += 1
            if answered >= pace.size:
                pace.measure(answered, time.monotonic() - began, _SECONDS_AHEAD)
                began, answered = time.monotonic(), 0

    def _alone(self, world: World) -> Answer:
        left_out: dict[str, Loss] = {}
        while True:
            try:
                return self._carefully(world, left_out)
            except (WorkerNotStarted, WorkerStopped):
                raise
            except WorkerError as error:
                loss = _loss(error)
                step = self._last_step(error)
            if not step or step in left_out or len(left_out) == _MOST_LEFT_OUT:
                return lost(world, loss)
            left_out[step] = loss

    def _carefully(self, world: World, left_out: Mapping[str, Loss]) -> Answer:
        """An earlier world may have used up the memory of the process, or damaged it: a fresh one
        decides."""
        request = self._request(world, left_out)
        if self._worker.answered:
            with suppress(WorkerCrashed, WorkerOutOfMemory):
                return answer_in(self._worker.ask(request, seconds=self._limits.seconds), world)
        return answer_in(self._worker.ask(request, seconds=self._limits.seconds), world)

    def _request(self, world: World, left_out: Mapping[str, Loss] | None = None) -> bytes:
        copies = self._folder_of_copies() if is_remote(world) else None
        return request_of(Job(world, left_out, copies), self._terms)

    def _folder_of_copies(self) -> str:
        """This process removes it, as the other one may be killed."""
        if self._copies is None:
            self._copies = TemporaryDirectory(prefix="satcheck-", ignore_cleanup_errors=True)
        return self._copies.name

    def _last_step(self, error: WorkerError) -> str:
        """The risky step that was under way; "": none, or it is not to blame."""
        lines = STEP_LINE.findall(self._worker.last_words)
        if not lines:
            return ""
        began, name = lines[-1]
        took = time.monotonic() - float(began)
        if isinstance(error, WorkerTimeout) and took < _SHARE_OF_TIME * self._limits.seconds:
            return ""
        return bytes.fromhex(name).decode("utf-8", "surrogateescape")


def _loss(error: WorkerError) -> Loss:
    """In words that are the same at every repetition."""
    match error:
        case WorkerTimeout():
            how = f"was stopped after {error.seconds:g} s"
        case WorkerOutOfMemory():
            how = f"needed more than {error.megabytes} MiB"
        case WorkerCrashed():
            how = f"died ({error.signal_name or f'exit code {error.exit_code}'})"
        case _:
            how = f"failed: {error.message}"
    return Loss(error.code, how)


def lost(world: World, loss: Loss) -> Answer:
    """The answer for a world that nobody could check."""
    result = result_of(world, lost_asset(world[0], loss))
    return Answer(world, result.verdict, line_of(result))
