"""One function on several items at once, in threads."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")


def in_parallel(work: Callable[[T], R], things: Sequence[T], threads: int) -> Iterator[R]:
    """Yield work(thing) of each thing, on this many threads. If the system grants no thread, the
    calls run one after another. After an error, such as Ctrl-C, running work is not awaited."""
    from concurrent.futures import ThreadPoolExecutor

    pool = ThreadPoolExecutor(threads)
    try:
        futures = [pool.submit(work, thing) for thing in things]
    except RuntimeError:  # can't start new thread
        pool.shutdown(wait=False, cancel_futures=True)
        yield from map(work, things)
        return
    try:
        for future in futures:
            yield future.result()
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
