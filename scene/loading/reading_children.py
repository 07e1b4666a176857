"""The child processes that read the files of a run: one for each reader.

Each child reads many files, because importing its large parsers takes longer than reading most
files. If a file stops or kills its child, only this file fails, and the next file gets a new child.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from satcheck.core.worker import Worker


class ReadingChildren:
    """megabytes: limit for each child. The children end when this object is deleted, or when the
    process ends."""

    def __init__(self, megabytes: int) -> None:
        self._megabytes = megabytes
        self._workers: dict[str, Worker] = {}

    def ask(self, module: str, request: bytes, *, seconds: float) -> bytes:
        """`serve(request)` of that module. seconds: for this request. Raises WorkerError.

        Earlier files may have used up the memory of a child, or damaged it. If such a child fails,
        a new one decides, so that no answer depends on earlier files.
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
