"""The child processes that read the files of a run: one for each reader, file after file.

A child imports large parsers, which takes longer than reading most files. If a file stops or kills
its child, only this file is lost: the next one gets a new child.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from satcheck.core.worker import Worker


class ReadingChildren:
    """megabytes: limit for each child. The children end with this object, at the latest with the
    process."""

    def __init__(self, megabytes: int) -> None:
        self._megabytes = megabytes
        self._workers: dict[str, Worker] = {}

    def ask(self, module: str, request: bytes, *, seconds: float) -> bytes:
        """`serve(request)` of that module. seconds: for this request. Raises WorkerError.

        A child that has read other files may have less memory left, or be damaged by them. Where it
        fails, a fresh one decides, so that no answer depends on the files before.
        """
        from satcheck.core.worker import WorkerCrashed, WorkerOutOfMemory

        worker = self._worker(module)
        fresh = worker.answered == 0
        try:
            return worker.ask(request, seconds=seconds)
        except (WorkerOutOfMemory, WorkerCrashed):
            if fresh:
                raise
            return worker.ask(request, seconds=seconds)

    def _worker(self, module: str) -> Worker:
        if module not in self._workers:
            from weakref import finalize

            from satcheck.core.worker import Worker

            worker = Worker(module, megabytes=self._megabytes)
            finalize(self, worker.close)
            self._workers[module] = worker
        return self._workers[module]
