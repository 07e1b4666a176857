"""A slot: a process that checks worlds, and is replaced when it dies.

The worlds of a lost process are checked again, each alone and carefully, so that the step which
ends the process is known. The next check leaves that step out: the other files and pairs of the
world have their answers.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from tempfile import TemporaryDirectory

from satcheck.audit.batch.check_world import lost_asset
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.remote import is_remote
from satcheck.audit.batch.slot_server import (
    STEP_LINE,
    Answer,
    Chunk,
    Wanted,
    answers_in,
    request_of,
    result_of,
)
from satcheck.core.risky_steps import Loss
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


class Slot:
    """Checks one chunk of worlds after another. Stop it after use. folder: to which the names of
    files are relative; None: the working directory. wanted: of each check."""

    def __init__(
        self,
        options: CheckOptions,
        limits: Limits,
        folder: str | None = None,
        wanted: Wanted = RESULTS,
    ) -> None:
        self._options = options
        self._limits = limits
        self._wanted = wanted
        self._copies: TemporaryDirectory[str] | None = None
        self._worker = Worker(_SERVER, megabytes=limits.megabytes, grouped=True, folder=folder)

    def stop(self) -> None:
        """Ends its process, even during a check; no check may follow."""
        self._worker.stop()
        self._worker.close()
        if self._copies is not None:
            self._copies.cleanup()

    def check(self, worlds: Sequence[World]) -> Iterator[Answer]:
        """An answer for each world, in this order, unless the slot is stopped. Raises
        WorkerNotStarted."""
        with suppress(WorkerStopped):
            yield from self._together(worlds)

    def _together(self, worlds: Sequence[World]) -> Iterator[Answer]:
        try:
            yield from self._ask(worlds)
            return
        except (WorkerNotStarted, WorkerStopped):
            raise
        except WorkerError:
            pass
        yield from map(self._alone, worlds)

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
        if self._worker.answered:
            try:
                return self._ask([world], left_out)[0]
            except (WorkerCrashed, WorkerOutOfMemory):
                pass
        return self._ask([world], left_out)[0]

    def _ask(
        self, worlds: Sequence[World], left_out: Mapping[str, Loss] | None = None
    ) -> list[Answer]:
        copies = self._folder_of_copies() if any(map(is_remote, worlds)) else None
        chunk = Chunk(tuple(worlds), self._options, self._limits, self._wanted, left_out, copies)
        request = request_of(chunk)
        return answers_in(self._worker.ask(request, seconds=self._limits.seconds), worlds)

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
