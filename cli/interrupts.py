"""Ctrl-C ends the command in time, whatever the main thread is doing.

The main thread hears a signal only between two steps of Python: a long call into the core, or into
another library, would keep it deaf. So a second thread hears Ctrl-C too. As long as the main thread
has time, KeyboardInterrupt ends the command in an orderly way; then the second thread ends the
process, and the child processes with it.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from _thread import start_new_thread
from types import FrameType
from typing import NoReturn

from satcheck.cli import exit_codes

# Within two seconds the process has ended, also on a machine that is busy.
_ORDERLY_SECONDS = 1.3
# Ctrl-C in a terminal reaches every process of a command, and a wrapper such as `timeout` or a
# package runner sends it once more. What comes so soon is no second Ctrl-C.
_ONE_PRESS_SECONDS = 0.3
_LAST_LINE_SECONDS = 0.2
_INTERRUPTED = "satcheck: interrupted"

_writing = False


def hear_interrupts() -> None:
    """Make Ctrl-C end this process from here on. Where it is ignored, as in a background job of a
    shell, it stays ignored."""
    if signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        return
    heard, told = os.pipe()
    if os.name == "posix":  # else a pipe cannot be told so, and needs not
        os.set_blocking(told, False)
    try:
        start_new_thread(_watch, (heard,))
    except RuntimeError:  # the system grants no more threads: the main thread hears it when it can
        return
    signal.set_wakeup_fd(told, warn_on_full_buffer=False)
    signal.signal(signal.SIGINT, _interrupt_once)


def write_before_the_end() -> None:
    """Give the main thread more time: it writes the results that are done."""
    global _writing
    _writing = True


def end(code: int) -> NoReturn:
    """Ends this process now: child processes too, and threads that may still be at work."""
    if (worker := sys.modules.get("satcheck.core.worker")) is not None:
        worker.end_all_children()
    os._exit(code)


def _interrupt_once(_: int, __: FrameType | None) -> None:
    """A second KeyboardInterrupt would break off what the first one ends."""
    signal.signal(signal.SIGINT, lambda *_: None)  # the thread that watches still hears it
    raise KeyboardInterrupt


def _watch(heard: int) -> None:
    began: float | None = None
    while signals := os.read(heard, 1):
        if signals[0] != signal.SIGINT:
            continue
        if began is None:
            began = time.monotonic()
            start_new_thread(_end_in_time, ())
        elif time.monotonic() - began > _ONE_PRESS_SECONDS:
            _end_with_a_word()


def _end_in_time() -> None:
    time.sleep(_ORDERLY_SECONDS)
    if not _writing:
        _end_with_a_word()
    _say(f"{_INTERRUPTED}: writing what is done; Ctrl-C again ends at once")


def _end_with_a_word() -> NoReturn:
    """Nobody may read standard error: the word has little time."""
    try:
        start_new_thread(_say, (_INTERRUPTED,))
        time.sleep(_LAST_LINE_SECONDS)
    finally:
        end(exit_codes.INTERRUPTED)


def _say(line: str) -> None:
    """Write a line to descriptor 2: the main thread may hold the lock of sys.stderr."""
    try:
        os.write(2, f"{line}\n".encode())
    except OSError:
        return
