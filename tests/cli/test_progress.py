"""The bar of a person who waits."""

from __future__ import annotations

import io
import sys
from threading import Thread

import pytest

from satcheck.cli.progress import Bar


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("granted", [True, False])
def test_there_is_none_where_no_thread_is_granted(
    granted: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(_: Thread) -> None:
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(sys, "stderr", Terminal())
    monkeypatch.setenv("TERM", "xterm")
    if not granted:
        monkeypatch.setattr(Thread, "start", refuse)
    with Bar() as bar:
        assert (bar is not None) == granted
