"""A slot: a process that checks worlds, and is replaced when it dies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from msgspec import Struct

from satcheck.audit.assets import lost_asset
from satcheck.batch.check_options import CheckOptions, World
from satcheck.batch.slot_server import Answer, Chunk, answer, answers_in, request_of
from satcheck.core.worker import Worker
from satcheck.core.worker_errors import WorkerError, WorkerNotStarted
from satcheck.report.batch import Result

_SERVER = "satcheck.batch.slot_server"


class Limits(Struct, frozen=True):
    """For one world. seconds: wall-clock time. megabytes: address space of its process, in MiB."""

    seconds: float = 600.0
    megabytes: int = 4096


class Slot:
    """Checks one chunk of worlds after another. Stop it after use."""

    def __init__(self, options: CheckOptions, limits: Limits) -> None:
        self._options = options
        self._limits = limits
        self._stopped = False
        self._worker = Worker(_SERVER, megabytes=limits.megabytes)

    def stop(self) -> None:
        """Ends its process, even during a check; no check may follow."""
        self._stopped = True
        self._worker.stop()

    def check(self, worlds: Sequence[World]) -> Iterator[Answer]:
        """An answer for each world, in this order. If the process dies, or a limit ends it, each
        world is checked once more, alone; one that fails again has an answer that says so. Raises
        WorkerNotStarted."""
        try:
            yield from self._ask(worlds)
        except WorkerNotStarted:
            raise
        except WorkerError:
            if self._stopped:
                return
            for world in worlds:
                yield self._again(world)

    def _ask(self, worlds: Sequence[World]) -> list[Answer]:
        request = request_of(Chunk(tuple(worlds), self._options))
        return answers_in(self._worker.ask(request, seconds=self._limits.seconds), worlds)

    def _again(self, world: World) -> Answer:
        try:
            return self._ask([world])[0]
        except WorkerNotStarted:
            raise
        except WorkerError as error:
            return _lost(world, error)


def _lost(world: World, error: WorkerError) -> Answer:
    asset = lost_asset(world[0], error)
    result = Result(files=world, key=None, verdict=asset.verdict, inputs=(), report=asset.report)
    return answer(result)
