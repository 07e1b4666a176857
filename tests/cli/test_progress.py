"""The bar of a person who waits."""

from __future__ import annotations

import io
import re
import sys
import time
from threading import Thread

import pytest

from satcheck.cli import progress
from satcheck.cli.progress import Bar
from satcheck.core.steps import step


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


def drawn(
    until: str,
    monkeypatch: pytest.MonkeyPatch,
    *,
    total: int,
    name: str = "splitting kettle, 1 of 2",
) -> str:
    """What a terminal is sent, up to that text, while a step is under way."""
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "120")
    with Bar("bodies") as bar, step(name):
        assert bar is not None
        for done in range(500):
            bar(1 + done % (total - 1), total)
            time.sleep(0.02)
            if until in terminal.getvalue():
                break
    return terminal.getvalue()


def test_the_bar_names_the_step(monkeypatch: pytest.MonkeyPatch) -> None:
    sent = drawn("splitting kettle, 1 of 2", monkeypatch, total=2)
    assert "splitting kettle, 1 of 2" in sent
    assert " left" not in sent


def test_a_name_is_shown_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rich would take parts of it for markup, and a terminal would obey the escape."""
    sent = drawn(
        "of [bold]a[/", monkeypatch, total=2, name="depth of [bold]a[/red]\x1b[2Jb: 0 to 1"
    )
    assert "depth of [bold]a[/red]\N{REPLACEMENT CHARACTER}[2Jb: 0 to 1" in sent


def test_of_many_the_bar_tells_the_rate_and_the_time_left(monkeypatch: pytest.MonkeyPatch) -> None:
    sent = drawn(" left", monkeypatch, total=1000)
    assert "/1,000 bodies, " in sent
    assert re.search(r"/s, \d:\d\d:\d\d left", sent)
