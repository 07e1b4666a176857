"""The same of several things at once, whatever the system and the user do."""

from __future__ import annotations

from queue import SimpleQueue
from threading import Event, Thread
from time import sleep

import pytest

from satcheck.audit.parallel import in_parallel


@pytest.mark.parametrize("threads", [1, 3])
def test_each_has_its_result(threads: int) -> None:
    assert list(in_parallel(lambda x: x * x, range(10), threads)) == [x * x for x in range(10)]


@pytest.mark.parametrize("granted", [0, 1])
def test_each_has_its_result_where_no_more_threads_are_granted(
    granted: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    start = Thread.start
    started: list[Thread] = []

    def refuse(thread: Thread) -> None:
        if len(started) == granted:
            raise RuntimeError("can't start new thread")
        started.append(thread)
        start(thread)

    def squared(x: int) -> int:
        sleep(1e-3)
        return x * x

    monkeypatch.setattr(Thread, "start", refuse)
    assert list(in_parallel(squared, range(10), 3)) == [x * x for x in range(10)]
    assert len(started) == granted


def test_after_an_error_nobody_waits_for_the_others() -> None:
    started, answered = Event(), Event()
    heard: SimpleQueue[bool] = SimpleQueue()

    def work(thing: str) -> None:
        if thing == "first":
            assert started.wait(timeout=20)
            raise KeyboardInterrupt
        started.set()
        heard.put(answered.wait(timeout=20))

    with pytest.raises(KeyboardInterrupt):
        list(in_parallel(work, ["first", "other"], 2))
    answered.set()
    assert heard.get(timeout=20)
